#include "lodestar/ros/convert/image.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <boost/weak_ptr.hpp>
#include <limits>
#include <set>
#include <string>

namespace lodestar {
namespace {

/// 4 x 3 pixels, rows padded by two bytes.
sensor_msgs::Image mono8() {
  sensor_msgs::Image message;
  message.header.stamp = ros::Time(100, 5);
  message.width = 4;
  message.height = 3;
  message.step = 6;
  message.encoding = "mono8";
  for (std::uint8_t i = 0; i < 18; ++i) message.data.push_back(i);
  return message;
}

sensor_msgs::Image mono16() {
  sensor_msgs::Image message = mono8();
  message.encoding = "mono16";
  message.step = 8;
  message.data.resize(24);
  return message;
}

Result<Image, MessageDrop> convert(const sensor_msgs::Image& message, double time_offset_s = 0) {
  return image_from(boost::make_shared<const sensor_msgs::Image>(message), time_offset_s);
}

MessageDrop drop(const sensor_msgs::Image& message) { return convert(message).error(); }

TEST(ImageFrom, LooksAtTheMessagesOwnPixels) {
  const auto message = boost::make_shared<const sensor_msgs::Image>(mono8());
  const auto image = image_from(message);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->data, message->data.data());
  EXPECT_EQ(image->width_px, 4);
  EXPECT_EQ(image->height_px, 3);
  EXPECT_EQ(image->bits, 8);
  EXPECT_EQ(image->row<std::uint8_t>(2)[3], 15);
  EXPECT_EQ(image->stamp, Stamp(std::chrono::nanoseconds(100'000'000'005)));
}

TEST(ImageFrom, KeepsTheMessageAlive) {
  auto message = boost::make_shared<const sensor_msgs::Image>(mono8());
  const boost::weak_ptr<const sensor_msgs::Image> watch = message;
  Image image = image_from(message).value();
  message.reset();
  EXPECT_FALSE(watch.expired());
  EXPECT_EQ(image.row<std::uint8_t>(0)[1], 1);
  image = Image();
  EXPECT_TRUE(watch.expired());
}

TEST(ImageFrom, AddsTheTimeOffset) {
  EXPECT_EQ(convert(mono8(), -0.25)->stamp, Stamp(std::chrono::nanoseconds(99'750'000'005)));
}

TEST(ImageFrom, Takes16Bits) {
  sensor_msgs::Image message = mono16();
  message.data[8 + 2] = 0x34;
  message.data[8 + 3] = 0x12;
  const auto image = convert(message);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->bits, 16);
  EXPECT_EQ(image->row<std::uint16_t>(1)[1], 0x1234);
}

TEST(ImageFrom, RefusesEachFaultByItsReason) {
  const auto broken = [](auto&& change, sensor_msgs::Image message = mono8()) {
    change(message);
    return drop(message);
  };
  EXPECT_EQ(broken([](auto& m) { m.encoding = "rgb8"; }), MessageDrop::kEncoding);
  EXPECT_EQ(broken([](auto& m) { m.encoding = ""; }), MessageDrop::kEncoding);
  EXPECT_EQ(broken([](auto& m) { m.is_bigendian = 1; }, mono16()), MessageDrop::kByteOrder);
  EXPECT_EQ(broken([](auto& m) { m.width = 0; }), MessageDrop::kSize);
  EXPECT_EQ(broken([](auto& m) { m.height = 0; }), MessageDrop::kSize);
  EXPECT_EQ(broken([](auto& m) { m.width = std::numeric_limits<std::uint32_t>::max(); }), MessageDrop::kSize);
  EXPECT_EQ(broken([](auto& m) { m.height = 70000; }), MessageDrop::kSize);
  EXPECT_EQ(broken([](auto& m) { m.data.push_back(0); }), MessageDrop::kSize);
  EXPECT_EQ(broken([](auto& m) { m.step = 3; }), MessageDrop::kStep);
  EXPECT_EQ(broken([](auto& m) { m.step = 9; }, mono16()), MessageDrop::kStep);
  EXPECT_EQ(broken([](auto& m) { m.data.pop_back(); }), MessageDrop::kTruncated);
  EXPECT_EQ(broken([](auto& m) { m.data.clear(); }), MessageDrop::kTruncated);
  EXPECT_EQ(broken([](auto& m) { m.header.stamp = ros::Time(); }), MessageDrop::kStamp);
}

TEST(ImageFrom, ByteOrderIsOfNoConcernFor8Bits) {
  sensor_msgs::Image message = mono8();
  message.is_bigendian = 1;
  EXPECT_TRUE(convert(message));
}

TEST(ImageMessage, PacksTheRowsAndComesBack) {
  for (const sensor_msgs::Image& original : {mono8(), mono16()}) {
    const Image image = convert(original).value();
    const sensor_msgs::Image message = image_message(image, "camera_optical_frame");
    EXPECT_EQ(message.step, 4u * static_cast<unsigned>(image.bits) / 8u);
    const auto back = convert(message);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->stamp, image.stamp);
    for (int v = 0; v < 3; ++v)
      for (std::size_t byte = 0; byte < message.step; ++byte)
        EXPECT_EQ(back->row<std::uint8_t>(v)[byte], image.row<std::uint8_t>(v)[byte]);
  }
}

TEST(MessageDropName, IsThereAndDifferentForEachReason) {
  std::set<std::string> names;
  for (int i = 0; i < static_cast<int>(MessageDrop::kCount); ++i) names.insert(name(static_cast<MessageDrop>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(MessageDrop::kCount));
  EXPECT_EQ(names.count("unknown"), 0u);
}

}  // namespace
}  // namespace lodestar
