#include "lodestar/ros/nodelets/wms_bridge_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <sys/timex.h>

#include <chrono>
#include <ctime>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/PalletEventsAfter.h"
#include "lodestar/ros/convert/battery.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/nodelets/integrity_message.hpp"
#include "lodestar/ros/nodelets/wms_params.hpp"
#include "lodestar/ros/params/line_setup.hpp"

namespace lodestar {
namespace {

constexpr double kPollPeriod_s = 0.01;
constexpr Duration kSilenceIsLong = std::chrono::seconds(20);

/// Unlike the steady clock it goes on while the computer sleeps, which would look like a wall clock that was set.
Instant since_boot() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return Instant(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
}

/// What NTP and PTP services tell the kernel. The events' own clock may be a simulation's or a bag's, which is never
/// wrong.
bool synchronised() {
  timex state{};
  return ros::Time::isSimTime() || (adjtimex(&state) >= 0 && (state.status & STA_UNSYNC) == 0);
}

/// Both clocks at one instant: what a busy computer puts between two readings looks like a clock that was set.
ClockReading clocks() {
  constexpr std::chrono::milliseconds kOneInstant(1);
  for (;;) {
    const Instant before = since_boot();
    const Stamp wall(std::chrono::system_clock::now().time_since_epoch());
    if (since_boot() - before < kOneInstant) return {wall, before, synchronised()};
  }
}

}  // namespace

HeardEvent heard_event(const PalletEvent& message) { return {message.sequence, message.life}; }

void WmsBridgeNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  ParamReader reader(private_nh);
  const StaleLimits limits = read_stale_limits(reader);
  const Site site = read_site(reader);
  const WmsSetup setup = read_wms_setup(reader, site, ros::names::clean("/" + private_nh.getNamespace()));
  refuse_faults(reader.faults());

  map_frame_ = site.frame_id;
  brokers_ = setup.mqtt.brokers;
  link_ = std::make_unique<MqttLink>(setup.mqtt);
  bridge_ = std::make_unique<Bridge>(setup.bridge, *link_, clocks());
  health_ = std::make_unique<Health>(nh, private_nh, "WMS bridge", setup.bridge.vda.serial, limits);
  events_watch_ = &health_->watch("events", Need::kOptional);
  pose_watch_ = &health_->watch("pose", Need::kRequired);
  health_->add_report([this](Health::Status& status) { report(status); });
  follow_store();

  events_ = nh.subscribe("pallets/events", 1000, &WmsBridgeNodelet::take_event, this);
  state_ = nh.subscribe("pallets/state", 1, &WmsBridgeNodelet::take_state, this);
  pose_ = nh.subscribe("pose", 10, &WmsBridgeNodelet::take_pose, this);
  integrity_ = nh.subscribe("pose/integrity", 10, &WmsBridgeNodelet::take_integrity, this);
  battery_ = nh.subscribe("battery", 1, &WmsBridgeNodelet::take_battery, this);
  events_after_ = nh.serviceClient<PalletEventsAfter>("pallets/events_after");
  poll_ = nh.createWallTimer(ros::WallDuration(kPollPeriod_s), [this](const ros::WallTimerEvent&) { poll(); });
}

WmsBridgeNodelet::~WmsBridgeNodelet() {
  if (bridge_) bridge_->shut_down(clocks());
}

void WmsBridgeNodelet::poll() {
  bridge_->poll(clocks());
  follow_store();
  if (events_.getNumPublishers() == 0) intake_.lose_sight();
  if (state_.getNumPublishers() == 0) bridge_->telemetry().take_loads(std::nullopt);
  catch_up();
}

/// A damaged store makes room for one that knows nothing: what it did not record comes after what the tracker still
/// knows of the time before.
/// @return whether it is another store
bool WmsBridgeNodelet::follow_store() {
  if (stream_ == bridge_->store().stream()) return false;
  stream_ = bridge_->store().stream();
  intake_.resume_after(bridge_->store().last_heard());
  for (const PalletChange& change : bridge_->give_back()) intake_.hear(pallet_event_message(change, map_frame_));
  return true;
}

/// What was told while nobody listened, or written down by a node that died before it told it, comes with the answer.
void WmsBridgeNodelet::catch_up() {
  while (const auto after = intake_.due(clocks().monotonic)) {
    PalletEventsAfter service;
    service.request.sequence = *after;
    if (events_after_.call(service)) {
      intake_.answer(std::move(service.response.events), clocks().monotonic);
    } else {
      intake_.refused(clocks().monotonic);
    }
  }
  bool damaged = false;
  for (PalletEvent& event : intake_.take()) {
    if (damaged) {
      intake_.hear(std::move(event));
      continue;
    }
    record(event);
    damaged = follow_store();
  }
}

