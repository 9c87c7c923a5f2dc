#pragma once

#include <functional>
#include <string>
#include <utility>

namespace lodestar {

/// What a node keeps over restarts, in a file that is whole whatever happens (replace_file).
class MemoryFile {
 public:
  /// @param path empty: nothing is kept
  explicit MemoryFile(std::string path) : path_(std::move(path)) {}

  /// Hands over what the file holds. No file is no fault; one that cannot be read or understood is set aside as
  /// `<path>.broken`.
  /// @param understand false, or an exception: it cannot be understood
  /// @param loss what follows from that, for people
  void load(const std::function<bool(const std::string& octets)>& understand, const std::string& loss);
  void save(const std::string& octets);

  bool kept() const { return !path_.empty(); }
  /// What went wrong last, for people; empty: nothing.
  const std::string& fault() const { return fault_; }

 private:
  std::string path_, fault_;
};

}  // namespace lodestar
