// Text to the vehicle file's reader.

#include <string>

#include "lodestar/base/site/vehicle.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::parse_vehicle(std::string(reinterpret_cast<const char*>(data), size), "fuzz.yaml");
  return 0;
}
