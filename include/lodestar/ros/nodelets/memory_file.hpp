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

  /// Hands over what the file holds. No file is no fault; one that cannot be understood is set aside as
  /// `<path>.broken`. One that cannot be read, or not be set aside, is left as it is and nothing is saved.
  /// @param understand false, or an exception: it cannot be understood
  /// @param loss what follows from that, for people
  void load(const std::function<bool(const std::string& octets)>& understand, const std::string& loss);
  void save(const std::string& octets);

  bool kept() const { return !path_.empty(); }
  /// What went wrong, for people: when it was saved last, else when it was loaded, for what was lost then stays lost;
  /// empty: nothing.
  const std::string& fault() const { return not_saved_.empty() ? not_loaded_ : not_saved_; }

 private:
  std::string path_, not_loaded_, not_saved_;
  bool untouchable_ = false;  ///< it may hold what nobody has read yet
};

}  // namespace lodestar
