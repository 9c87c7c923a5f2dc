#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lodestar/wms/message_link.hpp"

namespace lodestar {

struct MqttParams {
  std::vector<std::string> brokers;  ///< tcp://host:1883 or ssl://host:8883
  std::string client_id;             ///< one for each client of a broker
  std::string user, password;        ///< empty: none
  std::string ca_file;               ///< PEM; empty: the system's
  std::string certificate_file;      ///< PEM, of this client; empty: none
  std::string key_file;              ///< PEM, of the certificate
  int keep_alive_s = 10;             ///< a link that died without a word is noticed after about 1.5 times this
  int connect_timeout_s = 5;
};

/// MessageLink over MQTT 3.1.1 by Eclipse Paho. Sessions are clean: what must not get lost is the outbox's to keep.
class MqttLink : public MessageLink {
 public:
  explicit MqttLink(const MqttParams& params);
  ~MqttLink() override;

  void connect(std::size_t broker, const MqttMessage& will) override;
  void subscribe(const std::string& topic, int qos) override;
  bool publish(const MqttMessage& message) override;
  void disconnect() override;
  std::vector<LinkEvent> take() override;

 private:
  class Connection;
  class Library;

  MqttParams params_;
  std::unique_ptr<Library> library_;  ///< outlives each connection
  std::unique_ptr<Connection> connection_;
  std::vector<LinkEvent> failures_;  ///< of connections that never came about
};

/// A link to each broker of the list, each its only one. Their client ids differ: two names may be those of one broker.
std::vector<std::unique_ptr<MessageLink>> link_to_each(const MqttParams& params);

}  // namespace lodestar
