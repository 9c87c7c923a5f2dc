#include "lodestar/sensing/beacon/frame_window.hpp"

#include <algorithm>

namespace lodestar {

FrameWindow::FrameWindow(int frames) : frames_(static_cast<std::size_t>(frames)) {}

void FrameWindow::push(const Image& image, const RigidTransform& T_before_now) {
  newest_ = (newest_ + 1) % capacity();
  size_ = std::min(size_ + 1, capacity());
  frames_[static_cast<std::size_t>(newest_)] = {image, T_before_now};
}

void FrameWindow::clear() {
  std::fill(frames_.begin(), frames_.end(), Frame());
  size_ = 0;
  newest_ = -1;
}

double FrameWindow::interval_s(int slot) const {
  return seconds(at(slot).stamp - at((slot + capacity() - 1) % capacity()).stamp);
}

double FrameWindow::period_s() const {
  if (size_ < 2) return 0;
  return seconds(at(newest_).stamp - at(slot(size_ - 1)).stamp) / (size_ - 1);
}

}  // namespace lodestar
