#include "lodestar/ros/bag/recording.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace lodestar {
namespace {

namespace fs = std::filesystem;

Stamp at(double time_s) { return Stamp(std::chrono::seconds(1000)) + from_seconds(time_s); }

/// A folder of its own for each test, gone afterwards.
class RecordingTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string folder = (fs::temp_directory_path() / "lodestar_bag_XXXXXX").string();
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    folder_ = folder;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name = "a.bag") const { return (folder_ / name).string(); }

  fs::path folder_;
};

/// Pixels differ from frame to frame, too noisy to vanish in compression.
struct Frame {
  std::vector<std::uint8_t> pixels;
  Image image;
};

Frame frame(Stamp stamp, int width_px = 64, int height_px = 48) {
  Frame out;
  std::uint32_t noise = static_cast<std::uint32_t>(stamp.time_since_epoch().count());
  for (int i = 0; i < width_px * height_px; ++i) {
    noise = noise * 1664525u + 1013904223u;
    out.pixels.push_back(static_cast<std::uint8_t>(noise >> 24));
  }
  out.image.stamp = stamp;
  out.image.width_px = width_px;
  out.image.height_px = height_px;
  out.image.stride_bytes = static_cast<std::size_t>(width_px);
  out.image.data = out.pixels.data();
  return out;
}

CameraIntrinsics lens() {
  CameraIntrinsics intrinsics;
  intrinsics.width_px = 64;
  intrinsics.height_px = 48;
  intrinsics.fx_px = intrinsics.fy_px = 20;
  return intrinsics;
}

Mount mount(const std::string& parent, const std::string& child, double yaw_rad, double z_m) {
  Mount out{parent, child, RigidTransform::Identity()};
  out.T_parent_child.linear() = rotation({0, 0, yaw_rad});
  out.T_parent_child.translation().z() = z_m;
  return out;
}

RecordingWriterParams with_mounts() {
  RecordingWriterParams params;
  params.mounts = {mount("base_link", "mast", 0, 1), mount("mast", "camera_optical_frame", 0, 1.2),
                   mount("base_link", "imu_link", 1.0, 0)};
  return params;
}

OdometrySample standing(Stamp stamp) {
  OdometrySample sample;
  sample.stamp = stamp;
  return sample;
}

std::vector<Record> read_all(RecordingReader& reader) {
  std::vector<Record> records;
  while (auto record = reader.next()) records.push_back(std::move(*record));
  return records;
}

std::string error_of(const std::string& path) {
  try {
    RecordingReader reader(path);
    read_all(reader);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RecordingTest, WhatIsWrittenComesBack) {
  for (const BagCompression compression : {BagCompression::kNone, BagCompression::kBz2, BagCompression::kLz4}) {
    RecordingWriterParams params = with_mounts();
    params.compression = compression;
    RecordingWriter writer(path(), params);
    ImuSample imu;
    imu.stamp = at(0);
    imu.angular_velocity_rad_s = {0.1, 0.2, 0.3};
    imu.specific_force_m_s2 = {0.5, -0.5, 9.8};
    writer.write(at(0), imu);
    OdometrySample odometry;
    odometry.stamp = at(0.001);
    odometry.velocity_m_s = {2, 0};
    writer.write(at(0.001), odometry);
    const Frame original = frame(at(0.002));
    writer.write(at(0.003), lens(), at(0.002));
    writer.write(at(0.003), original.image);
    RawIrFrame ir;
    ir.stamp = at(0.004);
    ir.octets[45] = 7;
    writer.write(at(0.03), ir);
    writer.write(at(0.04), TruthPose{at(0.04), mount("", "", 0.5, 2).T_parent_child});
    writer.write(at(0.05), TruthCameraPose{at(0.05), mount("", "", 0.7, 3).T_parent_child});
    writer.close();

    RecordingReader reader(path());
    EXPECT_EQ(reader.begin(), at(0));
    EXPECT_EQ(reader.end(), at(0.05));
    EXPECT_EQ(reader.message_count("/camera/image_raw"), 1u);
    EXPECT_EQ(reader.message_count("/no/such/topic"), 0u);
    ASSERT_TRUE(reader.T_base_camera());
    EXPECT_NEAR(reader.T_base_camera()->translation().z(), 2.2, 1e-12);
    EXPECT_FALSE(reader.mount("fork"));

    const std::vector<Record> records = read_all(reader);
    ASSERT_EQ(records.size(), 7u);
    EXPECT_TRUE(std::get<ImuSample>(records[0].content).specific_force_m_s2.isApprox(imu.specific_force_m_s2, 1e-12));
    EXPECT_TRUE(
        std::get<ImuSample>(records[0].content).angular_velocity_rad_s.isApprox(imu.angular_velocity_rad_s, 1e-12));
    EXPECT_EQ(std::get<OdometrySample>(records[1].content).velocity_m_s.x(), 2);
    EXPECT_EQ(std::get<CameraIntrinsics>(records[2].content).fx_px, 20);
    const Image& image = std::get<Image>(records[3].content);
    EXPECT_EQ(image.stamp, at(0.002));
    EXPECT_EQ(records[3].received, at(0.003));
    EXPECT_TRUE(std::equal(original.pixels.begin(), original.pixels.end(), image.data));
    EXPECT_EQ(std::get<RawIrFrame>(records[4].content).octets, ir.octets);
    EXPECT_NEAR(std::get<TruthPose>(records[5].content).T_map_base.translation().z(), 2, 1e-12);
    EXPECT_NEAR(std::get<TruthCameraPose>(records[6].content).T_map_camera.translation().z(), 3, 1e-12);
    EXPECT_TRUE(reader.drops().empty());
    EXPECT_EQ(reader.progress(), 1.0);
  }
}

TEST_F(RecordingTest, WhatTheLineFoundIsWrittenUnderItsTopics) {
  {
    RecordingWriterParams params = with_mounts();
    params.tone_table_hz = {6, 8};
    RecordingWriter writer(path(), params);
    StateEstimate estimate;
    estimate.stamp = at(1);
    Fix fix;
    fix.stamp = at(1);
    writer.write(at(1), Announcement{});
    writer.write(at(1), Sightings{at(1), {}});
    writer.write(at(1), fix);
    writer.write(at(1), estimate);
    writer.write(at(1), "map", "odom", at(1), RigidTransform::Identity());
  }
  rosbag::Bag bag(path());
  std::map<std::string, std::string> types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    types[connection->topic] = connection->datatype;
    EXPECT_EQ(connection->header->count("latching"), connection->topic == "/tf_static" ? 1u : 0u);
  }
  EXPECT_EQ(types, (std::map<std::string, std::string>{
                       {"/beacons/announcements", "lodestar/BeaconAnnouncement"},
                       {"/beacons/sightings", "lodestar/BeaconSightingArray"},
                       {"/beacons/fix", "geometry_msgs/PoseWithCovarianceStamped"},
                       {"/pose", "geometry_msgs/PoseWithCovarianceStamped"},
                       {"/odometry/filtered", "nav_msgs/Odometry"},
                       {"/tf", "tf2_msgs/TFMessage"},
                       {"/tf_static", "tf2_msgs/TFMessage"},
                   }));
}

