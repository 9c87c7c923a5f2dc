#include "lodestar/wms/site_client.hpp"

namespace lodestar {
namespace {

/// wms/v1/<manufacturer>/<serial>/<level> with another last level.
std::string beside(const std::string& topic, const std::string& level) {
  return topic.substr(0, topic.rfind('/') + 1) + level;
}

}  // namespace

SiteClient::SiteClient(MessageLink& link, std::size_t brokers, const BackOff& back_off, const std::string& manufacturer,
                       const std::string& serial, Keep keep)
    : link_(link), brokers_(brokers, back_off), topics_(site_topics(manufacturer, serial)), keep_(std::move(keep)) {}

void SiteClient::poll(Instant now) {
  for (const LinkEvent& event : link_.take()) {
    if (std::holds_alternative<LinkUp>(event)) {
      brokers_.connected(now);
      // In this order: what is known of a stream comes before its events. No word between site and broker is needed
      // (QoS 0): what gets lost is not acknowledged, and comes again.
      for (const std::string& topic : {topics_.ack, topics_.stream, topics_.event}) link_.subscribe(topic, 0);
    } else if (const auto* down = std::get_if<LinkDown>(&event)) {
      last_failure_ = down->reason;
      brokers_.down(now);
    } else if (const auto* message = std::get_if<MqttMessage>(&event)) {
      take(*message);
    }
  }
  for (const auto& [stream, topic] : to_acknowledge_)
    link_.publish({topic, message_text(inbox_.acknowledgement(stream)), 1, true});
  to_acknowledge_.clear();
  if (const auto broker = brokers_.due(now)) link_.connect(*broker, {});
}

void SiteClient::take(const MqttMessage& message) {
  if (message.topic == beside(message.topic, "event")) return take_event(message);
  if (message.topic == beside(message.topic, "stream")) {
    if (const auto notice = stream_notice_from(message.payload)) inbox_.learn(notice->stream, notice->acknowledged);
  } else if (message.retained) {  // this site's own word of an earlier life
    if (const auto ack = acknowledgement_from(message.payload)) inbox_.learn(ack->stream, ack->sequence);
  }
}

void SiteClient::take_event(const MqttMessage& message) {
  const auto key = document_key_from(message.payload);
  if (!key) return;
  const Arrival arrival = inbox_.take(*key);
  if (arrival == Arrival::kUnknown) return;
  if (arrival == Arrival::kNew) keep_(message.topic, message.payload);
  if (arrival == Arrival::kRepeated) ++repeated_;
  to_acknowledge_[key->stream] = beside(message.topic, "ack");
}

}  // namespace lodestar
