#pragma once

#include <map>
#include <string>
#include <vector>

#include "lodestar/wms/link.hpp"
#include "lodestar/wms/site_inbox.hpp"

namespace lodestar::test {

/// The warehouse's end: takes each document once and acknowledges, over any link.
class TestSite {
 public:
  explicit TestSite(const SiteTopics& topics) : topics_(topics) {}

  /// @return false: the link broke
  bool poll(Link& link) {
    for (const LinkEvent& event : link.take()) {
      if (std::holds_alternative<LinkDown>(event)) return false;
      if (std::holds_alternative<LinkUp>(event)) greet(link);
      if (const auto* message = std::get_if<MqttMessage>(&event)) take(*message, link);
    }
    return true;
  }

  const std::vector<std::string>& documents() const { return documents_; }
  std::size_t repeated() const { return repeated_; }

 private:
  void greet(Link& link) {
    for (const std::string& topic : {topics_.stream, topics_.event}) link.subscribe(topic, 1);
    for (const std::string& stream : streams_) acknowledge(stream, link);
  }

  void take(const MqttMessage& message, Link& link) {
    if (message.topic == topics_.stream) {
      if (const auto notice = stream_notice_from(message.payload)) inbox_.learn(notice->stream, notice->acknowledged);
      return;
    }
    const auto key = document_key_from(message.payload);
    if (message.topic != topics_.event || !key) return;
    const Arrival arrival = inbox_.take(*key);
    if (arrival == Arrival::kNew) documents_.push_back(message.payload);
    if (arrival == Arrival::kRepeated) ++repeated_;
    if (streams_.empty() || streams_.back() != key->stream) streams_.push_back(key->stream);
    acknowledge(key->stream, link);
  }

  void acknowledge(const std::string& stream, Link& link) {
    link.publish({topics_.ack, message_text(inbox_.acknowledgement(stream)), 1, true});
  }

  SiteTopics topics_;
  SiteInbox inbox_;
  std::vector<std::string> streams_, documents_;
  std::size_t repeated_ = 0;
};

}  // namespace lodestar::test
