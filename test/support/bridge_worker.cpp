// The bridge as a process of its own, for tests that kill it: <store> <events> <broker...>. It records the events that
// the store does not have yet, 20 at a time, and delivers until it is killed.
#include <chrono>
#include <cstdlib>
#include <thread>

#include "lodestar/wms/bridge.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "support/bridge_params.hpp"
#include "support/pallet_changes.hpp"
#include "support/real_time.hpp"

int main(int argc, char** argv) {
  using namespace lodestar;
  if (argc < 4) return EXIT_FAILURE;
  BridgeParams params = test::bridge_params(argv[1]);
  const auto events = static_cast<std::uint64_t>(std::atoll(argv[2]));
  const std::vector<std::string> brokers(argv + 3, argv + argc);
  params.brokers = brokers.size();
  MqttLink link(test::mqtt("truck7", brokers));
  Bridge bridge(params, link, test::clocks());
  for (;;) {
    for (int i = 0; i < 20 && bridge.store().last_heard().sequence < events; ++i)
      bridge.take(test::change(bridge.store().last_heard().sequence + 1), test::clocks());
    bridge.poll(test::clocks());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}