void WmsBridgeNodelet::record(const PalletEvent& message) {
  auto change = pallet_change_from(message, map_frame_);
  if (!change) return health_->drop(change.error());
  if (message.kind == PalletEvent::PICK) lifted_.insert(message.pallet.id);
  if (message.kind == PalletEvent::DROP) lifted_.clear();  // the fork lets go of all at once
  bridge_->take(std::move(change).value(), clocks());
}

void WmsBridgeNodelet::take_event(const PalletEventConstPtr& message) {
  events_watch_->tick();
  intake_.hear(*message);
  catch_up();
}

void WmsBridgeNodelet::take_state(const PalletArrayConstPtr& message) {
  intake_.told(message->last_event, clocks().monotonic);
  std::vector<Pallet> on_fork;
  for (const PalletEntry& entry : message->pallets) {
    const bool in_doubt = entry.state == PalletEntry::UNCERTAIN && lifted_.count(entry.id) > 0;
    if (entry.state != PalletEntry::ON_FORK && !in_doubt) continue;
    auto pallet = pallet_from(entry);
    if (!pallet) return health_->drop(pallet.error());
    on_fork.push_back(std::move(pallet).value());
  }
  bridge_->telemetry().take_loads(std::move(on_fork));
}

void WmsBridgeNodelet::take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  pose_watch_->tick();
  const auto estimate = pose_estimate_from(*message, map_frame_);
  if (!estimate) return health_->drop(estimate.error());
  bridge_->telemetry().take_pose(*estimate, clocks().monotonic);
}

void WmsBridgeNodelet::take_integrity(const PoseIntegrityConstPtr& message) {
  if (const auto fault = fault_of(*message)) return health_->drop(*fault);
  const bool trusted = message->mode == PoseIntegrity::TRACKING || message->mode == PoseIntegrity::COASTING;
  bridge_->telemetry().take_integrity(trusted, message->protection_level_m);
}

void WmsBridgeNodelet::take_battery(const sensor_msgs::BatteryStateConstPtr& message) {
  const auto battery = battery_from(*message);
  if (!battery) return health_->drop(battery.error());
  bridge_->telemetry().take_battery(*battery, clocks().monotonic);
}

void WmsBridgeNodelet::report(Health::Status& status) {
  const Bridge& bridge = *bridge_;
  status.add("broker", bridge.connected() ? brokers_[bridge.broker()] : "none");
  status.add("connections", bridge.connections());
  status.add("last link failure", bridge.last_failure());
  status.add("stream", bridge.store().stream());
  status.add("recorded", bridge.store().last());
  status.add("acknowledged", bridge.store().acknowledged());
  status.add("waiting", bridge.outbox().waiting());
  status.add("on their way", bridge.outbox().on_their_way());
  status.add("resends", bridge.outbox().resends());
  status.add("in memory", bridge.in_memory());
  status.add("waiting for earlier ones", intake_.waiting());
  status.add("missed", intake_.counts().missed);
  status.add("tracker restarts", intake_.counts().restarts);
  status.add("clock steps", bridge.clock_steps());
  status.add("store faults", bridge.store_faults());
  status.add("last store fault", bridge.store_fault());
  status.add("store set aside", bridge.set_aside());
  report_drops(bridge.drops(), status);
  report_drops(bridge.outbox().drops(), status);
  report_trouble(status);
}

void WmsBridgeNodelet::report_trouble(Health::Status& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const Bridge& bridge = *bridge_;
  if (!bridge.connected()) status.mergeSummary(DiagnosticStatus::WARN, "no broker: " + bridge.last_failure());
  const Outbox& outbox = bridge.outbox();
  const auto unanswered = outbox.unanswered_since();
  if (unanswered && clocks().monotonic - *unanswered >= kSilenceIsLong)
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the site does not acknowledge: does it listen at this broker, and know the stream?");
  if (outbox.site_fell_back())
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the site has events up to " + std::to_string(*outbox.site_fell_back()) +
                            " alone, and acknowledged " + std::to_string(outbox.acknowledged()) +
                            " before: was it restored from a backup?");
  if (intake_.waiting() > 0)
    status.mergeSummary(DiagnosticStatus::WARN, "pallet tracking does not tell the events before the newest");
  if (intake_.counts().missed > 0)
    status.mergeSummary(DiagnosticStatus::WARN,
                        std::to_string(intake_.counts().missed) + " pallet events were not heard");
  if (bridge.in_memory() > 0)
    status.mergeSummary(DiagnosticStatus::ERROR, "the store takes no events: they wait in memory");
  if (bridge.outbox().drops()[AckDrop::kAhead] > 0)
    status.mergeSummary(DiagnosticStatus::ERROR,
                        "the site acknowledged events that were never sent: is the store an old copy?");
  if (!bridge.set_aside().empty())
    status.mergeSummary(DiagnosticStatus::ERROR, "a damaged store was set aside: " + bridge.set_aside());
  if (bridge.drops()[BridgeDrop::kLost] > 0) status.mergeSummary(DiagnosticStatus::ERROR, "events were lost");
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::WmsBridgeNodelet, nodelet::Nodelet)
