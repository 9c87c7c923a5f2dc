#pragma once

#include <list>
#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/line/line_params.hpp"
#include "lodestar/line/pose_stage.hpp"

namespace lodestar {

/// Why a place was given up.
enum class PlaceDrop {
  kContradicted,  ///< another explains the blobs better by far
  kLost,          ///< one of the places became too vague to follow, so that what is left proves nothing
  kCount
};
const char* name(PlaceDrop reason);

/// Where the vehicle may be, while the blobs leave more than one place open: both roots of two beacons, or a code that
/// is in use at several places of the plant and no receiver to hear which. Each place has a filter of its own, driven
/// by the same wheels and inertial sensor. Driving on shows which is right: the others' blobs fall where there is no
/// beacon.
///
/// Places are opened only when every way to name the blobs has either a pose or a contradiction, and are all given up
/// when one becomes too vague to follow: an open question left out could be the answer. A place costs the squared
/// distance of each blob that it explains and the gate of each that it does not, once in kIndependent_s; it is
/// contradicted when it costs kMargin_chi2 more than the best.
class PlaceHypotheses {
 public:
  explicit PlaceHypotheses(const LineParams& params);

  void set_camera(const CameraMount& camera);
  /// Where the inertial sensor sits, in base_link (m).
  void set_imu(const Eigen::Vector3d& imu_position_base);
  void set_beacons(const std::vector<Beacon>& beacons);
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);

  /// Opens places, or weighs the open ones.
  /// @return the filter of the one place that is left, after kProof_s; none is open then
  std::optional<PoseFilter> add_sightings(const Sightings& sightings);

  /// The question is settled.
  void close() { places_.clear(); }
  void reset();

  std::size_t open() const { return places_.size(); }
  const DropCounts<PlaceDrop>& drops() const { return drops_; }

 private:
  struct Place {
    PoseFilter filter;
    double cost = 0;
  };
  static bool lost(const Place& place);
  void open_places(const Sightings& sightings);
  Place place_at(const Fix& fix) const;
  double cost(PoseFilter& filter, const Sightings& sightings);
  void give_up_losers();

  LineParams params_;
  PoseStage solver_;
  BeaconNamer namer_;
  CameraMount camera_;
  Eigen::Vector3d imu_position_base_ = Eigen::Vector3d::Zero();
  std::vector<Beacon> beacons_;
  std::list<Place> places_;
  Stamp opened_, weighed_;
  DropCounts<PlaceDrop> drops_;
};

}  // namespace lodestar
