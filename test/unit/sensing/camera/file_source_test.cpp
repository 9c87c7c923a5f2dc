#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "lodestar/sensing/camera/open_source.hpp"
#include "support/camera/heap_frames.hpp"

namespace lodestar {
namespace {

constexpr Duration kPatience = std::chrono::seconds(2);

cv::Mat picture(int number, int type) {
  cv::Mat image(48, 64, type);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      if (type == CV_8UC1) image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(number * 10 + u + v);
      if (type == CV_16UC1) image.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(number * 1000 + u * 64 + v);
    }
  return image;
}

class FileSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/lodestar_file_source_XXXXXX";
    folder_ = mkdtemp(name);
    settings_.rate_hz = 200;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write_sequence(int type) {
    for (int i = 0; i < 4; ++i) cv::imwrite(folder_ + "/frame_000" + std::to_string(i) + ".png", picture(i, type));
    return "file:" + folder_ + "/frame_%04d.png";
  }
  void expect_picture(const DeviceFrame& frame, int number, int type) {
    ASSERT_EQ(frame.width_px, 64);
    ASSERT_EQ(frame.height_px, 48);
    EXPECT_EQ(frame.bits, type == CV_8UC1 ? 8 : 16);
    EXPECT_TRUE(memory_.gave(frame.memory.data));
    const cv::Mat got(48, 64, type, frame.memory.data, frame.stride_bytes);
    EXPECT_EQ(cv::countNonZero(got != picture(number, type)), 0) << number;
  }

  std::string folder_;
  CameraSettings settings_;
  test::HeapFrames memory_;
};

TEST_F(FileSourceTest, ASequenceBitByBitAtItsRate) {
  for (const int type : {CV_8UC1, CV_16UC1}) {
    const auto source = open_source(write_sequence(type));
    source->start(settings_, memory_.allocator());
    std::optional<std::uint64_t> before;
    for (int i = 0; i < 4; ++i) {
      const auto frame = source->next(kPatience);
      ASSERT_TRUE(frame.ok());
      expect_picture(*frame, i, type);
      EXPECT_EQ(frame->id, static_cast<std::uint64_t>(i));
      EXPECT_GE(frame->ticks - before.value_or(0), 5'000'000u);
      before = frame->ticks;
    }
    EXPECT_EQ(source->next(kPatience).error(), NoFrame::kEnd);
  }
}

TEST_F(FileSourceTest, ALoopGoesOn) {
  const auto source = open_source(write_sequence(CV_8UC1) + "?loop");
  source->start(settings_, memory_.allocator());
  for (int i = 0; i < 10; ++i) {
    const auto frame = source->next(kPatience);
    ASSERT_TRUE(frame.ok());
    expect_picture(*frame, i % 4, CV_8UC1);
    EXPECT_EQ(frame->id, static_cast<std::uint64_t>(i));
  }
}

TEST_F(FileSourceTest, APictureThatCannotBeReadIsLeftOut) {
  const std::string uri = write_sequence(CV_8UC1), giant = "P5\n60000 60000\n255\n";
  for (const std::string& spoilt : {giant, std::string("P5\n64 48\n255\nshort")}) {
    std::ofstream(folder_ + "/frame_0001.png") << spoilt;
    const auto source = open_source(uri);
    source->start(settings_, memory_.allocator());
    ASSERT_TRUE(source->next(kPatience).ok());
    EXPECT_EQ(source->next(kPatience).error(), NoFrame::kFormat) << spoilt;
    const auto after = source->next(kPatience);
    ASSERT_TRUE(after.ok());
    expect_picture(*after, 2, CV_8UC1);
  }
  std::ofstream(folder_ + "/only_0000.png") << giant;
  EXPECT_THROW(open_source("file:" + folder_ + "/only_%04d.png"), CameraError);
}

TEST_F(FileSourceTest, AVideoAtItsOwnRate) {
  const std::string path = folder_ + "/video.avi";
  cv::VideoWriter writer(path, cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 100, cv::Size(64, 48), false);
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < 4; ++i) writer.write(picture(i, CV_8UC1));
  writer.release();
  const auto source = open_source("file:" + path);
  source->start({}, memory_.allocator());
  std::uint64_t first = 0;
  for (int i = 0; i < 4; ++i) {
    const auto frame = source->next(kPatience);
    ASSERT_TRUE(frame.ok());
    expect_picture(*frame, i, CV_8UC1);
    if (i == 0) first = frame->ticks;
    EXPECT_GE(frame->ticks - first, static_cast<std::uint64_t>(i) * 10'000'000u);
  }
}

TEST_F(FileSourceTest, WaitsNoLongerThanAsked) {
  settings_.rate_hz = 0.1;
  const auto source = open_source(write_sequence(CV_8UC1) + "?loop");
  source->start(settings_, memory_.allocator());
  auto frame = source->next(kPatience);
  ASSERT_TRUE(frame.ok());
  for (int i = 0; i < 20 && frame.ok(); ++i) frame = source->next(std::chrono::milliseconds(20));
  ASSERT_FALSE(frame.ok()) << "unless the machine stopped for ten seconds, again and again";
  EXPECT_EQ(frame.error(), NoFrame::kTimeout);
}

TEST_F(FileSourceTest, FaultsSayWhatToDo) {
  EXPECT_THROW(open_source("file:/nowhere/x.avi"), CameraError);
  EXPECT_THROW(open_source("file:/nowhere/x.avi?fast"), CameraRefusal);
  EXPECT_THROW(open_source("file:" + folder_ + "/later_%04d.png"), CameraError) << "it may come";
  EXPECT_THROW(open_source("file:" + folder_ + "/later_%d.png"), CameraError);
  std::ofstream(folder_ + "/letter.avi") << "no video";
  for (const char* name : {"/letter.avi", "/frame_%s.png", "/frame_%4d_%4d.png", "/frame_%"})
    EXPECT_THROW(open_source("file:" + folder_ + name), CameraRefusal) << name;
  for (const char* uri : {"webcam", "file:", "v4l2:"}) EXPECT_THROW(open_source(uri), CameraRefusal) << uri;
  const auto source = open_source(write_sequence(CV_8UC1));
  EXPECT_THROW(source->start({}, memory_.allocator()), CameraRefusal) << "no rate";
  settings_.exposure_s = 0.001;
  EXPECT_THROW(source->start(settings_, memory_.allocator()), CameraRefusal) << "a file cannot be exposed";
}

}  // namespace
}  // namespace lodestar
