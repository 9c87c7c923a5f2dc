#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

namespace lodestar::test {

/// Everything that a topic said.
template <class Message>
class Inbox {
 public:
  Inbox(ros::NodeHandle& nh, const std::string& topic)
      : subscriber_(nh.subscribe<Message>(
            topic, 5000, [this](const boost::shared_ptr<const Message>& message) { all_.push_back(message); })) {}

  std::size_t size() const { return all_.size(); }
  bool empty() const { return all_.empty(); }
  const Message& last() const { return *all_.back(); }
  const std::vector<boost::shared_ptr<const Message>>& all() const { return all_; }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  void clear() { all_.clear(); }

 private:
  std::vector<boost::shared_ptr<const Message>> all_;
  ros::Subscriber subscriber_;
};

}  // namespace lodestar::test
