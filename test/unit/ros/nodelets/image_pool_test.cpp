#include "lodestar/ros/nodelets/image_pool.hpp"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "lodestar/ros/convert/image.hpp"
#include "lodestar/sensing/camera/v4l2_source.hpp"
#include "support/camera/fake_v4l2_camera.hpp"

namespace lodestar {
namespace {

/// A v4l2 camera whose frames become messages, as in the nodelet.
class ImagePoolTest : public testing::Test {
 protected:
  void SetUp() override {
    camera_->formats = {V4L2_PIX_FMT_GREY};
    capture_.open();
  }
  sensor_msgs::ImagePtr message(std::uint8_t shade) {
    camera_->picture.assign(64 * 48, shade);
    return ImagePool::message(capture_.next().value(), "camera_optical_frame");
  }

  ImagePool pool_;
  std::map<std::uint32_t, int> controls_;
  test::FakeV4l2Camera* camera_ = new test::FakeV4l2Camera(controls_);
  Capture capture_{[this] { return std::make_unique<V4l2Source>("/dev/fake", std::unique_ptr<V4l2Port>(camera_)); },
                   {},
                   [this](std::size_t bytes) { return pool_.take(bytes); },
                   0};
};

TEST_F(ImagePoolTest, TheDetectorReadsWhereTheKernelWrote) {
  EXPECT_TRUE(capture_.report().in_place);
  for (std::uint8_t shade = 1; shade < 20; ++shade) {
    const auto image = image_from(message(shade));
    ASSERT_TRUE(image.ok());
    EXPECT_EQ(image->data, camera_->written);
    EXPECT_EQ(image->row<std::uint8_t>(47)[63], shade);
  }
}

TEST_F(ImagePoolTest, MessagesThatNobodyHoldsAreUsedAgain) {
  std::set<const std::uint8_t*> places;
  for (std::uint8_t shade = 0; shade < 100; ++shade) places.insert(message(shade)->data.data());
  EXPECT_LE(places.size(), 6u);
}

TEST_F(ImagePoolTest, MessagesThatSomebodyHoldsAreLeftAloneHoweverManyTheyAre) {
  std::vector<sensor_msgs::ImagePtr> held;
  for (std::uint8_t shade = 0; shade < 200; ++shade) held.push_back(message(shade));
  for (std::uint8_t shade = 0; shade < 200; ++shade)
    EXPECT_EQ(held[shade]->data, std::vector<std::uint8_t>(64 * 48, shade));
}

TEST_F(ImagePoolTest, MessagesOutliveTheirCamera) {
  const sensor_msgs::ImagePtr held = message(7);
  camera_->unplugged = true;
  EXPECT_FALSE(capture_.next().has_value());
  capture_ = Capture([]() -> std::unique_ptr<FrameSource> { throw CameraError("gone"); }, {}, {}, 0);
  pool_ = {};
  EXPECT_EQ(held->data, std::vector<std::uint8_t>(64 * 48, 7));
}

}  // namespace
}  // namespace lodestar
