#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lodestar/IrFrame.h"
#include "ros/support/waiting.hpp"

namespace lodestar::test {

/// Plays a bag as a vehicle would, with /clock, as fast as the nodes keep up: after each image it waits for an answer,
/// so that a slow machine loses no frame. Between two calls of play() time stands, and a test may say what it likes.
class BagPlayer {
 public:
  BagPlayer(ros::NodeHandle& nh, const std::string& path) : bag_(path) {
    clock_ = nh.advertise<rosgraph_msgs::Clock>("/clock", 10);
    advertise<sensor_msgs::Image>(nh, "/camera/image_raw");
    advertise<sensor_msgs::CameraInfo>(nh, "/camera/camera_info");
    advertise<sensor_msgs::Imu>(nh, "/imu/data");
    advertise<nav_msgs::Odometry>(nh, "/odom");
    advertise<IrFrame>(nh, "/ir/frames");
    view_ = std::make_unique<rosbag::View>(bag_);
    for (const rosbag::MessageInstance& message : *view_) messages_.push_back(message);
    tf_static_ = nh.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    for (const auto& message : messages_) {
      if (const auto truth = message.instantiate<geometry_msgs::PoseStamped>()) {
        if (message.getTopic() == "/ground_truth/pose") truth_.push_back(*truth);
      }
      if (message.getTopic() == "/tf_static") mounts_ = message.instantiate<tf2_msgs::TFMessage>();
    }
  }

  /// The mounts of the vehicle; latched.
  void send_mounts() { tf_static_.publish(mounts_); }

  /// What says that an image was answered: a count that grows with each.
  void answered_by(std::function<std::size_t()> count) { answers_ = std::move(count); }
  /// Looks at an outgoing message of this topic; false: it is not sent.
  template <class Message>
  void on(const std::string& topic, std::function<bool(const Message&)> filter) {
    filters_[topic] = [filter](const rosbag::MessageInstance& message) {
      const auto content = message.instantiate<Message>();
      return !content || filter(*content);
    };
  }

  /// Waits until all that the test is about listens.
  bool connected(const std::vector<std::string>& topics) {
    return wait_for([&] {
      for (const std::string& topic : topics)
        if (publishers_.at(topic).getNumSubscribers() == 0) return false;
      return true;
    });
  }

  /// Of a node that was ended.
  bool disconnected(const std::string& topic) {
    return wait_for([&] { return publishers_.at(topic).getNumSubscribers() == 0; });
  }

  /// The next seconds of the bag.
  void play(double duration_s) {
    if (next_ >= messages_.size()) return;
    const ros::Time begin = messages_[next_].getTime();
    for (; next_ < messages_.size(); ++next_) {
      const rosbag::MessageInstance& message = messages_[next_];
      if ((message.getTime() - begin).toSec() > duration_s) return;
      send_clock(message.getTime());
      const auto filter = filters_.find(message.getTopic());
      if (filter == filters_.end() || filter->second(message)) send(message);
    }
  }
  /// Plays on until it is so; a busy machine may lose messages, and be late with what it makes of the others.
  bool play_until(const std::function<bool()>& condition) {
    return wait_for([&] {
      if (condition()) return true;
      play(0.1);
      return false;
    });
  }
  /// Nodes that start anew then do not answer at once.
  void rewind() {
    next_ = 0;
    answering_ = false;
  }
  bool at_end() const { return next_ >= messages_.size(); }

  template <class Message>
  void publish(const std::string& topic, const Message& message) {
    publishers_.at(topic).publish(message);
  }
  /// The first message of a topic, to be made worse.
  template <class Message>
  Message sample(const std::string& topic) const {
    for (const auto& message : messages_)
      if (message.getTopic() == topic) return *message.instantiate<Message>();
    throw std::runtime_error("the bag has no " + topic);
  }
  /// The last wheel odometry that was played.
  nav_msgs::Odometry last_odometry() const {
    for (std::size_t i = next_; i-- > 0;)
      if (const auto odometry = messages_[i].instantiate<nav_msgs::Odometry>()) return *odometry;
    throw std::runtime_error("no odometry was played");
  }
  ros::Time now() const { return now_; }
  const std::vector<geometry_msgs::PoseStamped>& truth() const { return truth_; }

 private:
  template <class Message>
  void advertise(ros::NodeHandle& nh, const std::string& topic) {
    publishers_[topic] = nh.advertise<Message>(topic, 500);
    senders_[topic] = [this, topic](const rosbag::MessageInstance& message) {
      publishers_[topic].publish(message.instantiate<Message>());
    };
  }

  void send_clock(const ros::Time& time) {
    rosgraph_msgs::Clock clock;
    clock.clock = time;
    if (time == now_) return;
    clock_.publish(clock);
    now_ = time;
    ros::spinOnce();
    ros::WallDuration(0.001).sleep();
  }

  void send(const rosbag::MessageInstance& message) {
    const auto sender = senders_.find(message.getTopic());
    if (sender == senders_.end()) return;
    const std::size_t before = answers_ ? answers_() : 0;
    sender->second(message);
    if (message.getTopic() != "/camera/image_raw") return;
    if (!answers_) return;
    // Whoever answered the image before will answer this one; whoever did not may never.
    answering_ = wait_for([&] { return answers_() > before; }, answering_ ? 30.0 : 0.1);
  }

  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;
  std::vector<rosbag::MessageInstance> messages_;
  std::size_t next_ = 0;
  ros::Time now_;
  std::vector<geometry_msgs::PoseStamped> truth_;
  tf2_msgs::TFMessageConstPtr mounts_;
  std::function<std::size_t()> answers_;
  bool answering_ = false;
  std::map<std::string, std::function<bool(const rosbag::MessageInstance&)>> filters_;
  std::map<std::string, std::function<void(const rosbag::MessageInstance&)>> senders_;
  std::map<std::string, ros::Publisher> publishers_;
  ros::Publisher clock_, tf_static_;
};

}  // namespace lodestar::test
