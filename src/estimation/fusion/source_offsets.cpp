#include "lodestar/estimation/fusion/source_offsets.hpp"

namespace lodestar::fusion {
namespace {

/// The least recently seen offset, unless it was seen less than keep_s ago.
std::optional<int> oldest_offset(const FilterState& state, double keep_s) {
  int oldest = 0;
  for (int i = 1; i < state.offset_count(); ++i)
    if (state.offsets[i].last_seen < state.offsets[oldest].last_seen) oldest = i;
  if (seconds(state.stamp - state.offsets[oldest].last_seen) < keep_s) return std::nullopt;
  return oldest;
}

int append_offset(FilterState& state) {
  const int old_size = state.size();
  const Covariance old = state.P;
  state.offsets.emplace_back();
  state.P.setZero(state.size(), state.size());
  state.P.topLeftCorner(old_size, old_size) = old;
  return state.offset_count() - 1;
}

}  // namespace

std::optional<int> find_offset(const FilterState& state, std::uint64_t source) {
  for (int i = 0; i < state.offset_count(); ++i)
    if (state.offsets[i].source == source) return i;
  return std::nullopt;
}

std::optional<int> open_offset(FilterState& state, std::uint64_t source, const Eigen::Matrix3d& prior, double keep_s) {
  const bool room = state.offset_count() < kMaxOffsets;
  const std::optional<int> index = room ? append_offset(state) : oldest_offset(state, keep_s);
  if (!index) return std::nullopt;
  state.offsets[*index] = SourceOffset{};
  state.offsets[*index].source = source;
  restart_offset(state, *index, prior);
  return index;
}

void restart_offset(FilterState& state, int index, const Eigen::Matrix3d& prior) {
  const int at = kCore + 3 * index;
  state.P.middleRows<3>(at).setZero();
  state.P.middleCols<3>(at).setZero();
  state.P.block<3, 3>(at, at) = prior;
  SourceOffset& offset = state.offsets[index];
  offset.value.setZero();
  offset.prior = prior;
  offset.gated = 0;
  offset.excluded = false;
  offset.last_used.reset();
}

void relax_offset(FilterState& state, int index, double keep, const Eigen::Matrix3d& prior) {
  const int at = kCore + 3 * index;
  state.P.middleRows<3>(at) *= keep;
  state.P.middleCols<3>(at) *= keep;
  state.P.block<3, 3>(at, at) += (1.0 - keep * keep) * prior;
  SourceOffset& offset = state.offsets[index];
  offset.value *= keep;
  offset.prior = keep * keep * offset.prior + (1.0 - keep * keep) * prior;
}

}  // namespace lodestar::fusion
