#include "lodestar/wms/site_messages.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lodestar/wms/gs1.hpp"

namespace lodestar {
namespace {

using nlohmann::json;

constexpr char kUuidUri[] = "urn:uuid:";

std::optional<std::uint64_t> number(const json& object, const char* key) {
  const auto it = object.find(key);
  if (it == object.end() || !it->is_number_unsigned()) return std::nullopt;
  return it->get<std::uint64_t>();
}

std::optional<std::string> stream(const json& object, const char* key) {
  const auto it = object.find(key);
  if (it == object.end() || !it->is_string()) return std::nullopt;
  const std::string uri = it->get<std::string>(), head = kUuidUri;
  if (uri.compare(0, head.size(), head) != 0 || !valid_uuid(uri.substr(head.size()))) return std::nullopt;
  return uri.substr(head.size());
}

/// Not an object: an empty one, in which nothing is found.
json object_from(const std::string& text) {
  json object = json::parse(text, nullptr, false);
  return object.is_object() ? object : json::object();
}

bool is_utf8(const std::string& text) {
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::ignore)) == text;
}

}  // namespace

SiteTopics site_topics(const std::string& manufacturer, const std::string& serial) {
  const std::string base = "wms/v1/" + manufacturer + "/" + serial + "/";
  return {base + "event", base + "ack", base + "stream"};
}

bool valid_topic_level(const std::string& text) {
  const auto bad = [](char c) {
    return c == '/' || c == '+' || c == '#' || c == '$' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  };
  return !text.empty() && text.size() <= 64 && std::none_of(text.begin(), text.end(), bad) && is_utf8(text);
}

std::string message_text(const Acknowledgement& acknowledgement) {
  return json{{"stream", uuid_uri(acknowledgement.stream)}, {"sequence", acknowledgement.sequence}}.dump();
}

std::optional<Acknowledgement> acknowledgement_from(const std::string& text) {
  const json object = object_from(text);
  const auto name = stream(object, "stream");
  const auto sequence = number(object, "sequence");
  if (!name || !sequence) return std::nullopt;
  return Acknowledgement{*name, *sequence};
}

std::string message_text(const StreamNotice& notice) {
  return json{{"stream", uuid_uri(notice.stream)}, {"acknowledged", notice.acknowledged}, {"last", notice.last}}.dump();
}

std::optional<StreamNotice> stream_notice_from(const std::string& text) {
  const json object = object_from(text);
  const auto name = stream(object, "stream");
  const auto acknowledged = number(object, "acknowledged"), last = number(object, "last");
  if (!name || !acknowledged || !last) return std::nullopt;
  return StreamNotice{*name, *acknowledged, *last};
}

std::optional<DocumentKey> document_key_from(const std::string& text) {
  const json object = object_from(text);
  const auto name = stream(object, "lodestar:stream");
  const auto sequence = number(object, "lodestar:sequence");
  if (!name || !sequence) return std::nullopt;
  return DocumentKey{*name, *sequence};
}

}  // namespace lodestar
