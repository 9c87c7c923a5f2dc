#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace lodestar {

struct MqttMessage {
  std::string topic, payload;
  int qos = 0;
  bool retained = false;
};

/// What a connection tells.
struct LinkUp {};
struct LinkDown {
  std::string reason;
};
using LinkEvent = std::variant<LinkUp, LinkDown, MqttMessage>;

/// One MQTT connection at a time, seen from one thread. Nothing here waits.
class MessageLink {
 public:
  virtual ~MessageLink() = default;

  /// Begins to connect; LinkUp or LinkDown tells what became of it. An older connection is dropped without a word.
  /// @param broker index into the list that the link was made with @param will what the broker says if the link breaks
  virtual void connect(std::size_t broker, const MqttMessage& will) = 0;
  virtual void subscribe(const std::string& topic, int qos) = 0;
  /// @return false: not connected any more, which LinkDown tells too
  virtual bool publish(const MqttMessage& message) = 0;
  /// Sends what is under way, then ends the connection; the will is not told. May wait up to a second.
  virtual void disconnect() = 0;
  /// What happened since the last call.
  virtual std::vector<LinkEvent> take() = 0;
};

}  // namespace lodestar
