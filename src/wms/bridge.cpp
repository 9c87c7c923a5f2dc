#include "lodestar/wms/bridge.hpp"

#include <utility>

#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/wms/gs1.hpp"
#include "lodestar/wms/random_uuid.hpp"

namespace lodestar {
namespace {

/// A full disk is asked again so often; an acknowledgement makes room at once.
constexpr Duration kBetweenTries = std::chrono::seconds(1);

}  // namespace

Bridge::Bridge(const BridgeParams& params, MessageLink& link, const ClockReading& now)
    : params_(params),
      link_(link),
      topics_(site_topics(params.vda.manufacturer, params.vda.serial)),
      brokers_(params.brokers, params.back_off, params.silence),
      telemetry_(params.vda),
      outbox_(params.outbox, "", {}),
      clock_(std::nullopt, params.clock_step) {
  open("");
  clock_ = ClockWatch(store_->clock_offset(), params_.clock_step);
  watch_clock(now);
  store_->mark_clock_step(Duration::zero(), now.offset());
}

/// @param damage of the store in use; empty: none is known
void Bridge::open(const std::string& damage) {
  store_.reset();
  OpenedStore opened = open_store(params_.store, random_uuid(), damage);
  store_ = std::move(opened.store);
  outbox_ = Outbox(params_.outbox, store_->stream(), {store_->acknowledged(), store_->handed_over(), store_->last()});
  if (opened.set_aside.empty()) return;
  set_aside_ = opened.set_aside;
  store_fault_ = opened.damage;
}

/// A fault of the disk leaves everything as it was, to be tried again; a damaged file makes room for a new one.
template <class Job>
void Bridge::with_store(const ClockReading& now, Job job) {
  try {
    job();
  } catch (const StoreCorrupt& error) {
    ++store_faults_;
    open(error.what());
    tried_ = {};
    store_->mark_clock_step(Duration::zero(), now.offset());
    if (brokers_.is_up()) greet(now);
  } catch (const std::exception& error) {
    ++store_faults_;
    store_fault_ = error.what();
  }
}

void Bridge::take(PalletChange change, const ClockReading& now) {
  if (!valid_uuid(change.pallet.id)) return drops_.add(BridgeDrop::kPalletId);
  if (!valid_uuid(change.life)) return drops_.add(BridgeDrop::kLife);
  if (!change.pallet.sscc.empty() && !is_sscc(change.pallet.sscc)) {
    drops_.add(BridgeDrop::kLabel);
    change.pallet.sscc.clear();
  }
  if (change.kind != PalletChangeKind::kCorrection) change.corrects = 0;  // a pick or drop replaces nothing
  if (waiting_.size() >= params_.most_in_memory) return drops_.add(BridgeDrop::kLost);
  waiting_.push_back({std::move(change), {now.synchronised, {}}});
  if (waiting_.size() == 1) with_store(now, [this] { record_waiting(); });
}

std::vector<PalletChange> Bridge::give_back() {
  std::vector<PalletChange> out;
  for (Waiting& waiting : std::exchange(waiting_, {})) out.push_back(std::move(waiting.change));
  return out;
}

void Bridge::record_waiting() {
  while (!waiting_.empty() && record(waiting_.front())) waiting_.pop_front();
}

/// @return false: there is no room
bool Bridge::record(const Waiting& waiting) {
  const PalletChange& change = waiting.change;
  switch (store_->record(change, epcis_draft(params_.epcis, change), waiting.clock)) {
    case Recorded::kFull:
      return false;
    case Recorded::kKnown:
      drops_.add(BridgeDrop::kKnown);
      return true;
    case Recorded::kNew:
      break;
  }
  outbox_.recorded(store_->last());
  return true;
}

void Bridge::watch_clock(const ClockReading& now) {
  const auto step = clock_.step(now);
  if (!step) return;
  ++clock_steps_;
  for (Waiting& waiting : waiting_) waiting.clock.step += *step;
  with_store(now, [&] { store_->mark_clock_step(*step, now.offset()); });
}

void Bridge::poll(const ClockReading& now) {
  watch_clock(now);
  for (const LinkEvent& event : link_.take()) handle(event, now);
  with_store(now, [&] {
    const bool room = store_->acknowledged() != outbox_.acknowledged();
    store_->acknowledge(outbox_.acknowledged());
    if (!room && now.monotonic - tried_ < kBetweenTries) return;
    tried_ = now.monotonic;
    store_->keep_clock();
    record_waiting();
  });
  telemetry_.set_outbox_full(!waiting_.empty());
  leave_silence(now);
  if (const auto broker = brokers_.due(now.monotonic)) link_.connect(*broker, telemetry_.will(now.wall));
  if (!brokers_.is_up()) return;
  with_store(now, [&] { send_due(now); });
  for (const MqttMessage& message : telemetry_.due(now)) link_.publish(message);
}

void Bridge::handle(const LinkEvent& event, const ClockReading& now) {
  if (std::holds_alternative<LinkUp>(event)) {
    brokers_.connected(now.monotonic);
    ++connections_;
    greet(now);
  } else if (const auto* down = std::get_if<LinkDown>(&event)) {
    last_failure_ = down->reason;
    brokers_.down(now.monotonic);
    outbox_.disconnected();
  } else if (const auto* message = std::get_if<MqttMessage>(&event)) {
    if (message->topic != topics_.ack) return;
    if (outbox_.take(message->payload, message->retained, now.monotonic)) brokers_.answered();
  }
}

void Bridge::tell_stream() {
  const StreamNotice notice{store_->stream(), outbox_.acknowledged(), store_->last()};
  link_.publish({topics_.stream, message_text(notice), 1, true});
}

/// What a broker hears first. Everything that is on its way counts as lost.
void Bridge::greet(const ClockReading& now) {
  link_.subscribe(topics_.ack, 0);  // a later one says all that a lost one said
  tell_stream();
  for (const MqttMessage& message : telemetry_.at_connect(now)) link_.publish(message);
  outbox_.connected(now.monotonic);
}

void Bridge::send_due(const ClockReading& now) {
  const Batch due = outbox_.due(now.monotonic);
  if (due.count == 0) return;
  const auto freeze = [&](const StoredDraft& stored) {
    return epcis_document(stored.draft, {store_->stream(), stored.sequence, now.wall, stored.clock, stored.told});
  };
  // It takes none of them before it knows that those between are gone.
  if (outbox_.site_fell_back()) tell_stream();
  Batch sent{due.first, 0};
  for (const StoredDocument& stored : store_->documents(due.first, due.count, freeze)) {
    if (!link_.publish({topics_.event, stored.document, 1, false})) break;
    ++sent.count;
  }
  outbox_.sent(sent, now.monotonic);
}

/// The site may listen at another broker.
void Bridge::leave_silence(const ClockReading& now) {
  const auto since = outbox_.unanswered_since();
  if (!since || !brokers_.give_up(*since, now.monotonic)) return;
  outbox_.disconnected();
  last_failure_ = "the site does not answer there";
  link_.publish(telemetry_.farewell(now.wall));
  link_.disconnect();
}

void Bridge::shut_down(const ClockReading& now) {
  if (brokers_.is_up()) link_.publish(telemetry_.farewell(now.wall));
  link_.disconnect();
}

}  // namespace lodestar
