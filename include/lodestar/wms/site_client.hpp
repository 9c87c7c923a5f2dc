#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lodestar/wms/broker_list.hpp"
#include "lodestar/wms/message_link.hpp"
#include "lodestar/wms/site_inbox.hpp"

namespace lodestar {

/// A site as the bridge wants it: hears the events of one truck or all at all brokers at once, hands each on once and
/// in order, then acknowledges. bridge_tail is one; a warehouse's software does the same in its own way.
class SiteClient {
 public:
  /// Keeps the document: when this returns it is acknowledged.
  using Keep = std::function<void(const std::string& topic, const std::string& document)>;

  /// @param brokers a link to each, that knows no other @param manufacturer, serial of the truck; "+": any
  SiteClient(std::vector<std::unique_ptr<MessageLink>> brokers, const BackOff& back_off,
             const std::string& manufacturer, const std::string& serial, Keep keep);

  /// Call it often.
  void poll(Instant now);
  /// Sends the last acknowledgements, then ends the connections.
  void disconnect();

  /// Why it does not listen at this broker; empty: it does, or tries for the first time.
  const std::string& failure(std::size_t broker) const { return posts_.at(broker).failure; }
  std::uint64_t repeated() const { return repeated_; }  ///< documents that came again, and were not handed on

 private:
  /// Where it listens.
  struct Post {
    std::unique_ptr<MessageLink> link;
    BrokerList attempts;
    std::string failure;
  };
  void listen(Post& post, Instant now);
  void acknowledge();
  void take(const MqttMessage& message);
  void take_event(const MqttMessage& message);

  std::vector<Post> posts_;
  SiteTopics topics_;
  Keep keep_;
  SiteInbox inbox_;
  std::map<std::string, std::string> to_acknowledge_;  ///< stream -> topic
  std::uint64_t repeated_ = 0;
};

}  // namespace lodestar
