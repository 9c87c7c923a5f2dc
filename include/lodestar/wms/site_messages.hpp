#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lodestar {

/// Where truck and site meet: wms/v1/<manufacturer>/<serial>/...
struct SiteTopics {
  std::string event;   ///< truck to site: EPCIS documents
  std::string ack;     ///< site to truck, retained: Acknowledgement
  std::string stream;  ///< truck to site, retained: StreamNotice
};
SiteTopics site_topics(const std::string& manufacturer, const std::string& serial);

/// A name that can stand as one level of a topic: 1 to 64 octets of UTF-8 (MQTT 3.1.1, 1.5.3), none of them a slash, a
/// wildcard, a dollar (VDA 5050, 6.3) or a control.
bool valid_topic_level(const std::string& text);

/// The site has every document of the stream up to and with this number, safe on its own disk.
struct Acknowledgement {
  std::string stream;  ///< UUID
  std::uint64_t sequence = 0;
};
std::string message_text(const Acknowledgement& acknowledgement);
std::optional<Acknowledgement> acknowledgement_from(const std::string& text);

/// What the truck tells when it connects: a site that knows nothing of the stream begins after `acknowledged`.
struct StreamNotice {
  std::string stream;
  std::uint64_t acknowledged = 0, last = 0;
};
std::string message_text(const StreamNotice& notice);
std::optional<StreamNotice> stream_notice_from(const std::string& text);

/// Which document an event message holds.
struct DocumentKey {
  std::string stream;
  std::uint64_t sequence = 0;
};
std::optional<DocumentKey> document_key_from(const std::string& text);

}  // namespace lodestar
