#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// Why a frame of the data channel never reached the beacon table.
enum class IrDrop {
  kUncorrectable,  ///< more octets wrong than the parity can mend
  kCrc,
  kVersion,
  kType,
  kSlot,        ///< not one of the superframe's, not its beacon's, or begun when another slot is on
  kTones,       ///< not in the tone table, none, or a hole in the list
  kReserved,    ///< a status bit that version 1 leaves 0
  kUnsigned,    ///< on a site with a key
  kTag,         ///< does not match, or is not 0 on an unsigned frame
  kSuperframe,  ///< the counter does not move forward with time
  kStamp,       ///< older than the newest frame by more than one superframe
  kDirection,   ///< came from elsewhere than its beacon hangs, seen from where the vehicle is
  kConflict,    ///< disagrees with the site file by more than 3 sigma, or with the beacon's earlier word
  kFull,        ///< one unknown beacon more than the table takes
  kCount
};
const char* name(IrDrop reason);

class ReedSolomon;

/// Frame octets to announcement (optical_link.md, section 2): parity, CRC, version, type, slot, tones, status, tag, in
/// this order; the first that is wrong is the reason. Any octets are safe. What only time tells (superframe, stamp) and
/// what only the site tells (conflict) is BeaconTable's. Copies share the code's tables; decode() may run in several
/// threads.
class IrFrameDecoder {
 public:
  /// @param tone_count of the site's tone table, at most ToneSet::kMaxTones
  IrFrameDecoder(const Link& link, int tone_count);

  /// Levels of which one is not finite are left out of the announcement; the frame is not dropped for them. On a site
  /// without a key a signed frame passes with its tag unread.
  Result<Announcement, IrDrop> decode(const RawIrFrame& frame) const;

 private:
  Link link_;
  int tone_count_;
  std::shared_ptr<const ReedSolomon> code_;
};

/// The 46 octets that a beacon sends; the position goes to the nearest mm. Signed when the link has a key, whatever
/// `is_signed` says. Throws std::invalid_argument when the position is beyond 32 bits of mm or not finite, or when
/// there are no tones or more than three.
std::array<std::uint8_t, RawIrFrame::kOctets> encode_ir_frame(const Announcement& announcement, const Link& link);

}  // namespace lodestar
