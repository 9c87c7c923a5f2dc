#include "lodestar/sensing/camera/v4l2_port.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {
namespace {

class V4l2File : public V4l2Port {
 public:
  explicit V4l2File(const std::string& device) : file_(::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
    if (file_ < 0) throw CameraError("v4l2:" + device + ": " + std::strerror(errno));
  }
  ~V4l2File() override {
    for (const auto& [data, bytes] : maps_) ::munmap(data, bytes);
    ::close(file_);
  }
  V4l2File(const V4l2File&) = delete;
  V4l2File& operator=(const V4l2File&) = delete;

  int control(unsigned long request, void* argument) override {
    int result;
    do result = ::ioctl(file_, request, argument);
    while (result < 0 && errno == EINTR);
    return result < 0 ? errno : 0;
  }
  bool wait(Duration timeout) override {
    pollfd poll{file_, POLLIN, 0};
    const auto timeout_ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
    return ::poll(&poll, 1, static_cast<int>(timeout_ms)) > 0;
  }
  std::uint8_t* map(std::size_t bytes, std::int64_t offset) override {
    void* const data = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, offset);
    if (data == MAP_FAILED) return nullptr;
    maps_.emplace_back(data, bytes);
    return static_cast<std::uint8_t*>(data);
  }

 private:
  int file_;
  std::vector<std::pair<void*, std::size_t>> maps_;
};

}  // namespace

std::unique_ptr<V4l2Port> open_v4l2_port(const std::string& device) { return std::make_unique<V4l2File>(device); }

}  // namespace lodestar
