#include "lodestar/ros/nodelets/memory_file.hpp"

#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "lodestar/base/common/replace_file.hpp"

namespace lodestar {

void MemoryFile::load(const std::function<bool(const std::string&)>& understand, const std::string& loss) {
  std::error_code none;
  if (!kept() || !std::filesystem::exists(path_, none)) return;
  try {
    std::ifstream stream(path_, std::ios::binary);
    if (stream && understand(std::string(std::istreambuf_iterator<char>(stream), {}))) return;
  } catch (const std::exception&) {
  }
  const std::string aside = path_ + ".broken";
  std::filesystem::rename(path_, aside, none);
  fault_ = path_ + " cannot be understood: set aside as " + aside + ", and " + loss;
}

void MemoryFile::save(const std::string& octets) {
  if (!kept()) return;
  fault_ = replace_file(path_, octets) ? "" : path_ + " cannot be written: " + std::strerror(errno);
}

}  // namespace lodestar
