#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "lodestar/base/common/fault.hpp"

namespace lodestar {

/// What is wrong with one file, gathered while it is read.
class FaultLog {
 public:
  explicit FaultLog(std::string file) : file_(std::move(file)) {}

  void add(int line, const std::string& what) { faults_.push_back({file_, line, what}); }
  bool empty() const { return faults_.empty(); }
  const std::string& file() const { return file_; }

  /// In the order of the lines.
  Faults sorted() const {
    Faults faults = faults_;
    std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) { return a.line < b.line; });
    return faults;
  }

 private:
  std::string file_;
  Faults faults_;
};

}  // namespace lodestar
