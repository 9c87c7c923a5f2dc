// Text of the broker to the readers of what site and truck tell each other. What passes must come back from its own
// text.

#include <cstdlib>
#include <string>

#include "lodestar/wms/site_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::string text(reinterpret_cast<const char*>(data), size);
  document_key_from(text);
  valid_topic_level(text);
  if (const auto said = acknowledgement_from(text)) {
    const auto same = acknowledgement_from(message_text(*said));
    if (!same || same->stream != said->stream || same->sequence != said->sequence) std::abort();
  }
  if (const auto said = stream_notice_from(text)) {
    const auto same = stream_notice_from(message_text(*said));
    if (!same || message_text(*same) != message_text(*said)) std::abort();
  }
  return 0;
}
