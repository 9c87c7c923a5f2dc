#pragma once

#include <array>
#include <cstdint>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// Why a frame of the data channel never reached the beacon table.
enum class IrDrop {
  kUncorrectable,   ///< more octets wrong than the parity can mend
  kCrc,
  kVersion,
  kType,
  kSlot,            ///< not one of the superframe's
  kTones,           ///< not in the tone table, none, or a hole in the list
  kReserved,        ///< a status bit that version 1 leaves 0
  kUnsigned,        ///< on a site with a key
  kTag,             ///< does not match, or is not 0 on an unsigned frame
  kSuperframe,      ///< the counter does not move forward with time
  kStamp,           ///< older than the newest frame by more than one superframe
  kConflict,        ///< disagrees with the site file by more than 3 sigma
  kCount
};
const char* name(IrDrop reason);

/// Frame octets to announcement and back (optical_link.md, section 2): Reed-Solomon, CRC, version, type, slot, tag.
class IrFrameDecoder {
 public:
  IrFrameDecoder(const Link& link, int tone_count);
  Result<Announcement, IrDrop> decode(const RawIrFrame& frame) const;

 private:
  Link link_;
  int tone_count_;
};

/// The 46 octets that a beacon sends. Signed when the link has a key.
std::array<std::uint8_t, RawIrFrame::kOctets> encode_ir_frame(const Announcement& announcement, const Link& link);

}  // namespace lodestar
