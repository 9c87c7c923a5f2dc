#include "lodestar/base/common/replace_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace lodestar {
namespace {

bool write_all(int file, const std::string& octets) {
  std::size_t done = 0;
  while (done < octets.size()) {
    const ssize_t wrote = ::write(file, octets.data() + done, octets.size() - done);
    if (wrote < 0 && errno != EINTR) return false;
    if (wrote > 0) done += static_cast<std::size_t>(wrote);
  }
  return true;
}

/// @return whether the job, which gets the open file, and everything around it went well
template <class Job>
bool with_file(const std::string& path, int flags, Job job) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
  if (file < 0) return false;
  const bool good = job(file);
  const int fault = errno;
  const bool closed = ::close(file) == 0;
  if (!good) errno = fault;
  return good && closed;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return path.substr(0, slash + 1);
}

}  // namespace

bool replace_file(const std::string& path, const std::string& octets) {
  const std::string beside = path + ".new";
  const auto write = [&](int file) { return write_all(file, octets) && ::fsync(file) == 0; };
  if (!with_file(beside, O_WRONLY | O_CREAT | O_TRUNC, write)) return false;
  if (::rename(beside.c_str(), path.c_str()) != 0) return false;
  // The file's name is a line of its folder, which a fall of power takes back when it is not synced too.
  return with_file(folder_of(path), O_RDONLY | O_DIRECTORY, [](int folder) { return ::fsync(folder) == 0; });
}

}  // namespace lodestar
