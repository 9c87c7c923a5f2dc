#include "lodestar/ros/nodelets/wms_params.hpp"

#include <ros/time.h>

#include <fstream>
#include <utility>

namespace lodestar {
namespace {

constexpr std::int64_t kPage = 4096, kMib = 1024 * 1024;

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

StoreParams read_store(ParamReader& params) {
  StoreParams store;
  store.path = params.text("store", "");
  store.boot = first_line("/proc/sys/kernel/random/boot_id");
  store.max_pages = params.integer("store_max_mib", 64, {1, 100000}) * (kMib / kPage);
  store.reserve_pages = params.integer("store_reserve_mib", 1, {1, 1000}) * (kMib / kPage);
  store.ballast_bytes = params.integer("ballast_mib", 4, {0, 1000}) * kMib;
  store.history = static_cast<std::uint64_t>(params.integer("history", 1000, {1, 1e6}));
  return store;
}

VdaParams read_vda(ParamReader& params, const Site& site) {
  VdaParams vda;
  vda.interface_name = params.text("vda_interface", vda.interface_name);
  vda.version = params.text("vda_version", vda.version);
  vda.manufacturer = params.text("manufacturer", "");
  vda.serial = params.text("serial", "");
  vda.map_id = site.name;
  vda.alert_limit_m = params.number("alert_limit_m", vda.alert_limit_m, {0.01, 100});
  vda.state_period_s = params.number("state_period_s", vda.state_period_s, {0.1, 30});
  vda.visualization_period_s = params.number("visualization_period_s", vda.visualization_period_s, {0.1, 30});
  TruckData& truck = vda.truck;
  truck.series = params.text("truck_series", truck.series);
  truck.max_load_kg = params.number("truck_max_load_kg", 0, {0, 1e5});
  truck.speed_max_m_s = params.number("truck_speed_max_m_s", 0, {0, 20});
  truck.acceleration_max_m_s2 = params.number("truck_acceleration_max_m_s2", 0, {0, 20});
  truck.deceleration_max_m_s2 = params.number("truck_deceleration_max_m_s2", 0, {0, 20});
  truck.length_m = params.number("truck_length_m", 0, {0, 50});
  truck.width_m = params.number("truck_width_m", 0, {0, 50});
  truck.height_max_m = params.number("truck_height_max_m", 0, {0, 50});
  return vda;
}

MqttParams read_mqtt(ParamReader& params, const std::string& serial, const std::string& node) {
  MqttParams mqtt;
  mqtt.brokers = params.texts("brokers");
  mqtt.client_id = params.text("client_id", "lodestar-" + serial);
  mqtt.user = params.text("user", "");
  mqtt.ca_file = params.text("ca_file", "");
  mqtt.certificate_file = params.text("certificate_file", "");
  mqtt.key_file = params.text("key_file", "");
  mqtt.keep_alive_s = params.integer("keep_alive_s", mqtt.keep_alive_s, {1, 3600});
  const std::string password_file = params.text("password_file", "");
  if (!password_file.empty()) mqtt.password = first_line(password_file);
  if (!password_file.empty() && mqtt.password.empty())
    params.add({{node + "/password_file", 0, "'" + password_file + "' cannot be read, or its first line is empty"}});
  for (const auto& [key, path] :
       {std::pair("ca_file", mqtt.ca_file), {"certificate_file", mqtt.certificate_file}, {"key_file", mqtt.key_file}})
    if (!path.empty() && !std::ifstream(path)) params.add({{node + "/" + key, 0, "'" + path + "' cannot be read"}});
  for (const std::string& broker : mqtt.brokers)
    if (broker.compare(0, 6, "tcp://") != 0 && broker.compare(0, 6, "ssl://") != 0)
      params.add({{node + "/brokers", 0, "'" + broker + "' must begin with tcp:// or ssl://"}});
  return mqtt;
}

}  // namespace

WmsSetup read_wms_setup(ParamReader& params, const Site& site, const std::string& node) {
  WmsSetup setup;
  BridgeParams& bridge = setup.bridge;
  bridge.store = read_store(params);
  bridge.vda = read_vda(params, site);
  bridge.epcis.giai = params.text("giai", "");
  bridge.epcis.gln = params.text("gln", "");
  bridge.epcis.coordinate_reference_system = params.text("coordinate_reference_system", "");
  bridge.outbox.window = static_cast<std::uint64_t>(params.integer("window", 50, {1, 1000}));
  bridge.outbox.resend_after = from_seconds(params.number("resend_after_s", 5, {0.1, 3600}));
  bridge.back_off.first = from_seconds(params.number("back_off_first_s", 0.5, {0.01, 3600}));
  bridge.back_off.at_most = from_seconds(params.number("back_off_at_most_s", 30, {0.01, 3600}));
  bridge.silence.first = from_seconds(params.number("silence_s", 30, {1, 3600}));
  bridge.silence.at_most = 20 * bridge.silence.first;
  bridge.clock_step = from_seconds(params.number("clock_step_s", 1, {0.01, 3600}));
  // The events' clock is then the simulation's or a bag's, which tells nothing of this machine's.
  if (ros::Time::isSimTime()) bridge.clock_step = Duration::max();
  setup.mqtt = read_mqtt(params, bridge.vda.serial, node);
  bridge.brokers = setup.mqtt.brokers.size();
  params.add(check(bridge, node));
  return setup;
}

}  // namespace lodestar
