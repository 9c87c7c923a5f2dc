#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace lodestar {

/// How often something was dropped, by reason. Reason is an enum class whose last enumerator is kCount;
/// a free function `const char* name(Reason)` names each for diagnostics.
template <class Reason>
class DropCounts {
 public:
  static constexpr std::size_t kSize = static_cast<std::size_t>(Reason::kCount);

  void add(Reason reason) { ++counts_[static_cast<std::size_t>(reason)]; }
  std::uint64_t operator[](Reason reason) const { return counts_[static_cast<std::size_t>(reason)]; }
  std::uint64_t total() const { return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}); }

  /// Calls visit(name, count) for each reason, also those that never happened.
  template <class Visitor>
  void each(Visitor&& visit) const {
    for (std::size_t i = 0; i < kSize; ++i) visit(name(static_cast<Reason>(i)), counts_[i]);
  }

 private:
  std::array<std::uint64_t, kSize> counts_{};
};

}  // namespace lodestar
