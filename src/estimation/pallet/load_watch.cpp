#include "lodestar/estimation/pallet/load_watch.hpp"

namespace lodestar {

std::optional<LoadChange> LoadWatch::add(const LoadSample& sample) {
  const bool silent = !newest_ || seconds(sample.stamp - *newest_) > params_.max_gap_s;
  newest_ = sample.stamp;
  if (sample.load_present == loaded_) {
    pending_.reset();
    return std::nullopt;
  }
  if (!pending_ || silent) {
    // Of a silence within a pending change: it may have come and gone in between.
    pending_ = LoadChange{sample.stamp, sample.fork_height_m, sample.load_present, "", !silent};
    told_ = 0;
  }
  ++told_;
  if (!sample.label.empty()) pending_->label = sample.label;
  if (told_ < params_.samples || seconds(sample.stamp - pending_->stamp) < params_.hold_s) return std::nullopt;
  loaded_ = sample.load_present;
  const LoadChange change = *pending_;
  pending_.reset();
  return change;
}

void LoadWatch::reset_time() {
  newest_.reset();
  pending_.reset();
}

}  // namespace lodestar
