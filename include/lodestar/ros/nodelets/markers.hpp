#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <set>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// What rviz draws of the line, in the header's frame (map). Each function gives whole namespaces: drawn anew, they
/// replace what was there.

/// The floor under all beacons, with a 1 m grid, thicker each 5 m.
visualization_msgs::MarkerArray floor_markers(const std_msgs::Header& header,
                                              const std::map<BeaconId, BeaconTable::Entry>& beacons);

/// Each beacon with its id: bright in use, pale idle, red in conflict with the site file.
visualization_msgs::MarkerArray beacon_markers(const std_msgs::Header& header,
                                               const std::map<BeaconId, BeaconTable::Entry>& beacons,
                                               const std::set<BeaconId>& in_use);

/// A circle of the protection level on the floor below the truck, kCovarianceScale times enlarged as the ellipse is.
visualization_msgs::Marker protection_marker(const std_msgs::Header& header, const Eigen::Vector3d& base_map,
                                             double protection_level_m);

/// A line from the camera to each beacon whose bearings the filter refuses.
visualization_msgs::Marker refused_marker(const std_msgs::Header& header, const Eigen::Vector3d& camera_map,
                                          const std::map<BeaconId, BeaconTable::Entry>& beacons,
                                          const std::set<BeaconId>& refused);

/// A line from the camera to each beacon in use.
visualization_msgs::Marker bearing_marker(const std_msgs::Header& header, const Eigen::Vector3d& camera_map,
                                          const std::map<BeaconId, BeaconTable::Entry>& beacons,
                                          const std::set<BeaconId>& in_use);

/// How much larger than true the ellipse of covariance_marker is: some cm would not be seen in a hall.
constexpr double kCovarianceScale = 60;

/// The ellipse of 3 sigma of x and y, kCovarianceScale times enlarged, on the floor below the truck.
visualization_msgs::Marker covariance_marker(const std_msgs::Header& header, const PoseEstimate& pose);

/// A forklift that stands at T_map_base.
visualization_msgs::MarkerArray truck_markers(const std_msgs::Header& header, const RigidTransform& T_map_base);

}  // namespace lodestar
