#include "lodestar/estimation/pallet/pallet_ledger.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace lodestar {
namespace {

constexpr std::size_t kNewest = 500;
constexpr char kSuspected[] = "it may be what was lifted";  // also in memory files: keep it

bool earlier(const PalletChange& a, const PalletChange& b) { return a.sequence < b.sequence; }

bool lists(const PalletChange& change, const std::string& id) {
  return std::find(change.candidates.begin(), change.candidates.end(), id) != change.candidates.end();
}

}  // namespace

void PalletLedger::restore(Changes kept) {
  std::sort(kept.begin(), kept.end(), earlier);
  for (PalletChange& change : kept) enter(std::move(change));
}

void PalletLedger::enter(PalletChange change) {
  if (change.sequence != sequence_ + 1) newest_.clear();
  sequence_ = change.sequence;
  map_.set(change);
  newest_.push_back(std::move(change));
  if (newest_.size() > kNewest) newest_.pop_front();
}

PalletLedger::Changes PalletLedger::kept() const {
  Changes out;
  for (const auto& [id, change] : map_.all())
    if (newest_.empty() || change.sequence < newest_.front().sequence) out.push_back(change);
  std::sort(out.begin(), out.end(), earlier);
  out.insert(out.end(), newest_.begin(), newest_.end());
  return out;
}

PalletLedger::Changes PalletLedger::after(std::uint64_t sequence) const {
  Changes out;
  std::copy_if(newest_.begin(), newest_.end(), std::back_inserter(out),
               [&](const PalletChange& change) { return change.sequence > sequence; });
  return out;
}

PalletLedger::Changes PalletLedger::take() { return std::exchange(changes_, {}); }

void PalletLedger::write(PalletChange change) {
  change.sequence = sequence_ + 1;
  change.life = life_;
  changes_.push_back(change);
  enter(std::move(change));
}

void PalletLedger::write(PalletChangeKind kind, const Pallet& pallet, Stamp stamp,
                         const std::vector<std::string>& candidates) {
  PalletChange change;
  change.stamp = stamp;
  change.kind = kind;
  change.pallet = pallet;
  change.candidates = candidates;
  write(std::move(change));
}

void PalletLedger::amend(const Pallet& pallet, Stamp stamp, const std::vector<std::string>& candidates,
                         const std::string& reason) {
  PalletChange change;
  change.stamp = stamp;
  change.kind = PalletChangeKind::kCorrection;
  change.pallet = pallet;
  change.candidates = candidates;
  change.reason = reason;
  if (const PalletChange* last = map_.find(pallet.id)) change.corrects = last->sequence;
  write(std::move(change));
}

void PalletLedger::doubt(const std::string& id, Stamp stamp, const std::string& reason) {
  const PalletChange last = *map_.find(id);
  if (last.pallet.state == PalletState::kUncertain && (last.reason != kSuspected || reason == kSuspected)) return;
  Pallet pallet = last.pallet;
  pallet.state = PalletState::kUncertain;
  pallet.changed = stamp;
  amend(pallet, stamp, last.candidates, reason);
}

void PalletLedger::suspect(const std::string& id, Stamp stamp) { doubt(id, stamp, kSuspected); }

void PalletLedger::settle(Pallet pallet, PalletState state, Stamp stamp, const std::string& reason) {
  const std::vector<std::string> candidates = map_.find(pallet.id)->candidates;
  if (pallet.state != state) pallet.changed = stamp;
  pallet.state = state;
  amend(pallet, stamp, {}, reason);
  release(candidates, stamp, reason);
}

void PalletLedger::merge(const std::string& id, const std::string& into, PalletState state, Stamp stamp,
                         const std::string& reason) {
  const PalletChange told = *map_.find(id);
  const Pallet& same = map_.find(into)->pallet;
  const std::vector<std::string> answered = map_.find(into)->candidates;
  PalletChange change;
  change.stamp = stamp;
  change.kind = PalletChangeKind::kCorrection;
  change.pallet = told.pallet;
  change.pallet.id = into;
  change.pallet.type = same.type;
  if (!same.sscc.empty()) change.pallet.sscc = same.sscc;
  change.pallet.state = state;
  change.pallet.changed = stamp;
  change.reason = reason;
  change.corrects = told.sequence;
  write(std::move(change));

  Pallet ended = told.pallet;
  ended.sscc.clear();  // the label is that of the one that stays
  ended.state = PalletState::kGone;
  ended.changed = stamp;
  amend(ended, stamp, {}, reason);
  release(told.candidates, stamp, reason);
  release(answered, stamp, reason);
  strike(into, stamp, reason);
}

void PalletLedger::release(const std::vector<std::string>& candidates, Stamp stamp, const std::string& reason) {
  for (const std::string& id : candidates) {
    const PalletChange* candidate = map_.find(id);
    if (candidate == nullptr || candidate->pallet.state != PalletState::kUncertain || candidate->reason != kSuspected)
      continue;  // or its doubt is another one
    const bool asked_for =
        std::any_of(map_.all().begin(), map_.all().end(), [&](const auto& entry) { return lists(entry.second, id); });
    if (!asked_for) settle(candidate->pallet, PalletState::kStanding, stamp, reason);
  }
}

void PalletLedger::strike(const std::string& id, Stamp stamp, const std::string& reason) {
  Changes asking;
  for (const auto& [other, change] : map_.all())
    if (lists(change, id)) asking.push_back(change);
  for (PalletChange& change : asking) {
    auto& candidates = change.candidates;
    candidates.erase(std::remove(candidates.begin(), candidates.end(), id), candidates.end());
    amend(change.pallet, stamp, candidates, reason);
  }
}

void PalletLedger::forget_gone(Stamp before) {
  std::vector<std::string> old;
  for (const auto& [id, change] : map_.all())
    if (change.pallet.state == PalletState::kGone && change.stamp < before) old.push_back(id);
  for (const std::string& id : old) map_.erase(id);
}

}  // namespace lodestar
