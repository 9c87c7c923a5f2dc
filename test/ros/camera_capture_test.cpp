// The capture nodelet in this very process, so that a subscriber is in its manager; the camera is Aravis' fake GigE
// Vision camera, or pictures on disk.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/CameraInfo.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/nodelets/image_pool.hpp"
#include "lodestar/sensing/camera/open_source.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/waiting.hpp"
#include "support/camera/fake_gige_camera.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;

const char* const kNode = "camera_capture";

class CameraCapture : public testing::Test {
 protected:
  void SetUp() override {
    ros::param::del("/camera_capture");
    char name[] = "/tmp/lodestar_camera_capture_XXXXXX";
    folder_ = mkdtemp(name);
  }
  void TearDown() override {
    loader_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// Whether the nodelet could be loaded.
  bool load(const std::string& uri) {
    ros::param::set("/camera_capture/uri", uri);
    loader_ = std::make_unique<nodelet::Loader>(false);
    return loader_->load("/camera_capture", "lodestar/CameraCaptureNodelet", ros::M_string(), nodelet::V_string());
  }
  void set(const std::string& key, double value) { ros::param::set("/camera_capture/" + key, value); }

  std::string write_pictures(int count) {
    for (int i = 0; i < count; ++i) {
      cv::Mat picture(48, 64, CV_8UC1, cv::Scalar(10 * i));
      cv::imwrite(folder_ + "/frame_000" + std::to_string(i) + ".png", picture);
    }
    return "file:" + folder_ + "/frame_%04d.png";
  }
  void write_calibration(int width_px) {
    const std::string path = folder_ + "/camera.yaml";
    std::ofstream(path)
        << "image_width: " << width_px
        << "\nimage_height: 48\ncamera_name: camera\ncamera_matrix: {rows: 3, cols: 3, data: [30, 0, 31.5, "
           "0, 30, 23.5, 0, 0, 1]}\ndistortion_model: equidistant\ndistortion_coefficients: {rows: 1, "
           "cols: 4, data: [0.1, 0, 0, 0]}\nrectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, "
           "1, 0, 0, 0, 1]}\nprojection_matrix: {rows: 3, cols: 4, data: [30, 0, 31.5, 0, 0, 30, 23.5, "
           "0, 0, 0, 1, 0]}\n";
    ros::param::set("/camera_capture/camera_info_url", "file://" + path);
  }
  bool more_images(std::size_t count) {
    const std::size_t before = images_.size();
    return wait_for([&] { return images_.size() >= before + count; });
  }
  bool told(const std::string& words, double limit_s) {
    return wait_for([&] { return diagnostics_.message(kNode).find(words) != std::string::npos; }, limit_s);
  }

  std::string folder_;
  ros::NodeHandle nh_;
  Inbox<sensor_msgs::Image> images_{nh_, "/camera/image_raw"};
  Inbox<sensor_msgs::CameraInfo> infos_{nh_, "/camera/camera_info"};
  Diagnostics diagnostics_{nh_};
  std::unique_ptr<nodelet::Loader> loader_;
};

TEST_F(CameraCapture, PicturesOnDiskWithTheirCalibration) {
  write_calibration(64);
  set("rate_hz", 100);
  ASSERT_TRUE(load(write_pictures(4) + "?loop"));
  ASSERT_TRUE(more_images(60));
  const sensor_msgs::Image& image = images_.last();
  EXPECT_EQ(image.encoding, "mono8");
  EXPECT_EQ(image.header.frame_id, "camera_optical_frame");
  EXPECT_EQ(image.width, 64u);
  EXPECT_EQ(image.data[0] % 10, 0);
  EXPECT_LT(std::abs((ros::Time::now() - image.header.stamp).toSec()), 5);
  EXPECT_EQ(infos_.last().distortion_model, "equidistant");
  EXPECT_EQ(infos_.last().K[2], 31.5);
  EXPECT_EQ(infos_.all().front()->header.stamp, images_.all().front()->header.stamp);
  ASSERT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "images count") > 0; }));
  EXPECT_EQ(diagnostics_.level(kNode), 0) << diagnostics_.message(kNode);
  EXPECT_NEAR(std::stod(diagnostics_.value(kNode, "frame rate_hz")), 100, 5);
}

TEST_F(CameraCapture, ACalibrationOfAnotherModeIsNotUsed) {
  write_calibration(640);
  set("rate_hz", 100);
  ASSERT_TRUE(load(write_pictures(4) + "?loop"));
  ASSERT_TRUE(more_images(1));
  ASSERT_TRUE(told("calibrated for 640 x 48 px", 5)) << diagnostics_.message(kNode);
  EXPECT_EQ(infos_.last().K[0], 0);
  EXPECT_EQ(infos_.last().width, 64u);
}

TEST_F(CameraCapture, ARecordingEnds) {
  set("rate_hz", 100);
  ASSERT_TRUE(load(write_pictures(4)));
  EXPECT_TRUE(told("the recording is over", 5)) << diagnostics_.message(kNode);
  EXPECT_EQ(images_.size(), 4u);
}

