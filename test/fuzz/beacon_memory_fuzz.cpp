// Text to the reader of what the beacon table keeps over a restart. What passes must come back from its own text.

#include <cstdlib>
#include <string>

#include "lodestar/line/beacon_memory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const auto memory = parse_beacon_memory(std::string(reinterpret_cast<const char*>(data), size));
  if (!memory) return 0;
  const auto same = parse_beacon_memory(to_yaml(*memory));
  if (!same || to_yaml(*same) != to_yaml(*memory)) std::abort();
  return 0;
}
