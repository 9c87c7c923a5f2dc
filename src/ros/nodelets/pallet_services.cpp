#include "lodestar/ros/nodelets/pallet_services.hpp"

#include <algorithm>
#include <sstream>

#include "lodestar/base/measurement/pose_limits.hpp"
#include "lodestar/estimation/pallet/placing.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {
namespace {

bool begins(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// Its storage code; empty where it stands in no zone, or not at all.
std::string place_of(const Pallet& pallet, const std::vector<Zone>& zones) {
  const bool here = pallet.state == PalletState::kStanding || pallet.state == PalletState::kUncertain;
  return here && !pallet.zone.empty() ? storage_code(zones, pallet.T_map_pallet.translation()) : "";
}

RigidTransform pose_of(const Place& place) {
  RigidTransform T_map_pallet = RigidTransform::Identity();
  T_map_pallet.translation() = place.position_map;
  T_map_pallet.linear() = rotation({0, 0, place.yaw_rad});
  return T_map_pallet;
}

/// Whether the pallet is one of those that the request asks for, but for the area.
bool matches(const Pallet& pallet, const FindPallets::Request& request, const std::vector<Zone>& zones) {
  if (pallet.state == PalletState::kGone && !request.gone) return false;
  if (!begins(pallet.id, request.id) && !begins(pallet.sscc, request.id)) return false;
  if (!request.zone.empty() && pallet.zone != request.zone && place_of(pallet, zones) != request.zone) return false;
  if (!request.since.isZero() && pallet.changed < stamp_from(request.since)) return false;
  return request.until.isZero() || pallet.changed <= stamp_from(request.until);
}

FloorPolygon polygon_from(const geometry_msgs::Polygon& message) {
  FloorPolygon polygon;
  for (const geometry_msgs::Point32& point : message.points) polygon.emplace_back(point.x, point.y);
  return polygon;
}

bool is_sigma(double sigma) { return sigma > 0 && sigma <= kUnknownSigma; }

/// Empty, with the reason in `why`, where the request tells a pose or place that is none.
std::optional<PalletCorrection> correction_from(const CorrectPallet::Request& request, const std::vector<Zone>& zones,
                                                std::string& why) {
  PalletCorrection correction;
  correction.stamp = stamp_from(ros::Time::now());
  correction.id = request.id;
  correction.same_as = request.same_as;
  correction.sscc = request.sscc;
  correction.type = request.type;
  correction.gone = request.gone;
  correction.reason = request.reason;
  if (!request.has_pose && request.place.empty()) return correction;
  const auto told = transform_from(request.pose);
  const auto place = find_place(zones, request.place);
  const double m = request.position_sigma_m, rad = request.yaw_sigma_rad;
  if (request.has_pose && !request.place.empty()) {
    why = "give a pose or a place";
  } else if (request.has_pose && !told) {
    why = std::string("the pose is none: ") + name(told.error());
  } else if (!request.has_pose && !place) {
    why = "no zone's grid has the place '" + request.place + "'";
  } else if (!is_sigma(m) || !is_sigma(rad)) {
    std::ostringstream text;
    text << "position_sigma_m is " << m << ", yaw_sigma_rad " << rad << ": above 0 and at most " << kUnknownSigma;
    why = text.str();
  }
  if (!why.empty()) return std::nullopt;
  PalletPose& pose = correction.pose.emplace();
  pose.T_map_pallet = place ? pose_of(*place) : *told;
  pose.covariance.diagonal() << m * m, m * m, m * m, rad * rad, rad * rad, rad * rad;
  return correction;
}

}  // namespace

PalletServices::PalletServices(ros::NodeHandle& nh, PalletTracker& tracker, const Site& site,
                               std::function<void(const PalletTracker::Changes&)> on_change)
    : tracker_(tracker), site_(site), on_change_(std::move(on_change)) {
  servers_ = {nh.advertiseService("pallets/get", &PalletServices::get, this),
              nh.advertiseService("pallets/find", &PalletServices::find, this),
              nh.advertiseService("pallets/correct", &PalletServices::correct, this),
              nh.advertiseService("pallets/free_places", &PalletServices::free, this),
              nh.advertiseService("pallets/events_after", &PalletServices::events_after, this)};
}

bool PalletServices::get(GetPallet::Request& request, GetPallet::Response& response) {
  const PalletChange* last = tracker_.pallets().find(request.id);
  if (last == nullptr && !request.id.empty()) last = tracker_.pallets().with_sscc(request.id);
  response.found = last != nullptr;
  if (last == nullptr) return true;
  for (const Pallet& pallet : tracker_.now())
    if (pallet.id == last->pallet.id) response.pallet = pallet_message(pallet);
  response.place = place_of(last->pallet, site_.zones);
  response.candidates = last->candidates;
  response.sequence = last->sequence;
  return true;
}

bool PalletServices::find(FindPallets::Request& request, FindPallets::Response& response) {
  const FloorPolygon area = polygon_from(request.area);
  const auto is_far = [](const Eigen::Vector2d& corner) { return !(corner.array().abs() <= kFarthest_m).all(); };
  response.success = area.empty() || (std::none_of(area.begin(), area.end(), is_far) && is_simple(area));
  if (!response.success) {
    response.message =
        "area is no polygon: give at least three corners in order, with no side across another, "
        "none farther than 10000 m from the map's origin";
    return true;
  }
  for (const Pallet& pallet : tracker_.now()) {
    const bool inside =
        area.empty() || (has_place(pallet) && contains(area, pallet.T_map_pallet.translation().head<2>()));
    if (inside && matches(pallet, request, site_.zones)) response.pallets.push_back(pallet_message(pallet));
  }
  return true;
}

bool PalletServices::correct(CorrectPallet::Request& request, CorrectPallet::Response& response) {
  const auto correction = correction_from(request, site_.zones, response.message);
  if (!correction) return true;
  const auto changes = tracker_.correct(*correction);
  response.success = changes.ok();
  if (changes) {
    on_change_(*changes);
  } else {
    response.message = name(changes.error());
  }
  return true;
}

bool PalletServices::free(FreePlaces::Request& request, FreePlaces::Response& response) {
  const Zone* zone = find_zone(site_.zones, request.zone);
  const PalletMap& map = tracker_.pallets();
  response.success = false;
  if (zone == nullptr) {
    response.message = "the site file has no such zone";
  } else if (zone->kind == ZoneKind::kDock) {
    response.message = "the zone is a dock: what is set down there leaves the site";
  } else if (!request.type.empty() && map.find_size(request.type) == nullptr) {
    response.message = name(CorrectionFault::kType);
  } else {
    response.success = true;
    for (const Place& place :
         free_places(*zone, map.size(request.type.empty() ? zone->pallet_type : request.type), map)) {
      response.codes.push_back(place.code);
      response.poses.push_back(pose_message(pose_of(place)));
    }
  }
  return true;
}

bool PalletServices::events_after(PalletEventsAfter::Request& request, PalletEventsAfter::Response& response) {
  for (const PalletChange& change : tracker_.ledger().after(request.sequence))
    response.events.push_back(pallet_event_message(change, site_.frame_id));
  return true;
}

}  // namespace lodestar
