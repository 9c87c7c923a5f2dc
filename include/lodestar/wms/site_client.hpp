#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "lodestar/wms/broker_list.hpp"
#include "lodestar/wms/message_link.hpp"
#include "lodestar/wms/site_inbox.hpp"

namespace lodestar {

/// A site as the bridge wants it: hears the events of one truck or all, hands each on once and in order, then
/// acknowledges. bridge_tail is one; a warehouse's software does the same in its own way.
class SiteClient {
 public:
  /// Keeps the document: when this returns it is acknowledged.
  using Keep = std::function<void(const std::string& topic, const std::string& document)>;

  /// @param manufacturer, serial of the truck; "+": any @param link must outlive this
  SiteClient(MessageLink& link, std::size_t brokers, const BackOff& back_off, const std::string& manufacturer,
             const std::string& serial, Keep keep);

  /// Call it often.
  void poll(Instant now);

  bool connected() const { return brokers_.is_up(); }
  const std::string& last_failure() const { return last_failure_; }
  std::uint64_t repeated() const { return repeated_; }  ///< documents that came again, and were not handed on

 private:
  void take(const MqttMessage& message);
  void take_event(const MqttMessage& message);

  MessageLink& link_;
  BrokerList brokers_;
  SiteTopics topics_;
  Keep keep_;
  SiteInbox inbox_;
  std::map<std::string, std::string> to_acknowledge_;  ///< stream -> topic
  std::string last_failure_;
  std::uint64_t repeated_ = 0;
};

}  // namespace lodestar
