#pragma once

#include <optional>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/diode_array.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/naming/beacon_namer.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"
#include "lodestar/estimation/pose/tilt_filter.hpp"
#include "lodestar/sensing/beacon/beacon_detector.hpp"

namespace lodestar {

/// What one stage of the line needs of site, vehicle and camera rate. Every program that runs a stage, nodelet or tool,
/// takes its parameters from here, so that all of them do the same.
struct LineParams {
  BeaconDetectorParams detector;
  BeaconNamerParams namer;
  PoseSolverParams solver;
  TiltFilterParams tilt;
  PoseFilterParams filter;
  double calibration_sigma_px = 0.3;
  bool use_sightings = true;  ///< tightly coupled; off: the filter is fed with fixes alone
  DiodeArray diodes;          ///< of the IR receiver
  Duration heard_for{};       ///< how long after its announcement a beacon counts as heard
};

/// @param frame_rate_hz of the camera, for the detector's window where neither file fixes it; none for who runs other
/// stages alone
LineParams line_params(const Site& site, const Vehicle& vehicle, std::optional<double> frame_rate_hz = std::nullopt);

/// How long a beacon counts as heard: a lost frame or two must not silence it.
Duration heard_for(const Link& link);

}  // namespace lodestar