// Recorders write messages in another order than that of their reception times.
TEST_F(RecordingTest, OrderIsThatOfReceptionAcrossChunks) {
  constexpr int kFrames = 100;
  RecordingWriterParams params = with_mounts();
  params.compression = BagCompression::kBz2;
  RecordingWriter writer(path(), params);
  for (int i = 0; i < kFrames; ++i) {
    ImuSample imu;
    imu.stamp = at(0.01 * i + 0.005);
    writer.write(imu.stamp, imu);
    // Older than the sample before, so that a chunk, which a frame fills up, ends later than the next one begins.
    const Stamp older = at(0.01 * i - 0.012);
    const Frame late = frame(older, 200, 160);
    writer.write(older, late.image);
  }
  writer.close();

  RecordingReader reader(path());
  const std::vector<Record> records = read_all(reader);
  ASSERT_EQ(records.size(), 2u * kFrames);
  for (std::size_t i = 1; i < records.size(); ++i) EXPECT_LT(records[i - 1].received, records[i].received);
}

TEST_F(RecordingTest, ProgressGrowsWithTime) {
  RecordingWriter writer(path(), with_mounts());
  for (int i = 0; i <= 4; ++i) writer.write(at(i), standing(at(i)));
  writer.close();
  RecordingReader reader(path());
  EXPECT_EQ(reader.progress(), 0);
  reader.next();
  reader.next();
  EXPECT_NEAR(reader.progress(), 0.25, 1e-9);
}

TEST_F(RecordingTest, IntrinsicsComeOnceAndWhenTheyChange) {
  RecordingWriter writer(path(), with_mounts());
  CameraIntrinsics other = lens();
  other.fx_px = 21;
  writer.write(at(0), lens(), at(0));
  writer.write(at(1), lens(), at(1));
  writer.write(at(2), other, at(2));
  writer.close();
  RecordingReader reader(path());
  const std::vector<Record> records = read_all(reader);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[1].received, at(2));
}

