#include "lodestar/ros/nodelets/memory_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace lodestar {
namespace {

/// False, with errno, where it could not be written to the disk's last layer.
bool write_through(const std::string& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return false;
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(file, text.data() + done, text.size() - done);
    if (wrote < 0 && errno != EINTR) break;
    if (wrote > 0) done += static_cast<std::size_t>(wrote);
  }
  const bool good = done == text.size() && ::fsync(file) == 0;
  return ::close(file) == 0 && good;
}

}  // namespace

std::string replace_file(const std::string& path, const std::string& text) {
  const std::string beside = path + ".new";
  if (write_through(beside, text) && ::rename(beside.c_str(), path.c_str()) == 0) return "";
  return path + " cannot be written: " + std::strerror(errno);
}

std::string set_aside(const std::string& path, const std::string& loss) {
  const std::string aside = path + ".broken";
  std::error_code none;
  std::filesystem::rename(path, aside, none);
  return path + " cannot be understood: set aside as " + aside + ", and " + loss;
}

}  // namespace lodestar
