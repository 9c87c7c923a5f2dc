#include "lodestar/wms/outbox.hpp"

namespace lodestar {
namespace {

/// A site that says the same number again misses a document. It may say so for each that it got after the missing one.
constexpr Duration kBetweenComplaints = std::chrono::seconds(1);

}  // namespace

const char* name(AckDrop reason) {
  switch (reason) {
    case AckDrop::kMalformed:
      return "ack_malformed";
    case AckDrop::kOtherStream:
      return "ack_other_stream";
    case AckDrop::kRepeated:
      return "ack_repeated";
    case AckDrop::kLate:
      return "ack_late";
    case AckDrop::kAhead:
      return "ack_ahead";
    case AckDrop::kCount:
      break;
  }
  return "";
}

Outbox::Outbox(const OutboxParams& params, std::string stream, const StreamProgress& start)
    : params_(params),
      stream_(std::move(stream)),
      acknowledged_(start.acknowledged),
      sent_(start.sent),
      last_(start.recorded),
      next_(start.acknowledged + 1),
      patience_(params.resend_after) {}

void Outbox::connected(Instant now) {
  connected_ = true;
  next_ = acknowledged_ + 1;
  progress_ = now;
  patience_ = params_.resend_after;
}

Batch Outbox::due(Instant now) {
  if (!connected_) return {};
  if (on_their_way() > 0 && now - progress_ >= patience_) {
    go_back(now);
    patience_ = std::min(2 * patience_, params_.resend_at_most);
  }
  const std::uint64_t end = std::min(last_, acknowledged_ + params_.window) + 1;
  return {next_, end > next_ ? end - next_ : 0};
}

void Outbox::sent(const Batch& batch, Instant now) {
  if (batch.count == 0) return;
  if (on_their_way() == 0) progress_ = now;
  next_ = batch.first + batch.count;
  sent_ = std::max(sent_, next_ - 1);
  if (!unanswered_since_) unanswered_since_ = now;
}

bool Outbox::take(const std::string& message, bool retained, Instant now) {
  const auto ack = acknowledgement_from(message);
  if (!ack) return drop(AckDrop::kMalformed);
  if (ack->stream != stream_) return drop(AckDrop::kOtherStream);
  if (ack->sequence > sent_) return drop(AckDrop::kAhead);
  if (ack->sequence <= acknowledged_) {
    if (!retained) complain(ack->sequence, now);
    return drop(ack->sequence == acknowledged_ ? AckDrop::kRepeated : AckDrop::kLate);
  }
  acknowledged_ = ack->sequence;
  next_ = std::max(next_, acknowledged_ + 1);
  progress_ = now;
  patience_ = params_.resend_after;
  unanswered_since_ = on_their_way() > 0 ? std::optional(now) : std::nullopt;
  site_fell_back_.reset();
  return true;
}

/// The site asks for what is on its way, and has been for a while.
void Outbox::complain(std::uint64_t sequence, Instant now) {
  if (on_their_way() == 0 || now - *unanswered_since_ < kBetweenComplaints) return;
  site_fell_back_ = sequence < acknowledged_ ? std::optional(sequence) : std::nullopt;
  if (now - progress_ >= kBetweenComplaints) go_back(now);
}

void Outbox::go_back(Instant now) {
  next_ = acknowledged_ + 1;
  progress_ = now;
  ++resends_;
}

bool Outbox::drop(AckDrop reason) {
  drops_.add(reason);
  return false;
}

}  // namespace lodestar
