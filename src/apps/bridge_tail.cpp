// bridge_tail: hears what trucks tell, acknowledges as a site would, and prints each event once.

#include <atomic>
#include <chrono>
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/command_line.hpp"
#include "lodestar/wms/mqtt_link.hpp"
#include "lodestar/wms/random_uuid.hpp"
#include "lodestar/wms/site_client.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;
using nlohmann::json;

constexpr char kUsage[] =
    "bridge_tail - hears pallet events from MQTT, acknowledges them as a site would, and prints each once\n"
    "\n"
    "Usage: bridge_tail [--broker URI]... [--manufacturer NAME] [--serial NUMBER] [--documents] [--count N]\n"
    "\n"
    "Examples:\n"
    "  bridge_tail\n"
    "  bridge_tail --broker tcp://wms.example:1883 --serial truck7 --count 10\n"
    "  bridge_tail --documents | jq .epcisBody\n"
    "\n"
    "What it has printed counts as delivered and will not be sent again: do not run it beside the site's own "
    "software.\n"
    "docs/wms_integration.md describes topics and documents.\n";

std::atomic<bool> stopped{false};

std::string last_part(const json& uri) {
  const std::string text = uri.get<std::string>();
  return text.substr(text.find_last_of("/:") + 1);
}

/// One line an event: number, time, kind, pallet, place, pose.
void print_events(const std::string& topic, const std::string& text) {
  const json document = json::parse(text);
  for (const json& event : document.at("epcisBody").at("eventList")) {
    const json pallets = event.value("childEPCs", event.value("epcList", json::array()));
    std::cout << topic.substr(0, topic.rfind('/')) << " " << document.at("lodestar:sequence") << " "
              << event.at("eventTime").get<std::string>() << " " << event.at("type").get<std::string>() << " "
              << event.at("action").get<std::string>() << " " << (pallets.empty() ? "?" : last_part(pallets[0]))
              << " at " << last_part(event.at("readPoint").at("id"));
    if (event.contains("errorDeclaration")) std::cout << " WRONG";
    for (const json& element : event.value("sensorElementList", json::array()))
      for (const json& report : element.at("sensorReport"))
        std::cout << " " << report.at("component").get<std::string>() << "=" << report.at("value");
    std::cout << std::endl;
  }
}

/// What is no EPCIS document is shown as it came.
void show(const std::string& topic, const std::string& document, bool whole) {
  try {
    if (!whole) return print_events(topic, document);
  } catch (const json::exception&) {
  }
  std::cout << document << std::endl;
}

int tail(const po::variables_map& options) {
  MqttParams mqtt;
  mqtt.brokers = options["broker"].as<std::vector<std::string>>();
  mqtt.client_id = "bridge_tail-" + random_uuid().substr(0, 8);
  const bool documents = options.count("documents") > 0;
  const auto wanted = options["count"].as<std::uint64_t>();
  std::uint64_t kept = 0;
  SiteClient site(link_to_each(mqtt), BackOff(), options["manufacturer"].as<std::string>(),
                  options["serial"].as<std::string>(), [&](const std::string& topic, const std::string& document) {
                    ++kept;
                    show(topic, document, documents);
                  });
  std::signal(SIGINT, [](int) { stopped = true; });
  std::signal(SIGTERM, [](int) { stopped = true; });
  std::vector<std::string> told(mqtt.brokers.size());
  while (!stopped && (wanted == 0 || kept < wanted)) {
    site.poll(Instant(std::chrono::steady_clock::now().time_since_epoch()));
    for (std::size_t i = 0; i < told.size(); ++i)
      if (const std::string& failure = site.failure(i); failure != told[i] && !(told[i] = failure).empty())
        std::cerr << failure << "\n";
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  site.disconnect();
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  using namespace lodestar;
  po::options_description options("Options");
  options.add_options()(
      "broker", po::value<std::vector<std::string>>()->default_value({"tcp://localhost:1883"}, "tcp://localhost:1883"),
      "tcp:// or ssl://, may be given several times: it listens at all of them")(
      "manufacturer", po::value<std::string>()->default_value("+"), "of the truck; +: any")(
      "serial", po::value<std::string>()->default_value("+"), "of the truck; +: any")(
      "documents", "print whole documents, one a line")("count", po::value<std::uint64_t>()->default_value(0),
                                                        "end after so many documents; 0: never");
  return run_tool(argc, argv, kUsage, std::move(options), tail);
}
