#include "lodestar/ros/nodelets/stranger_watch.hpp"

namespace lodestar {

namespace {

constexpr double kWarning_s = 10;
constexpr double kLongest_s = 10;  // that the channel is listened to before it is judged
constexpr std::uint64_t kFrames = 10, kFewestSpoilt = 5;

constexpr IrDrop kStrange[] = {IrDrop::kSlot,      IrDrop::kUnsigned, IrDrop::kTag,     IrDrop::kSuperframe,
                               IrDrop::kStamp,     IrDrop::kReserved, IrDrop::kVersion, IrDrop::kType,
                               IrDrop::kDirection, IrDrop::kTones,    IrDrop::kFull};

}  // namespace

/// Since it was judged last, if that is long enough ago.
bool StrangerWatch::most_are_spoilt(const DropCounts<IrDrop>& drops, std::uint64_t accepted, const ros::WallTime& now) {
  const std::uint64_t all_spoilt = drops[IrDrop::kUncorrectable] + drops[IrDrop::kCrc];
  const std::uint64_t spoilt = all_spoilt - spoilt_, sound = accepted - accepted_;
  if (spoilt + sound < kFrames && (now - judged_).toSec() < kLongest_s) return false;
  spoilt_ = all_spoilt;
  accepted_ = accepted;
  judged_ = now;
  return spoilt >= kFewestSpoilt && spoilt > sound;
}

void StrangerWatch::report(const DropCounts<IrDrop>& drops, std::uint64_t accepted, int corrections,
                           Health::Status& status, const ros::WallTime& now) {
  std::string seen;
  for (const IrDrop reason : kStrange)
    if (const std::uint64_t count = drops[reason] - drops_[reason])
      seen += (seen.empty() ? "frames that no beacon of this site sends: " : ", ") + std::to_string(count) + " " +
              name(reason);
  drops_ = drops;
  if (!seen.empty()) strange_ = {seen, now};
  if (corrections > corrections_)
    believed_ = {"recorded frames were taken for true until earlier ones came, or the receiver's clock was late", now};
  corrections_ = corrections;
  if (most_are_spoilt(drops, accepted, now))
    spoilt_channel_ = {"most frames are spoilt: the channel is jammed, or the diodes are dirty", now};
  for (const Warning& warning : {strange_, believed_, spoilt_channel_})
    if (!warning.text.empty() && (now - warning.since).toSec() <= kWarning_s)
      status.mergeSummary(Health::Status::WARN, warning.text);
}

}  // namespace lodestar
