#pragma once

#include <functional>
#include <optional>

#include "lodestar/line/localization_line.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar::sim {

/// The optical line as a truck of this scenario would have it: with the site, calibration and mounts that it is told,
/// and with the vehicle's sigmas.
LocalizationLine make_line(const Scenario& scenario, const Vehicle& vehicle = {});

/// Hands one event to the line; truth is left out. What an image led to, if it was one and was not dropped.
std::optional<LocalizationLine::Outcome> feed(LocalizationLine& line, const Event& event);

/// What the line said of one image, and where the truck was.
struct LineStep {
  double time_s = 0;  ///< since the start
  LocalizationLine::Outcome outcome;
  RigidTransform T_map_base_true = RigidTransform::Identity();
  bool standing = false;  ///< at most 0.05 m/s
};

/// Runs the line over a whole scenario, in the order of reception, and shows each image's outcome.
void run_line(const Scenario& scenario, const std::function<void(const LineStep&)>& visit, const Vehicle& vehicle = {});

}  // namespace lodestar::sim
