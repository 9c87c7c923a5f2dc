#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "lodestar/sim/line_run.hpp"

namespace lodestar::test {

/// What somebody with a lamp and a recorder may do to the data channel.
enum class Trick {
  kNone,
  kReplay,     ///< sends what he recorded some seconds before, as if it were heard now
  kRelay,      ///< sends on at once what a true beacon sends, from another place
  kOutshine,   ///< the same, so brightly that the photodiodes tell but one sender
  kDelay,      ///< the same as kRelay a frame's length later
  kYesterday,  ///< sends what he recorded the day before, until the first true frame is heard and on
  kForge,      ///< sends each frame first with other coordinates, unsigned or with a tag that he made up
  kJam,        ///< true frames are heard as noise
  kEverything
};

/// Frames that the receiver hears beside, or instead of, those of a true beacon.
class Stranger {
 public:
  Stranger(Trick trick, const Site& site) : trick_(trick), site_(site) {}

  std::vector<RawIrFrame> heard(const RawIrFrame& sent) {
    std::vector<RawIrFrame> out{sent};
    recorded_.push_back(sent);
    const bool everything = trick_ == Trick::kEverything;
    if (trick_ == Trick::kReplay || everything) replay(sent, out);
    if (trick_ == Trick::kRelay || everything) out.insert(out.begin(), from_elsewhere(sent, 0));
    if (trick_ == Trick::kOutshine) outshine(out.front());
    if (trick_ == Trick::kYesterday || everything) yesterday(sent, out);
    if (trick_ == Trick::kDelay || everything) out.push_back(from_elsewhere(sent, 0.0208));
    if (trick_ == Trick::kForge || everything) forge(sent, out);
    if (trick_ == Trick::kJam || (everything && recorded_.size() % 3 == 0))
      for (RawIrFrame& frame : out)
        for (std::size_t i = 0; i < frame.octets.size(); i += 2) frame.octets[i] ^= 0x5A;
    return out;
  }

 private:
  /// The stranger's lamp shines from low at one side.
  static RawIrFrame from_elsewhere(RawIrFrame frame, double late_s) {
    frame.stamp += from_seconds(late_s);
    const Eigen::Vector3d sender = 0.5 * Eigen::Vector3d(std::sin(radians(55)), 0, std::cos(radians(55)));
    frame.levels.clear();
    for (const auto& diode : DiodeArray::ring().diodes) {
      const double level = diode.direction_ir.dot(sender);
      frame.levels.push_back(static_cast<float>(level > 0.5 * std::cos(radians(75)) ? level : 0));
    }
    return frame;
  }
  static void outshine(RawIrFrame& frame) {
    const RawIrFrame his = from_elsewhere(frame, 0);
    for (std::size_t i = 0; i < frame.levels.size(); ++i) frame.levels[i] = his.levels[i] + 0.1f * frame.levels[i];
  }
  /// Signed by the site's own beacons, when one of them hung elsewhere.
  void yesterday(const RawIrFrame& now, std::vector<RawIrFrame>& out) const {
    const auto said = decoder().decode(now);
    if (!said) return;
    Announcement then = *said;
    then.superframe -= 108'000;
    if (then.beacon == site_.beacons.front().id) then.position_map.x() += 2;
    RawIrFrame frame = from_elsewhere(now, -0.010);
    frame.octets = encode_ir_frame(then, site_.link);
    out.insert(out.begin(), frame);
  }
  void replay(const RawIrFrame& now, std::vector<RawIrFrame>& out) const {
    RawIrFrame old = from_elsewhere(recorded_[recorded_.size() / 2], 0);
    old.stamp = now.stamp;
    out.insert(out.begin(), old);
  }
  void forge(const RawIrFrame& now, std::vector<RawIrFrame>& out) const {
    const auto said = decoder().decode(now);
    if (!said) return;
    Announcement lie = *said;
    lie.position_map += Eigen::Vector3d(2, 1, 0);
    Link unsigned_link = site_.link, other_key = site_.link;
    unsigned_link.key.reset();
    other_key.key = std::array<std::uint8_t, 16>{1, 2, 3};
    for (const Link& link : {unsigned_link, other_key}) {
      RawIrFrame frame = now;
      frame.octets = encode_ir_frame(lie, link);
      out.insert(out.begin(), frame);
    }
  }

  IrFrameDecoder decoder() const { return {site_.link, static_cast<int>(site_.tone_table_hz.size())}; }

  Trick trick_;
  Site site_;
  std::deque<RawIrFrame> recorded_;
};

}  // namespace lodestar::test
