#include "lodestar/ros/nodelets/stranger_watch.hpp"

namespace lodestar {

namespace {

constexpr double kWarning_s = 10;
constexpr std::uint64_t kManySpoilt = 10;  // since the last report, a second ago

constexpr IrDrop kStrange[] = {IrDrop::kSlot,      IrDrop::kUnsigned, IrDrop::kTag,     IrDrop::kSuperframe,
                               IrDrop::kStamp,     IrDrop::kReserved, IrDrop::kVersion, IrDrop::kType,
                               IrDrop::kDirection, IrDrop::kConflict, IrDrop::kFull};

}  // namespace

void StrangerWatch::report(const DropCounts<IrDrop>& drops, std::uint64_t accepted, Health::Status& status) {
  std::string seen;
  for (const IrDrop reason : kStrange)
    if (const std::uint64_t count = drops[reason] - drops_[reason])
      seen += (seen.empty() ? "frames that no beacon of this site sends: " : ", ") + std::to_string(count) + " " +
              name(reason);
  const std::uint64_t spoilt =
      drops[IrDrop::kUncorrectable] + drops[IrDrop::kCrc] - drops_[IrDrop::kUncorrectable] - drops_[IrDrop::kCrc];
  if (spoilt >= kManySpoilt && spoilt > accepted - accepted_)
    seen += std::string(seen.empty() ? "" : "; ") +
            "most frames are spoilt: the channel is jammed, or the diodes are dirty";
  drops_ = drops;
  accepted_ = accepted;

  const ros::WallTime now = ros::WallTime::now();
  if (!seen.empty()) {
    warning_ = seen;
    warned_ = now;
  }
  if (!warning_.empty() && (now - warned_).toSec() <= kWarning_s) status.mergeSummary(Health::Status::WARN, warning_);
}

}  // namespace lodestar
