#include "lodestar/wms/mqtt_link.hpp"

#include <mqtt/async_client.h>

#include <mutex>
#include <utility>

namespace lodestar {
namespace {

mqtt::connect_options connect_options(const MqttParams& params, const std::string& broker, const MqttMessage& will) {
  mqtt::connect_options options;
  options.set_mqtt_version(MQTTVERSION_3_1_1);
  options.set_clean_session(true);
  options.set_keep_alive_interval(params.keep_alive_s);
  options.set_connect_timeout(params.connect_timeout_s);
  if (!will.topic.empty())
    options.set_will_message(mqtt::make_message(will.topic, will.payload, will.qos, will.retained));
  if (!params.user.empty()) options.set_user_name(params.user);
  if (!params.password.empty()) options.set_password(params.password);
  if (broker.compare(0, 6, "ssl://") == 0) {
    mqtt::ssl_options ssl;
    if (!params.ca_file.empty()) ssl.set_trust_store(params.ca_file);
    if (!params.certificate_file.empty()) ssl.set_key_store(params.certificate_file);
    if (!params.key_file.empty()) ssl.set_private_key(params.key_file);
    ssl.set_verify(true);
    options.set_ssl(ssl);
  }
  return options;
}

}  // namespace

/// One client and what its threads told. Paho calls back from threads of its own: they only put events down.
class MqttLink::Connection : private mqtt::iaction_listener {
 public:
  Connection(const MqttParams& params, const std::string& broker, const MqttMessage& will)
      : broker_(broker), client_(broker, params.client_id) {
    // Paho never says the cause.
    client_.set_connection_lost_handler([this](const std::string&) { put(LinkDown{"lost: " + broker_}); });
    client_.set_message_callback([this](mqtt::const_message_ptr message) {
      put(MqttMessage{message->get_topic(), message->get_payload_str(), message->get_qos(), message->is_retained()});
    });
    client_.connect(connect_options(params, broker, will), nullptr, *this);
  }

  mqtt::async_client& client() { return client_; }

  std::vector<LinkEvent> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(events_, {});
  }

 private:
  void on_success(const mqtt::token&) override { put(LinkUp{}); }
  void on_failure(const mqtt::token& token) override {
    const int code = token.get_return_code();
    // Paho's "Failure" is all that it says of a broker that is not there.
    put(LinkDown{"not connected: " + broker_ + ": " +
                 (code == MQTTASYNC_FAILURE ? "no TCP or TLS connection" : mqtt::exception(code).what())});
  }

  void put(LinkEvent event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    events_.push_back(std::move(event));
  }

  std::string broker_;
  std::mutex mutex_;
  std::vector<LinkEvent> events_;
  mqtt::async_client client_;  // last: its threads end before what they write to goes
};

/// A client that never connects. With its last client paho stops its threads, for which it waits 0.1 s to 10 s:
/// at the end that does no harm, between two connections it would hold up everything.
class MqttLink::Library {
 public:
  explicit Library(const MqttParams& params) : client_("tcp://localhost", params.client_id) {}

 private:
  mqtt::async_client client_;
};

MqttLink::MqttLink(const MqttParams& params) : params_(params), library_(std::make_unique<Library>(params)) {}

MqttLink::~MqttLink() = default;

void MqttLink::connect(std::size_t broker, const MqttMessage& will) {
  connection_.reset();
  try {
    connection_ = std::make_unique<Connection>(params_, params_.brokers.at(broker), will);
  } catch (const mqtt::exception& error) {
    failures_.push_back(LinkDown{"not connected: " + params_.brokers.at(broker) + ": " + error.what()});
  }
}

// A call on a connection that just broke throws; its LinkDown comes by itself.
void MqttLink::subscribe(const std::string& topic, int qos) {
  if (!connection_) return;
  try {
    connection_->client().subscribe(topic, qos);
  } catch (const mqtt::exception&) {
  }
}

bool MqttLink::publish(const MqttMessage& message) {
  if (!connection_) return false;
  try {
    connection_->client().publish(mqtt::make_message(message.topic, message.payload, message.qos, message.retained));
    return true;
  } catch (const mqtt::exception&) {
    return false;
  }
}

void MqttLink::disconnect() {
  if (!connection_) return;
  try {
    if (connection_->client().is_connected()) connection_->client().disconnect(1000)->wait_for(1000);
  } catch (const mqtt::exception&) {
  }
  connection_.reset();
}

std::vector<LinkEvent> MqttLink::take() {
  std::vector<LinkEvent> events = std::exchange(failures_, {});
  if (!connection_) return events;
  for (LinkEvent& event : connection_->take()) events.push_back(std::move(event));
  return events;
}

std::vector<std::unique_ptr<MessageLink>> link_to_each(const MqttParams& params) {
  std::vector<std::unique_ptr<MessageLink>> links;
  for (const std::string& broker : params.brokers) {
    MqttParams one = params;
    one.brokers = {broker};
    if (!links.empty()) one.client_id += "-" + std::to_string(links.size() + 1);
    links.push_back(std::make_unique<MqttLink>(one));
  }
  return links;
}

}  // namespace lodestar
