// The capture nodelet in this very process, so that a subscriber is in its manager; the camera is Aravis' fake GigE
// Vision camera, or pictures on disk.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <image_transport/image_transport.h>
#include <nodelet/loader.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/CameraInfo.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/waiting.hpp"
#include "support/camera/fake_gige_camera.hpp"

namespace {

/// Where Aravis is told to write frames.
class DriverBuffers {
 public:
  static void add(const void* data) {
    const std::lock_guard<std::mutex> lock(mutex_);
    given_.insert(data);
  }
  static bool gave(const void* data) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return given_.count(data) > 0;
  }

 private:
  inline static std::mutex mutex_;
  inline static std::set<const void*> given_;
};

}  // namespace

/// Stands before Aravis' own in this process, and notes what the library is handed.
extern "C" void* arv_buffer_new_full(std::size_t bytes, void* data, void* owner, void (*let_go)(void*)) {
  DriverBuffers::add(data);
  static const auto aravis = reinterpret_cast<decltype(&arv_buffer_new_full)>(dlsym(RTLD_NEXT, "arv_buffer_new_full"));
  return aravis(bytes, data, owner, let_go);
}

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
  bool told(const std::string& words) {
    return wait_for([&] { return diagnostics_.message(kNode).find(words) != std::string::npos; }, 50);
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
  set("rate_hz", 20);
  const ros::Time before = ros::Time::now();
  ASSERT_TRUE(load(write_pictures(4) + "?loop"));
  ASSERT_TRUE(more_images(20));
  const sensor_msgs::Image& image = images_.last();
  EXPECT_EQ(image.encoding, "mono8");
  EXPECT_EQ(image.header.frame_id, "camera_optical_frame");
  EXPECT_EQ(image.width, 64u);
  EXPECT_EQ(image.data[0] % 10, 0);
  EXPECT_GE(image.header.stamp, before);
  EXPECT_LE(image.header.stamp, ros::Time::now());
  ASSERT_TRUE(wait_for([&] { return !infos_.empty(); }));
  EXPECT_EQ(infos_.last().distortion_model, "equidistant");
  EXPECT_EQ(infos_.last().K[2], 31.5);
  EXPECT_EQ(infos_.all().front()->header.stamp, images_.all().front()->header.stamp);
  EXPECT_TRUE(wait_for([&] {  // unless the machine is too busy for a while
    return diagnostics_.count(kNode, "images count") > 0 && diagnostics_.level(kNode) == 0 &&
           std::abs(std::stod(diagnostics_.value(kNode, "frame rate_hz")) - 20) < 1;
  })) << diagnostics_.message(kNode)
      << diagnostics_.value(kNode, "frame rate_hz");
  EXPECT_EQ(diagnostics_.value(kNode, "pixels"), "copied into the message");
}

TEST_F(CameraCapture, ACalibrationOfAnotherModeIsNotUsed) {
  write_calibration(640);
  set("rate_hz", 100);
  ASSERT_TRUE(load(write_pictures(4) + "?loop"));
  ASSERT_TRUE(more_images(1));
  ASSERT_TRUE(told("calibrated for 640 x 48 px")) << diagnostics_.message(kNode);
  ASSERT_TRUE(wait_for([&] { return !infos_.empty(); }));
  EXPECT_EQ(infos_.last().K[0], 0);
  EXPECT_EQ(infos_.last().width, 64u);
}

TEST_F(CameraCapture, ARecordingEnds) {
  set("rate_hz", 100);
  ASSERT_TRUE(load(write_pictures(4)));
  EXPECT_TRUE(told("the recording is over")) << diagnostics_.message(kNode);
  EXPECT_EQ(images_.size(), 4u);
}

TEST_F(CameraCapture, ASimulatedCameraKnowsItsLens) {
  ASSERT_TRUE(load(std::string("sim:") + LODESTAR_SOURCE_DIR + "/test/ros/scenario.yaml"));
  ASSERT_TRUE(wait_for([&] { return images_.size() >= 10 && infos_.size() >= 10; }));
  EXPECT_EQ(infos_.last().K[0], 90);
}

TEST_F(CameraCapture, WrongParametersStopTheStart) {
  EXPECT_FALSE(load("webcam"));
  EXPECT_FALSE(load("file:" + folder_ + "/x.png?fast"));
  set("exposure_s", 0.001);
  EXPECT_FALSE(load(write_pictures(1))) << "a file cannot be exposed";
}

// Told at once, not with a report, of which none is due during this test.
TEST_F(CameraCapture, ACameraThatIsNotThereYetIsToldAtOnceAndAwaited) {
  set("rate_hz", 100);
  set("diagnostic_period", 60);
  ASSERT_TRUE(load("file:" + folder_ + "/frame_%04d.png?loop"));
  EXPECT_TRUE(told("camera lost")) << diagnostics_.message(kNode);
  EXPECT_EQ(diagnostics_.level(kNode), 2);
  write_pictures(4);
  EXPECT_TRUE(more_images(10));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) < 2; })) << diagnostics_.message(kNode);
}

