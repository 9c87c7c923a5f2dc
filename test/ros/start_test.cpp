// Every node refuses a wrong start with an exit code and all faults at once; every file in config/ loads.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"
#include "lodestar/sim/scenario.hpp"

namespace {

using namespace lodestar;

const std::string kSource = LODESTAR_SOURCE_DIR;

struct Ended {
  int status = 0;
  std::string output;
};

/// Runs a node of the package under the name "started" until it ends by itself; at most two minutes.
Ended run(const std::string& node) {
  const std::string log = "/tmp/lodestar_start_test_" + std::to_string(getpid()) + ".log";
  const std::string command =
      "timeout -s KILL 120 " + std::string(LODESTAR_PROGRAM_DIR) + "/" + node + " __name:=started > " + log + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream file(log);
  std::stringstream output;
  output << file.rdbuf();
  std::filesystem::remove(log);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output.str()};
}

class Start : public testing::Test {
 protected:
  void SetUp() override { ros::param::del("/started"); }
  ros::NodeHandle nh_;
};

TEST_F(Start, ListsAllFaultsAtOnce) {
  ros::param::set("/started/site", kSource + "/test/ros/site.yaml");
  ros::param::set("/started/vehicle", "/nowhere/vehicle.yaml");
  ros::param::set("/started/publish_rate_hz", -3.0);
  ros::param::set("/started/publish_tf", "sideways");
  ros::param::set("/started/use_sightings", "yes");
  ros::param::set("/started/publish_rate", 10);
  const Ended result = run("pose_fusion_node");
  EXPECT_EQ(result.status, EXIT_FAILURE) << result.output;
  for (const char* fault :
       {"/started/publish_rate_hz: is -3, must be at least 1", "publish_tf: is 'sideways'",
        "use_sightings: is a text, must be true or false", "publish_rate: is no parameter", "/nowhere/vehicle.yaml"})
    EXPECT_NE(result.output.find(fault), std::string::npos) << fault << " in\n" << result.output;
}

TEST_F(Start, EachNodeRefusesAnUnknownParameter) {
  for (const char* node : {"beacon_detection_node", "ir_decoding_node", "pose_solving_node", "pose_fusion_node",
                           "visualization_node", "simulation_node", "camera_capture_node"}) {
    ros::param::del("/started");
    ros::param::set("/started/site", kSource + "/test/ros/site.yaml");
    ros::param::set("/started/no_such_thing", 1);
    const Ended result = run(node);
    EXPECT_EQ(result.status, EXIT_FAILURE) << node << "\n" << result.output;
    EXPECT_NE(result.output.find("/started/no_such_thing: is no parameter of this node"), std::string::npos)
        << node << "\n"
        << result.output;
  }
}

TEST_F(Start, AWrongSiteFileIsRefusedWithItsLine) {
  const std::string path = "/tmp/lodestar_start_test_" + std::to_string(getpid()) + ".yaml";
  std::ofstream(path) << "site: {name: wrong}\ntone_table_hz: [4, 6]\nbeacons:\n"
                         "  - {id: 1, position_m: [0, 0, .nan], tones_hz: [4], slot: 0}\n";
  ros::param::set("/started/site", path);
  const Ended result = run("ir_decoding_node");
  EXPECT_EQ(result.status, EXIT_FAILURE);
  EXPECT_NE(result.output.find(path + ":4:"), std::string::npos) << result.output;
  std::filesystem::remove(path);
}

TEST(Config, EveryFileLoads) {
  int sites = 0, vehicles = 0, scenarios = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource + "/config")) {
    const std::string path = entry.path(), file = entry.path().filename();
    if (file.rfind("site_", 0) == 0) {
      const auto site = load_site(path);
      EXPECT_TRUE(site.ok()) << describe(site.error());
      ++sites;
    } else if (file.rfind("vehicle_", 0) == 0) {
      const auto vehicle = load_vehicle(path);
      EXPECT_TRUE(vehicle.ok()) << describe(vehicle.error());
      ++vehicles;
    } else if (file.rfind("wms_", 0) == 0) {
      // The bridge's own test reads it.
    } else if (entry.path().extension() == ".yaml") {
      const auto scenario = sim::load_scenario(path);
      EXPECT_TRUE(scenario.ok()) << describe(scenario.error());
      ++scenarios;
    }
  }
  EXPECT_GT(sites, 0);
  EXPECT_GT(vehicles, 0);
  EXPECT_GT(scenarios, 0);
}

TEST(Launch, EveryFileParsesAndNamesItsNodes) {
  const std::string launch = kSource + "/launch/", site = " site:=" + kSource + "/test/ros/site.yaml";
  const std::string all = "/beacon_detection /ir_decoding /pose_fusion /pose_solving";
  const struct {
    std::string file, arguments, nodes;
  } cases[] = {{"bringup.launch", site, all + " /lodestar_manager"},
               {"bringup.launch", site + " start_manager:=false visualization:=true", all + " /visualization"},
               {"bringup.launch", site + " camera:=gige:", all + " /camera_capture /lodestar_manager"},
               {"bringup.launch", site + " ir:=serial:/dev/ttyUSB0", all + " /ir_receiver"},
               {"replay.launch", site + " bag:=/tmp/x.bag rviz:=true", all + " /player /rviz /visualization"},
               {"wms_bridge.launch", " store:=/tmp/wms.db broker:=tcp://localhost:1", "/wms_bridge"},
               {"demo.launch", " rviz:=true", all + " /simulation /rviz /visualization"}};
  for (const auto& c : cases) {
    const std::string log = "/tmp/lodestar_launch_test_" + std::to_string(getpid()) + ".log";
    const std::string command = "roslaunch --nodes " + launch + c.file + c.arguments + " > " + log + " 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream file(log);
    std::stringstream output;
    output << file.rdbuf();
    EXPECT_EQ(status, 0) << command << "\n" << output.str();
    std::istringstream nodes(c.nodes);
    for (std::string node; nodes >> node;)
      EXPECT_NE(output.str().find(node + "\n"), std::string::npos) << node << " of " << c.file << "\n" << output.str();
    std::filesystem::remove(log);
  }
}

}  // namespace