TEST_F(RecordingTest, BadMessagesAreDroppedAndCountedByTopicAndReason) {
  {
    rosbag::Bag bag(path(), rosbag::bagmode::Write);
    sensor_msgs::Image image;
    image.encoding = "rgb8";
    bag.write("/camera/image_raw", ros::Time(1), image);
    bag.write("/camera/image_raw", ros::Time(2), image);
    sensor_msgs::Imu imu;
    imu.header.stamp = ros::Time(3);
    imu.header.frame_id = "imu_link";
    bag.write("/imu/data", ros::Time(3), imu);
    bag.write("/odom", ros::Time(4), std_msgs::String());
    bag.write("/other", ros::Time(5), std_msgs::String());
  }
  RecordingReader reader(path());
  EXPECT_TRUE(read_all(reader).empty());
  using Key = std::pair<std::string, std::string>;
  EXPECT_EQ(reader.drops(), (std::map<Key, std::uint64_t>{
                                {{"/camera/image_raw", "wrong_encoding"}, 2},
                                {{"/imu/data", "wrong_frame"}, 1},
                                {{"/odom", "is a std_msgs/String and has to be a nav_msgs/Odometry"}, 1},
                            }));
}

TEST_F(RecordingTest, GivenMountOfTheImuGoesBeforeTheBags) {
  RecordingWriter writer(path(), with_mounts());
  ImuSample imu;
  imu.stamp = at(0);
  imu.specific_force_m_s2 = {1, 0, 0};
  writer.write(at(0), imu);
  writer.close();
  RecordingReaderParams params;
  params.T_base_imu = RigidTransform::Identity();
  RecordingReader reader(path(), params);
  const auto record = reader.next();
  ASSERT_TRUE(record);
  EXPECT_NEAR(std::get<ImuSample>(record->content).specific_force_m_s2.y(), -std::sin(1.0), 1e-12);
}

TEST_F(RecordingTest, TruthOnlyLeavesTheRestOut) {
  RecordingWriter writer(path(), with_mounts());
  writer.write(at(0), TruthPose{at(0), RigidTransform::Identity()});
  writer.write(at(1), standing(at(1)));
  writer.close();
  RecordingReaderParams params;
  params.truth_only = true;
  RecordingReader reader(path(), params);
  EXPECT_EQ(read_all(reader).size(), 1u);
}

TEST_F(RecordingTest, MissingFileSaysWhichAndWhatToDo) {
  EXPECT_NE(error_of(path("none.bag")).find("none.bag cannot be opened"), std::string::npos);
  EXPECT_NE(error_of(folder_.string()).find("cannot be opened"), std::string::npos);
}

TEST_F(RecordingTest, NotABag) {
  std::ofstream(path()) << "beacons: []\n";
  EXPECT_NE(error_of(path()).find("is not a bag"), std::string::npos);
  std::ofstream(path("empty.bag")).close();
  EXPECT_NE(error_of(path("empty.bag")).find("is not a bag"), std::string::npos);
  std::ofstream(path("old.bag")) << "#ROSBAG V1.2\n";
  EXPECT_NE(error_of(path("old.bag")).find("rosbag migrate"), std::string::npos);
}

/// A bag of some chunks.
void write_frames(const std::string& path) {
  RecordingWriterParams params;
  params.compression = BagCompression::kBz2;
  RecordingWriter writer(path, params);
  for (int i = 0; i < 30; ++i) {
    const Frame original = frame(at(0.01 * i), 200, 160);
    writer.write(at(0.01 * i), original.image);
  }
}

TEST_F(RecordingTest, TruncatedBag) {
  write_frames(path());
  const auto size = fs::file_size(path());
  for (const double part : {0.001, 0.3, 0.7, 0.9999}) {
    fs::copy_file(path(), path("cut.bag"), fs::copy_options::overwrite_existing);
    fs::resize_file(path("cut.bag"), static_cast<std::uintmax_t>(static_cast<double>(size) * part));
    EXPECT_NE(error_of(path("cut.bag")).find("in the middle of its data"), std::string::npos) << part;
  }
}

TEST_F(RecordingTest, BagWithoutIndex) {
  write_frames(path());
  // What a recorder leaves that died: the header's index position is still zero.
  std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
  std::string head(4096, '\0');
  file.read(head.data(), 4096);
  const auto field = head.find("index_pos=");
  ASSERT_NE(field, std::string::npos);
  file.seekp(static_cast<std::streamoff>(field + 10));
  file.write("\0\0\0\0\0\0\0\0", 8);
  file.close();
  EXPECT_NE(error_of(path()).find("rosbag reindex"), std::string::npos);
}

TEST_F(RecordingTest, DamagedChunk) {
  write_frames(path());
  std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(path()) / 2));
  file.write("damage", 6);
  file.close();
  EXPECT_NE(error_of(path()).find("is damaged"), std::string::npos);
}

TEST_F(RecordingTest, ReaderMayBeLeftHalfWay) {
  write_frames(path());
  RecordingReader reader(path());
  EXPECT_TRUE(reader.next());
}

TEST_F(RecordingTest, WriterSaysWhyItCannot) {
  try {
    RecordingWriter writer(path("no/such/folder/a.bag"));
    FAIL() << "opened";
  } catch (const RecordingError& error) {
    EXPECT_NE(std::string(error.what()).find("no/such/folder/a.bag cannot be written"), std::string::npos);
  }
}

}  // namespace
}  // namespace lodestar
