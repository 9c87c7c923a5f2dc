#include "lodestar/ros/nodelets/stranger_watch.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

/// The operator's view of a channel, once a second.
class Channel {
 public:
  /// One more second with so many frames; what the operator is told then.
  std::string after(int sound, int spoilt, IrDrop reason = IrDrop::kUncorrectable) {
    accepted_ += static_cast<std::uint64_t>(sound);
    for (int i = 0; i < spoilt; ++i) drops_.add(reason);
    now_ += ros::WallDuration(1);
    Health::Status status;
    status.summary(Health::Status::OK, "");
    watch_.report(drops_, accepted_, corrections_, status, now_);
    EXPECT_EQ(status.level == Health::Status::WARN, !status.message.empty());
    return status.message;
  }
  /// The same, and the phase is found late.
  std::string after_correction() {
    ++corrections_;
    return after(5, 0);
  }
  /// After how many seconds like this one it is called jammed; 60: it is not.
  int jammed_after(int sound, int spoilt, int every_s = 1) {
    for (int second = 1; second < 60; ++second) {
      const bool frames = second % every_s == 0;
      if (after(frames ? sound : 0, frames ? spoilt : 0).find("most frames are spoilt") != std::string::npos)
        return second;
    }
    return 60;
  }

 private:
  ros::WallTime now_{1000};
  StrangerWatch watch_{now_};
  DropCounts<IrDrop> drops_;
  std::uint64_t accepted_ = 0;
  int corrections_ = 0;
};

TEST(StrangerWatch, a_jammer_is_told_however_few_beacons_are_heard) {
  EXPECT_EQ(Channel().jammed_after(0, 20), 1);
  EXPECT_EQ(Channel().jammed_after(1, 2), 4) << "two beacons, 0.8 s apart";
  EXPECT_EQ(Channel().jammed_after(0, 1), 10) << "one beacon";
  EXPECT_EQ(Channel().jammed_after(0, 1, 2), 10) << "one beacon, not always heard";
}

TEST(StrangerWatch, bad_light_and_noise_are_no_jammer) {
  EXPECT_EQ(Channel().jammed_after(10, 10), 60);
  EXPECT_EQ(Channel().jammed_after(2, 1), 60);
  EXPECT_EQ(Channel().jammed_after(0, 2, 5), 60) << "a frame of noise now and then, and no beacon";
}

TEST(StrangerWatch, whatever_no_beacon_of_the_site_sends_is_named_for_ten_seconds) {
  for (const IrDrop reason : {IrDrop::kSlot, IrDrop::kSuperframe, IrDrop::kTag, IrDrop::kUnsigned, IrDrop::kDirection,
                              IrDrop::kStamp, IrDrop::kTones}) {
    Channel channel;
    EXPECT_EQ(channel.after(5, 0), "");
    EXPECT_EQ(channel.after(5, 1, reason), std::string("frames that no beacon of this site sends: 1 ") + name(reason));
    for (int second = 0; second < 10; ++second) EXPECT_NE(channel.after(5, 0), "") << second;
    EXPECT_EQ(channel.after(5, 0), "");
  }
}

TEST(StrangerWatch, recordings_that_were_believed_are_told_for_ten_seconds) {
  Channel channel;
  EXPECT_EQ(channel.after(5, 0), "");
  for (int second = 0; second <= 10; ++second) {
    const std::string told = second == 0 ? channel.after_correction() : channel.after(5, 0);
    EXPECT_NE(told.find("recorded frames were taken for true"), std::string::npos) << second;
  }
  EXPECT_EQ(channel.after(5, 0), "");
}

TEST(StrangerWatch, a_beacon_of_the_site_that_was_moved_is_no_stranger) {
  EXPECT_EQ(Channel().after(5, 5, IrDrop::kConflict), "");
}

}  // namespace
}  // namespace lodestar
