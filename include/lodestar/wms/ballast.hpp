#pragma once

#include <cstdint>
#include <string>

namespace lodestar {

/// A file of real blocks that holds room on the disk. When the disk is full it is let go, and what empties the queue
/// finds room to write.
class Ballast {
 public:
  /// Holds it at once where there is room. @param bytes 0: no ballast, always held
  Ballast(std::string path, std::int64_t bytes);

  bool held() const { return held_; }
  /// Takes the room again. @return whether it is held
  bool hold();
  void release();

 private:
  std::string path_;
  std::int64_t bytes_;
  bool held_ = false;
};

}  // namespace lodestar
