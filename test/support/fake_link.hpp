#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lodestar/wms/message_link.hpp"

namespace lodestar::test {

/// A link that is lists: what it is told, and what it tells.
class FakeLink : public MessageLink {
 public:
  void connect(std::size_t broker, const MqttMessage& will) override {
    tried.push_back(broker);
    wills.push_back(will);
    inbox.push_back(working.at(broker) ? LinkEvent(LinkUp{}) : LinkEvent(LinkDown{"refused"}));
  }
  void subscribe(const std::string& topic, int) override { subscribed.push_back(topic); }
  bool publish(const MqttMessage& message) override {
    sent.push_back(message);
    return true;
  }
  void disconnect() override {}
  std::vector<LinkEvent> take() override { return std::exchange(inbox, {}); }

  std::vector<MqttMessage> on(const std::string& end_of_topic) const {
    std::vector<MqttMessage> out;
    for (const MqttMessage& message : sent)
      if (message.topic.size() >= end_of_topic.size() &&
          message.topic.compare(message.topic.size() - end_of_topic.size(), std::string::npos, end_of_topic) == 0)
        out.push_back(message);
    return out;
  }

  std::vector<bool> working = {true};
  std::vector<std::size_t> tried;
  std::vector<MqttMessage> wills, sent;
  std::vector<std::string> subscribed;
  std::vector<LinkEvent> inbox;
};

}  // namespace lodestar::test
