#include <stdexcept>

#include "lodestar/base/common/angle.hpp"
#include "scenario_sections.hpp"

namespace lodestar::sim {
namespace {

const std::vector<YamlKey> kRouteKeys = {{"waypoints", false},
                                         {"repeat", false},
                                         {"acceleration_m_s2", false},
                                         {"lateral_acceleration_m_s2", false},
                                         {"smoothing_s", false},
                                         {"poses", false},
                                         {"grid", false},
                                         {"dwell_s", false}};
const std::vector<YamlKey> kWaypointKeys = {{"position_m", true}, {"speed_m_s", false}, {"corner_radius_m", false},
                                            {"stop_s", false},    {"load", false},      {"load_z_m", false}};
const std::vector<YamlKey> kPoseKeys = {{"position_m", true}, {"heading_deg", false}};
const std::vector<YamlKey> kGridKeys = {
    {"from_m", true}, {"pitch_m", true}, {"columns", true}, {"rows", true}, {"heading_deg", false}};

void read_load(const Section& section, RouteParams::Waypoint& waypoint) {
  section.number("load_z_m", within(-1, 20), waypoint.load_z_m);
  const auto load = section.map().text("load");
  if (!load) return;
  if (*load != "take" && *load != "leave")
    return section.map().fault("load", "is " + quote(*load) + ": give take or leave");
  if (waypoint.stop_s < 2)
    return section.map().fault("load", "needs a stop_s of 2 or more: a load is not moved while driving by");
  waypoint.load = *load == "take" ? LoadMove::kTake : LoadMove::kLeave;
}

void read_waypoint(const Section& section, RouteParams& route) {
  RouteParams::Waypoint waypoint;
  section.vector("position_m", waypoint.position_m);
  section.number("speed_m_s", above(0, 20), waypoint.speed_m_s);
  section.number("corner_radius_m", within(0, 1000), waypoint.corner_radius_m);
  section.number("stop_s", within(0, 1e6), waypoint.stop_s);
  read_load(section, waypoint);
  route.waypoints.push_back(waypoint);
}

void read_pose(const Section& section, RouteParams& route) {
  RouteParams::Pose pose;
  section.vector("position_m", pose.position_m);
  section.degrees("heading_deg", within(-360, 360), pose.heading_rad);
  route.poses.push_back(pose);
}

/// Row by row along x, from the lowest y.
void read_grid(const Section& section, RouteParams& route) {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double pitch = 0, heading = 0;
  int columns = 0, rows = 0;
  section.vector("from_m", from);
  section.number("pitch_m", above(0, 1000), pitch);
  section.integer("columns", within(1, 10000), columns);
  section.integer("rows", within(1, 10000), rows);
  section.degrees("heading_deg", within(-360, 360), heading);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      route.poses.push_back({from + pitch * Eigen::Vector2d(column, row), heading});
}

}  // namespace

void read_route(const Section& file, Scenario& scenario) {
  const Section section = file.section("route", kRouteKeys);
  RouteParams& route = scenario.route;
  section.each("waypoints", kWaypointKeys, [&](const Section& item) { read_waypoint(item, route); });
  section.flag("repeat", route.repeat);
  section.number("acceleration_m_s2", above(0, 20), route.acceleration_m_s2);
  section.number("lateral_acceleration_m_s2", above(0, 20), route.lateral_acceleration_m_s2);
  section.number("smoothing_s", within(0, 10), route.smoothing_s);
  section.each("poses", kPoseKeys, [&](const Section& item) { read_pose(item, route); });
  if (section.map().has("grid")) read_grid(section.section("grid", kGridKeys), route);
  section.number("dwell_s", above(0, 1e6), route.dwell_s);
  if (!section.faults().empty()) return;
  try {
    const Route checked(route);
    const bool ends = route.poses.size() > 1 || (!route.waypoints.empty() && !route.repeat);
    if (!scenario.duration_s && ends) scenario.duration_s = checked.duration_s();
  } catch (const std::invalid_argument& error) {
    section.faults().add(section.map().line(), std::string("route: ") + error.what());
  }
}

}  // namespace lodestar::sim
