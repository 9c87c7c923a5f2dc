#include "lodestar/ros/nodelets/memory_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>

#include "lodestar/base/common/replace_file.hpp"

namespace lodestar {

namespace {

/// Empty, with errno: it cannot be read.
std::optional<std::string> octets_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return std::nullopt;
  try {
    return std::string(std::istreambuf_iterator<char>(stream), {});
  } catch (const std::ios_base::failure&) {
    return std::nullopt;
  }
}

bool understood(const std::function<bool(const std::string&)>& understand, const std::string& octets) {
  try {
    return understand(octets);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

void MemoryFile::load(const std::function<bool(const std::string&)>& understand, const std::string& loss) {
  if (!kept()) return;
  const auto octets = octets_of(path_);
  if (!octets && errno == ENOENT) return;
  if (octets && understood(understand, *octets)) return;
  std::string fate = std::string(" cannot be read: ") + std::strerror(errno);
  untouchable_ = true;
  if (octets) {
    const std::string aside = path_ + ".broken";
    untouchable_ = std::rename(path_.c_str(), aside.c_str()) != 0;
    fate = " cannot be understood: " +
           (untouchable_ ? std::string("not set aside, ") + std::strerror(errno) : "set aside as " + aside);
  }
  not_loaded_ = path_ + fate + ", and " + loss + (untouchable_ ? "; nothing new is kept" : "");
}

void MemoryFile::save(const std::string& octets) {
  if (!kept() || untouchable_) return;
  not_saved_ = replace_file(path_, octets) ? "" : path_ + " cannot be written: " + std::strerror(errno);
}

}  // namespace lodestar
