#include "lodestar/wms/site_client.hpp"

#include <utility>

namespace lodestar {
namespace {

/// wms/v1/<manufacturer>/<serial>/<level> with another last level.
std::string beside(const std::string& topic, const std::string& level) {
  return topic.substr(0, topic.rfind('/') + 1) + level;
}

}  // namespace

SiteClient::SiteClient(std::vector<std::unique_ptr<MessageLink>> brokers, const BackOff& back_off,
                       const std::string& manufacturer, const std::string& serial, Keep keep)
    : topics_(site_topics(manufacturer, serial)), keep_(std::move(keep)) {
  for (auto& link : brokers) posts_.push_back({std::move(link), BrokerList(1, back_off), ""});
}

void SiteClient::poll(Instant now) {
  for (Post& post : posts_) listen(post, now);
  acknowledge();
}

void SiteClient::listen(Post& post, Instant now) {
  for (const LinkEvent& event : post.link->take()) {
    if (std::holds_alternative<LinkUp>(event)) {
      post.failure.clear();
      post.attempts.connected(now);
      // In this order: what is known of a stream comes before its events. No word between site and broker is needed
      // (QoS 0): what gets lost is not acknowledged, and comes again.
      for (const std::string& topic : {topics_.ack, topics_.stream, topics_.event}) post.link->subscribe(topic, 0);
    } else if (const auto* down = std::get_if<LinkDown>(&event)) {
      post.failure = down->reason;
      post.attempts.down(now);
    } else if (const auto* message = std::get_if<MqttMessage>(&event)) {
      take(*message);
    }
  }
  if (post.attempts.due(now)) post.link->connect(0, {});
}

/// At each broker: the truck may be at another by now, and finds there how far the site is.
void SiteClient::acknowledge() {
  for (const auto& [stream, topic] : std::exchange(to_acknowledge_, {}))
    for (Post& post : posts_)
      if (post.attempts.is_up()) post.link->publish({topic, message_text(inbox_.acknowledgement(stream)), 1, true});
}

void SiteClient::disconnect() {
  for (Post& post : posts_) post.link->disconnect();
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
