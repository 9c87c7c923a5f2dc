#pragma once

#include <vector>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// The newest N frames, held (not copied), in a ring: a frame keeps its slot until the frame N later takes it. What is
/// kept for each frame (tone phases, a blob's light) lies in the same slots, so nothing is ever moved.
class FrameWindow {
 public:
  explicit FrameWindow(int frames);

  /// @param T_before_now camera coordinates now to those at the frame before
  void push(const Image& image, const RigidTransform& T_before_now);
  /// The motion into a frame is known better now.
  void set_motion(int slot, const RigidTransform& T_before_now) {
    frames_[static_cast<std::size_t>(slot)].T_before_now = T_before_now;
  }
  void clear();

  int capacity() const { return static_cast<int>(frames_.size()); }
  int size() const { return size_; }
  bool full() const { return size_ == capacity(); }

  int newest() const { return newest_; }
  /// Slot of the frame `age` frames before the newest, age < size().
  int slot(int age) const { return (newest_ + capacity() - age) % capacity(); }
  const Image& at(int slot) const { return frames_[static_cast<std::size_t>(slot)].image; }
  const RigidTransform& T_before_now(int slot) const { return frames_[static_cast<std::size_t>(slot)].T_before_now; }

  /// From the frame before to that of `slot`, s. Not of the oldest.
  double interval_s(int slot) const;

  /// Mean interval between the frames, s; 0 with less than two.
  double period_s() const;

 private:
  struct Frame {
    Image image;
    RigidTransform T_before_now = RigidTransform::Identity();
  };
  std::vector<Frame> frames_;
  int size_ = 0, newest_ = -1;
};

}  // namespace lodestar