TEST_F(CameraCapture, ASimulatedCameraKnowsItsLens) {
  ASSERT_TRUE(load(std::string("sim:") + LODESTAR_SOURCE_DIR + "/test/ros/scenario.yaml"));
  ASSERT_TRUE(more_images(10));
  EXPECT_EQ(infos_.last().K[0], 90);
}

TEST_F(CameraCapture, WrongParametersStopTheStart) {
  EXPECT_FALSE(load("webcam"));
  EXPECT_FALSE(load("file:" + folder_ + "/x.png?fast"));
  set("exposure_s", 0.001);
  EXPECT_FALSE(load(write_pictures(1))) << "a file cannot be exposed";
}

TEST_F(CameraCapture, ACameraThatIsNotThereYetIsAwaited) {
  set("rate_hz", 100);
  ASSERT_TRUE(load("file:" + folder_ + "/frame_%04d.png?loop"));
  EXPECT_TRUE(told("camera lost", 3)) << diagnostics_.message(kNode);
  write_pictures(4);
  EXPECT_TRUE(more_images(10));
}

class GigeCapture : public CameraCapture {
 protected:
  void SetUp() override {
    CameraCapture::SetUp();
    if (!LODESTAR_HAS_ARAVIS || !FakeGigeCamera::installed()) GTEST_SKIP() << "no Aravis, or no aravis-tools";
    set("rate_hz", 100);
    set("exposure_s", 0.002);
  }
};

TEST_F(GigeCapture, UnpluggedIsToldWithinASecondAndTheCameraIsTakenUpAgain) {
  FakeGigeCamera camera;
  ASSERT_TRUE(load(FakeGigeCamera::kUri));
  ASSERT_TRUE(more_images(20));
  camera.unplug();
  const ros::WallTime unplugged = ros::WallTime::now();
  ASSERT_TRUE(told("camera lost", 5)) << diagnostics_.message(kNode);
  EXPECT_LT((ros::WallTime::now() - unplugged).toSec(), 1.0);
  EXPECT_EQ(diagnostics_.level(kNode), 2);
  camera.plug_in();
  ASSERT_TRUE(more_images(20));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "reconnects") >= 1; }));
  EXPECT_NE(diagnostics_.value(kNode, "stamps").find("moved to the middle"), std::string::npos);
}

TEST_F(GigeCapture, ImagesThatNobodyTriggeredAreNotMissed) {
  const FakeGigeCamera camera;
  ros::param::set("/camera_capture/trigger", "Software");
  set("stale_warn_s", 0.1);
  ASSERT_TRUE(load(FakeGigeCamera::kUri));
  ASSERT_TRUE(wait_for([&] {
    const std::string age_s = diagnostics_.value(kNode, "images age_s");
    return !age_s.empty() && std::stod(age_s) > 0.5;
  }));
  EXPECT_EQ(diagnostics_.message(kNode).find("images"), std::string::npos) << diagnostics_.message(kNode);
  loader_.reset();  // before its camera, or it waits for answers
}

TEST_F(GigeCapture, SettingsBeyondTheCamerasLimitsStopTheStart) {
  const FakeGigeCamera camera;
  set("exposure_s", 20);
  EXPECT_FALSE(load(FakeGigeCamera::kUri));
}

// Whether a gain may be negative is for the camera to say.
TEST_F(GigeCapture, TheLimitsOfAGainAreTheCameras) {
  const FakeGigeCamera camera;
  Inbox<rosgraph_msgs::Log> log(nh_, "/rosout");
  set("gain", -3);
  EXPECT_FALSE(load(FakeGigeCamera::kUri));
  EXPECT_TRUE(wait_for([&] {
    return std::any_of(log.all().begin(), log.all().end(), [](const auto& line) {
      return line->msg.find("gain is -3, the camera takes 0 to 10") != std::string::npos;
    });
  }));
}

// What the driver wrote is what the detector reads: the same address all the way.
TEST_F(GigeCapture, NobodyCopiesAFrame) {
  const FakeGigeCamera camera;
  ImagePool pool;
  std::vector<const std::uint8_t*> given;
  CameraSettings settings;
  settings.rate_hz = 100;
  Capture capture([] { return open_source(FakeGigeCamera::kUri); }, settings,
                  [&](std::size_t bytes) {
                    const FrameMemory memory = pool.take(bytes);
                    given.push_back(memory.data);
                    return memory;
                  },
                  0);
  std::vector<const std::uint8_t*> read;
  const ros::Subscriber detector = nh_.subscribe<sensor_msgs::Image>(
      "copy_free", 10, [&](const sensor_msgs::ImageConstPtr& message) { read.push_back(image_from(message)->data); });
  ros::Publisher publisher = nh_.advertise<sensor_msgs::Image>("copy_free", 10);
  ASSERT_TRUE(wait_for([&] { return publisher.getNumSubscribers() > 0; }));
  for (std::size_t frames = 0; frames < 20;) {
    const auto captured = capture.next();
    if (!captured) continue;
    ASSERT_NE(std::find(given.begin(), given.end(), captured->frame.memory.data), given.end());
    publisher.publish(ImagePool::message(*captured, "camera"));
    ++frames;
    ASSERT_TRUE(wait_for([&] { return read.size() == frames; }));
    EXPECT_EQ(read.back(), captured->frame.memory.data);
  }
}

}  // namespace
