// Text to the site file's reader. A site that passes must come back from its own text.

#include <cstdlib>
#include <string>

#include "lodestar/base/site/site.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const auto site = parse_site(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
  if (!site) return 0;
  check_tones(*site, {}, "fuzz.yaml");
  if (!parse_site(to_yaml(*site), "fuzz.yaml")) std::abort();
  return 0;
}
