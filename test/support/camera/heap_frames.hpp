#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar::test {

/// Gives memory for frames and remembers where.
class HeapFrames {
 public:
  FrameAllocator allocator() {
    return [this](std::size_t bytes) {
      auto pixels = std::make_shared<std::vector<std::uint8_t>>(bytes);
      given_[pixels->data()] = pixels;
      return FrameMemory{pixels->data(), pixels};
    };
  }
  bool gave(const std::uint8_t* data) const { return given_.count(data) > 0; }
  /// Whether somebody has it still.
  bool alive(const std::uint8_t* data) const { return gave(data) && !given_.at(data).expired(); }
  std::ptrdiff_t alive() const {
    return std::count_if(given_.begin(), given_.end(), [](const auto& given) { return !given.second.expired(); });
  }

 private:
  std::map<const std::uint8_t*, std::weak_ptr<void>> given_;
};

}  // namespace lodestar::test
