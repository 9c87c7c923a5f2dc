#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "lodestar/estimation/pallet/pallet_map.hpp"

namespace lodestar {

/// The pallets with the changes that made them so: whatever changes a pallet is written down here, numbered without
/// gaps.
class PalletLedger {
 public:
  using Changes = std::vector<PalletChange>;

  /// @param life UUID of this run, another at each start: a ledger that takes up an old one gives its numbers again
  PalletLedger(std::vector<PalletSize> sizes, std::string life) : map_(std::move(sizes)), life_(std::move(life)) {}
  /// Takes up what an earlier ledger kept().
  void restore(Changes kept);

  const PalletMap& map() const { return map_; }
  void set_carried(const std::set<std::string>& ids) { map_.set_carried(ids); }
  std::uint64_t last() const { return sequence_; }  ///< number of the newest change; 0: none
  /// What was written since the last call.
  Changes take();

  /// Ascending by number: the newest 500 changes, and before them the last one of each pallet that they do not tell of.
  Changes kept() const;
  /// Those of the newest that come after this number.
  Changes after(std::uint64_t sequence) const;

  /// A pick or a drop.
  void write(PalletChangeKind kind, const Pallet& pallet, Stamp stamp, const std::vector<std::string>& candidates);
  /// A correction of what was last written of this pallet.
  void amend(const Pallet& pallet, Stamp stamp, const std::vector<std::string>& candidates, const std::string& reason);

  /// The pallet, or its place, is in doubt from now on. One that is already stays so for the first
  /// reason, unless it was but a candidate.
  void doubt(const std::string& id, Stamp stamp, const std::string& reason);
  /// ... for it is a candidate: until it is none any more.
  void suspect(const std::string& id, Stamp stamp);
  /// The pallet is so, and in this state, without a doubt; what was suspected for its sake stands where it stood.
  void settle(Pallet pallet, PalletState state, Stamp stamp, const std::string& reason);
  /// What was told as `id` is pallet `into`, in this state; `id` ends.
  void merge(const std::string& id, const std::string& into, PalletState state, Stamp stamp, const std::string& reason);
  /// Those of them that are in doubt as candidates alone, and are no pallet's any more, stand where they stood.
  void release(const std::vector<std::string>& candidates, Stamp stamp, const std::string& reason);
  /// This pallet was found: it is no other's candidate any more.
  void strike(const std::string& id, Stamp stamp, const std::string& reason);

  /// Pallets that left the site before this instant are forgotten.
  void forget_gone(Stamp before);

 private:
  void write(PalletChange change);
  void enter(PalletChange change);

  PalletMap map_;
  std::string life_;
  std::deque<PalletChange> newest_;  ///< numbered without gaps
  std::uint64_t sequence_ = 0;
  Changes changes_;
};

}  // namespace lodestar
