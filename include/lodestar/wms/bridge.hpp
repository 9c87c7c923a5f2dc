#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/fault.hpp"
#include "lodestar/wms/broker_list.hpp"
#include "lodestar/wms/clock.hpp"
#include "lodestar/wms/epcis.hpp"
#include "lodestar/wms/event_store.hpp"
#include "lodestar/wms/message_link.hpp"
#include "lodestar/wms/outbox.hpp"
#include "lodestar/wms/telemetry.hpp"

namespace lodestar {

struct BridgeParams {
  StoreParams store;
  EpcisParams epcis;
  VdaParams vda;  ///< its manufacturer and serial name the truck in all topics
  OutboxParams outbox;
  BackOff back_off;
  BackOff silence = {from_seconds(30), from_seconds(600)};  ///< of the site, until the next broker is tried
  std::size_t brokers = 1;                                  ///< how many the link knows
  Duration clock_step = from_seconds(1);                    ///< a wall clock that moves by more was set
  std::size_t most_in_memory = 10000;                       ///< events that wait for room in the store
};

/// What the documents and topics cannot be made of; empty: nothing.
Faults check(const BridgeParams& params, const std::string& file);

/// Why something of a change does not go on.
enum class BridgeDrop {
  kPalletId,  ///< no UUID: the event has no subject, and is dropped
  kLife,      ///< no UUID: nobody could tell the event from another of its number, it is dropped
  kLabel,     ///< no SSCC: the event goes on without its label
  kKnown,     ///< the event was recorded before
  kLost,      ///< no room in the store for so long that memory ran out: the only way an event is lost
  kCount
};
const char* name(BridgeDrop reason);

/// From pallet changes to the site: records, hands over, acknowledges. Runs in one thread, reads no clock and never
/// waits but for the disk; call poll() often (10 ms).
class Bridge {
 public:
  /// @param link must outlive this. Throws where the store cannot be opened.
  Bridge(const BridgeParams& params, MessageLink& link, const ClockReading& now);

  void take(PalletChange change, const ClockReading& now);
  /// What was taken and is not recorded, to be taken again in its place: a new store knows nothing of what was before.
  std::vector<PalletChange> give_back();
  Telemetry& telemetry() { return telemetry_; }
  void poll(const ClockReading& now);
  /// Says farewell to the broker.
  void shut_down(const ClockReading& now);

  bool connected() const { return brokers_.is_up(); }
  std::size_t broker() const { return brokers_.current(); }
  std::uint64_t connections() const { return connections_; }
  const std::string& last_failure() const { return last_failure_; }  ///< of the link; empty: none yet
  const EventStore& store() const { return *store_; }
  const Outbox& outbox() const { return outbox_; }
  std::size_t in_memory() const { return waiting_.size(); }  ///< heard, not recorded: the store has no room
  const DropCounts<BridgeDrop>& drops() const { return drops_; }
  std::uint64_t clock_steps() const { return clock_steps_; }
  std::uint64_t store_faults() const { return store_faults_; }
  const std::string& store_fault() const { return store_fault_; }  ///< the last one; empty: none
  const std::string& set_aside() const { return set_aside_; }      ///< the damaged file; empty: none

 private:
  void open(const std::string& damage);
  void watch_clock(const ClockReading& now);
  void handle(const LinkEvent& event, const ClockReading& now);
  void greet(const ClockReading& now);
  void tell_stream();
  void record_waiting();
  struct Waiting {
    PalletChange change;
    WallClock clock;
  };
  bool record(const Waiting& waiting);
  void send_due(const ClockReading& now);
  void leave_silence(const ClockReading& now);
  template <class Job>
  void with_store(const ClockReading& now, Job job);

  BridgeParams params_;
  MessageLink& link_;
  SiteTopics topics_;
  BrokerList brokers_;
  Telemetry telemetry_;
  std::unique_ptr<EventStore> store_;
  Outbox outbox_;
  ClockWatch clock_;
  std::deque<Waiting> waiting_;
  Instant tried_{};  ///< when they were last offered to the store
  DropCounts<BridgeDrop> drops_;
  std::uint64_t connections_ = 0, clock_steps_ = 0, store_faults_ = 0;
  std::string last_failure_, store_fault_, set_aside_;
};

}  // namespace lodestar
