// Text to the scenario file's reader; the site files that it may name lie beside it.

#include <string>

#include "lodestar/sim/scenario.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::sim::parse_scenario(std::string(reinterpret_cast<const char*>(data), size),
                                LODESTAR_SOURCE_DIR "/config/scenarios/fuzz.yaml");
  return 0;
}
