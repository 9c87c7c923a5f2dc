#include "lodestar/wms/ballast.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace lodestar {

Ballast::Ballast(std::string path, std::int64_t bytes) : path_(std::move(path)), bytes_(bytes) { hold(); }

bool Ballast::hold() {
  if (held_) return true;
  if (bytes_ == 0) return held_ = true;
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0) return false;
  held_ = ::posix_fallocate(file, 0, bytes_) == 0;
  ::close(file);
  if (!held_) ::unlink(path_.c_str());
  return held_;
}

void Ballast::release() {
  if (bytes_ == 0) return;
  ::unlink(path_.c_str());
  held_ = false;
}

}  // namespace lodestar
