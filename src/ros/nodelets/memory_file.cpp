#include "lodestar/ros/nodelets/memory_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "lodestar/base/common/replace_file.hpp"

namespace lodestar {

std::string write_memory(const std::string& path, const std::string& octets) {
  return replace_file(path, octets) ? "" : path + " cannot be written: " + std::strerror(errno);
}

std::string set_aside(const std::string& path, const std::string& loss) {
  const std::string aside = path + ".broken";
  std::error_code none;
  std::filesystem::rename(path, aside, none);
  return path + " cannot be understood: set aside as " + aside + ", and " + loss;
}

}  // namespace lodestar
