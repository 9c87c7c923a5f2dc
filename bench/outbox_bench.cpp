// How fast events are recorded beside a bare loop of inserts of the same rows with the same durability, and how fast a
// queue drains over MQTT on the loopback. The folder is the current one: run it on the disk that counts.

#include <SQLiteCpp/SQLiteCpp.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/site_client.hpp"
#include "support/bridge_params.hpp"
#include "support/broker.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"
#include "support/temporary_folder.hpp"

namespace lodestar {
namespace {

using test::change;

/// A link that nobody answers.
class DeadLink : public MessageLink {
 public:
  void connect(std::size_t, const MqttMessage&) override {}
  void subscribe(const std::string&, int) override {}
  bool publish(const MqttMessage&) override { return false; }
  void disconnect() override {}
  std::vector<LinkEvent> take() override { return {}; }
};

/// The rows that the store writes for an event, and nothing else: no check, no document, no limit of pages.
class BareInserts {
 public:
  /// @param path of a file that a store made: the same tables, and a write-ahead log
  explicit BareInserts(const std::string& path) : database_(path, SQLite::OPEN_READWRITE) {
    database_.exec("PRAGMA synchronous = FULL");
  }

  void insert(const PalletChange& change, const std::string& draft) {
    run(begin_);
    event_.bind(1, static_cast<std::int64_t>(change.sequence));
    event_.bind(2, static_cast<std::int64_t>(change.sequence));
    event_.bind(3, change.pallet.id);
    event_.bind(4, 0);
    event_.bind(5, draft);
    event_.bind(6, "boot-1");
    run(event_);
    life_.bind(1, change.life);
    life_.bind(2, static_cast<std::int64_t>(change.sequence));
    run(life_);
    pallet_.bind(1, change.pallet.id);
    pallet_.bind(2, change.pallet.sscc);
    pallet_.bind(3, static_cast<int>(change.pallet.state));
    pallet_.bind(4, change.pallet.zone);
    pallet_.bind(5, change.pallet.level);
    pallet_.bind(6, static_cast<std::int64_t>(change.sequence));
    run(pallet_);
    if (change.kind == PalletChangeKind::kDrop) {
      const auto p = change.pallet.T_map_pallet.translation();
      place_.bind(1, change.pallet.id);
      for (int axis = 0; axis < 3; ++axis) place_.bind(axis + 2, p[axis]);
      run(place_);
    }
    run(commit_);
  }

 private:
  static void run(SQLite::Statement& statement) {
    statement.exec();
    statement.reset();
  }

  SQLite::Database database_;
  SQLite::Statement begin_{database_, "BEGIN"}, commit_{database_, "COMMIT"};
  SQLite::Statement event_{database_,
                           "INSERT INTO event(sequence, heard, pallet, corrects, document, boot, clock_step_ns,"
                           " synchronised) VALUES(?, ?, ?, ?, ?, ?, 0, 1)"};
  SQLite::Statement life_{database_, "REPLACE INTO life VALUES(?1, ?2, ?2)"};
  SQLite::Statement pallet_{database_,
                            "INSERT INTO pallet(id, sscc, state, zone, level, sequence) VALUES(?, ?, ?, ?, ?, ?)"
                            " ON CONFLICT(id) DO UPDATE SET sscc = excluded.sscc, state = excluded.state,"
                            " zone = excluded.zone, level = excluded.level, sequence = excluded.sequence"};
  SQLite::Statement place_{database_,
                           "REPLACE INTO place SELECT key, ?2, ?2, ?3, ?3, ?4, ?4 FROM pallet WHERE id = ?1"};
};

double elapsed_s(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// Both in turn, a pick and a drop each, so that a busy machine slows them alike; the ratio is that of the medians.
void recording(benchmark::State& state) {
  const test::TemporaryFolder folder(".");
  DeadLink link;
  Bridge bridge(test::bridge_params(folder / "outbox.db"), link, test::clocks());
  { EventStore made(test::bridge_params(folder / "bare.db").store, test::uuid(1)); }
  BareInserts bare(folder / "bare.db");
  constexpr int kBatch = 2;
  std::vector<double> ours_s, theirs_s;
  std::uint64_t n = 0;
  for (auto _ : state) {
    std::vector<PalletChange> changes;
    std::vector<std::string> drafts;
    for (int i = 0; i < kBatch; ++i) {
      changes.push_back(change(++n));
      drafts.push_back(epcis_draft(test::bridge_params("").epcis, changes.back()));
    }
    auto start = std::chrono::steady_clock::now();
    for (const PalletChange& one : changes) bridge.take(one, test::clocks());
    ours_s.push_back(elapsed_s(start));
    state.SetIterationTime(ours_s.back());
    start = std::chrono::steady_clock::now();
    for (int i = 0; i < kBatch; ++i) bare.insert(changes[i], drafts[i]);
    theirs_s.push_back(elapsed_s(start));
  }
  const auto median_rate = [&](std::vector<double> times_s) {
    std::nth_element(times_s.begin(), times_s.begin() + times_s.size() / 2, times_s.end());
    return kBatch / times_s[times_s.size() / 2];
  };
  if (bridge.store().last() != n) return state.SkipWithError("not all were recorded");
  state.counters["outbox_per_s"] = median_rate(ours_s);
  state.counters["bare_per_s"] = median_rate(theirs_s);
  state.counters["ratio"] = median_rate(ours_s) / median_rate(theirs_s);  // at least 0.8 is asked
}

/// Queued without a network, then delivered and acknowledged over a broker on the loopback.
void draining(benchmark::State& state) {
  if (!test::Broker::installed()) return state.SkipWithError("mosquitto is not installed");
  constexpr int kQueue = 2000;
  for (auto _ : state) {
    const test::TemporaryFolder folder(".");
    test::Broker broker;
    MqttParams truck, site;
    truck.brokers = site.brokers = {broker.uri()};
    truck.client_id = "truck7";
    site.client_id = "site";
    MqttLink truck_link(truck);
    Bridge bridge(test::bridge_params(folder / "outbox.db"), truck_link, test::clocks());
    for (int n = 1; n <= kQueue; ++n) bridge.take(change(n), test::clocks());
    SiteClient client(link_to_each(site), {}, "+", "+", [](const std::string&, const std::string&) {});
    const auto poll = [&] {
      bridge.poll(test::clocks());
      client.poll(test::clocks().monotonic);
    };
    test::run_until([&] { return bridge.outbox().acknowledged() > 0; }, poll);
    const std::uint64_t before = bridge.outbox().waiting();
    const auto start = std::chrono::steady_clock::now();
    if (!test::run_until([&] { return bridge.outbox().waiting() == 0; }, poll)) return state.SkipWithError("stuck");
    state.SetIterationTime(elapsed_s(start));
    state.counters["drained_per_s"] = static_cast<double>(before) / elapsed_s(start);
  }
}

BENCHMARK(recording)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(1000);
BENCHMARK(draining)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
