#pragma once

#include <memory>
#include <set>
#include <vector>

#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar::test {

/// Gives memory for frames and remembers where.
class HeapFrames {
 public:
  FrameAllocator allocator() {
    return [this](std::size_t bytes) {
      auto pixels = std::make_shared<std::vector<std::uint8_t>>(bytes);
      given_.insert(pixels->data());
      return FrameMemory{pixels->data(), pixels};
    };
  }
  bool gave(const std::uint8_t* data) const { return given_.count(data) > 0; }

 private:
  std::set<const std::uint8_t*> given_;
};

}  // namespace lodestar::test