class GigeCapture : public CameraCapture {
 protected:
  void SetUp() override {
    CameraCapture::SetUp();
    if (!LODESTAR_HAS_ARAVIS || !FakeGigeCamera::installed()) GTEST_SKIP() << "no Aravis, or no aravis-tools";
    camera_ = std::make_unique<FakeGigeCamera>();
    set("rate_hz", 100);
    set("exposure_s", 0.002);
  }
  /// A camera that answers too late, which a busy machine may make it, is one that may come, and the nodelet starts.
  bool comes_to_be_refused() {
    return wait_for([&] { return !load(FakeGigeCamera::kUri); });
  }
  void TearDown() override {
    loader_.reset();  // before its camera, or it waits for answers
    camera_.reset();
    CameraCapture::TearDown();
  }

  std::unique_ptr<FakeGigeCamera> camera_;
};

// Within which time is for CaptureTest and AnswerWatch to show: by a given clock.
TEST_F(GigeCapture, UnpluggedIsToldAndTheCameraIsTakenUpAgain) {
  ASSERT_TRUE(load(FakeGigeCamera::kUri));
  ASSERT_TRUE(more_images(20));
  camera_->unplug();
  ASSERT_TRUE(told("camera lost")) << diagnostics_.message(kNode);
  EXPECT_EQ(diagnostics_.level(kNode), 2);
  camera_->plug_in();
  ASSERT_TRUE(more_images(20));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.count(kNode, "reconnects") >= 1; }));
  EXPECT_NE(diagnostics_.value(kNode, "stamps").find("moved to the middle"), std::string::npos);
  EXPECT_EQ(diagnostics_.value(kNode, "pixels"), "written into the message by the driver");
  EXPECT_TRUE(wait_for([&] { return std::stod(diagnostics_.value(kNode, "frame jitter_ms")) > 0; }));
  EXPECT_GE(diagnostics_.count(kNode, "frames dropped by id"), 0);
}

TEST_F(GigeCapture, ACameraThatIsNotThereYetIsAwaited) {
  camera_->unplug();
  ASSERT_TRUE(load(FakeGigeCamera::kUri));
  camera_->plug_in();
  EXPECT_TRUE(more_images(10));
}

TEST_F(GigeCapture, ImagesThatNobodyTriggeredAreNotMissed) {
  ros::param::set("/camera_capture/trigger", "Software");
  set("stale_warn_s", 0.1);
  const Inbox<diagnostic_msgs::DiagnosticArray> told_from_the_first(nh_, "/diagnostics");
  ASSERT_TRUE(load(FakeGigeCamera::kUri));
  ASSERT_TRUE(wait_for([&] {
    const std::string age_s = diagnostics_.value(kNode, "images age_s");
    return !age_s.empty() && std::stod(age_s) > 0.5;
  }));
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) < 2; })) << diagnostics_.message(kNode);
  for (const auto& array : told_from_the_first.all()) {
    for (const auto& status : array->status) {
      EXPECT_EQ(status.message.find("images"), std::string::npos) << status.message;
      EXPECT_EQ(status.message.find("silent"), std::string::npos) << status.message;
    }
  }
}

TEST_F(GigeCapture, SettingsBeyondTheCamerasLimitsStopTheStart) {
  set("exposure_s", 20);
  EXPECT_TRUE(comes_to_be_refused());
}

// Whether a gain may be negative is for the camera to say.
TEST_F(GigeCapture, TheLimitsOfAGainAreTheCameras) {
  Inbox<rosgraph_msgs::Log> log(nh_, "/rosout");
  set("gain", -3);
  EXPECT_TRUE(comes_to_be_refused());
  EXPECT_TRUE(wait_for([&] {
    return std::any_of(log.all().begin(), log.all().end(), [](const auto& line) {
      return line->msg.find("gain is -3, the camera takes 0 to 10") != std::string::npos;
    });
  }));
}

// The driver is told to write into the messages, and the detector holds on to these very messages: it keeps images
// until it knows the frame rate.
TEST_F(GigeCapture, NobodyCopiesAFrame) {
  set("rate_hz", 2);  // ten seconds until then
  ros::param::set("/beacon_detection/site", std::string(LODESTAR_SOURCE_DIR) + "/test/ros/site.yaml");
  std::vector<boost::weak_ptr<const sensor_msgs::Image>> passing;
  const auto pass = [&](const sensor_msgs::ImageConstPtr& image) {
    EXPECT_TRUE(DriverBuffers::gave(image->data.data()));
    EXPECT_NE(*std::max_element(image->data.begin(), image->data.end()), 0);
    passing.push_back(image);
    images_.clear();
  };
  const auto beside = image_transport::ImageTransport(nh_).subscribe(
      "camera/image_raw", 10, boost::function<void(const sensor_msgs::ImageConstPtr&)>(pass));
  nodelet::Loader detector(false);
  ASSERT_TRUE(detector.load("/beacon_detection", "lodestar/BeaconDetectionNodelet", {}, {}));
  ASSERT_TRUE(load(FakeGigeCamera::kUri));

  ASSERT_TRUE(wait_for([&] { return diagnostics_.count("beacon_detection", "image count") >= 3; }));
  images_.clear();
  ASSERT_GE(passing.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(passing[i].expired()) << "the detector reads a copy of frame " << i;
  detector.clear();
  EXPECT_TRUE(wait_for([&] { return passing[2].expired(); })) << "somebody else held them";
}

}  // namespace
