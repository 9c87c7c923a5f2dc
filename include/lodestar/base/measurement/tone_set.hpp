#pragma once

#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace lodestar {

/// A beacon's code: a set of indices into the site's tone table (at most 32 tones).
class ToneSet {
 public:
  static constexpr int kMaxTones = 32;

  ToneSet() = default;
  ToneSet(std::initializer_list<int> indices) {
    for (int i : indices) insert(i);
  }

  void insert(int index) { bits_ |= std::uint32_t{1} << index; }
  bool contains(int index) const { return (bits_ >> index) & 1u; }
  bool empty() const { return bits_ == 0; }
  int size() const { return static_cast<int>(std::bitset<kMaxTones>(bits_).count()); }
  std::uint32_t bits() const { return bits_; }

  /// Ascending.
  std::vector<int> indices() const {
    std::vector<int> out;
    for (int i = 0; i < kMaxTones; ++i)
      if (contains(i)) out.push_back(i);
    return out;
  }

  friend bool operator==(ToneSet a, ToneSet b) { return a.bits_ == b.bits_; }
  friend bool operator!=(ToneSet a, ToneSet b) { return a.bits_ != b.bits_; }
  friend bool operator<(ToneSet a, ToneSet b) { return a.bits_ < b.bits_; }

 private:
  std::uint32_t bits_ = 0;
};

}  // namespace lodestar
