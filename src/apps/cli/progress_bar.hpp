#pragma once

#include <string>

namespace lodestar {

/// One line on standard error that shows how far a long job is. Silent where standard error is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param done 0 to 1; drawn only when the picture changes
  void show(double done);

 private:
  std::string label_;
  bool on_terminal_;
  int drawn_permille_ = -1;
};

}  // namespace lodestar
