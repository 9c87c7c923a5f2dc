#include "lodestar/wms/iso_time.hpp"

#include <cstdio>
#include <ctime>

namespace lodestar {

std::string iso_time(Stamp stamp) {
  const auto since_epoch = stamp.time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since_epoch);
  const auto rest = std::chrono::floor<std::chrono::milliseconds>(since_epoch - whole);
  const std::time_t time = whole.count();
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[64];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text + length, sizeof text - length, ".%03dZ", static_cast<int>(rest.count()));
  return text;
}

}  // namespace lodestar
