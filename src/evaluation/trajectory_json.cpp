#include <cmath>
#include <nlohmann/json.hpp>

#include "lodestar/evaluation/trajectory_error.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json statistics(const ErrorStatistics& s, const std::string& unit) {
  return {{"mean" + unit, number(s.mean)},
          {"rmse" + unit, number(s.rmse)},
          {"median" + unit, number(s.median)},
          {"p95" + unit, number(s.p95)},
          {"max" + unit, number(s.max)}};
}

Json part(const TrajectoryError::Part& p) {
  return {{"samples", p.samples},
          {"position", statistics(p.position_m, "_m")},
          {"yaw", statistics(p.yaw_rad, "_rad")},
          {"z", statistics(p.z_m, "_m")},
          {"nees_mean", number(p.nees_mean)}};
}

}  // namespace

std::string to_json(const TrajectoryError& error) {
  const Json json{{"all", part(error.all)},
                  {"standing", part(error.standing)},
                  {"moving", part(error.moving)},
                  {"availability", number(error.availability)},
                  {"time_to_first_fix_s", number(error.time_to_first_fix_s)},
                  {"relative",
                   {{"interval_s", error.relative.interval_s},
                    {"samples", error.relative.samples},
                    {"position", statistics(error.relative.position_m, "_m")},
                    {"yaw", statistics(error.relative.yaw_rad, "_rad")}}},
                  {"nees_dof", 3},
                  {"rows_outside_truth", error.outside_truth}};
  return json.dump(2) + "\n";
}

}  // namespace lodestar
