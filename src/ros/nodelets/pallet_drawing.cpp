#include "lodestar/ros/nodelets/pallet_drawing.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>

#include "lodestar/estimation/pallet/pallet_map.hpp"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"
#include "lodestar/ros/nodelets/pallet_labels.hpp"
#include "marker_parts.hpp"

namespace lodestar {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std_msgs::ColorRGBA color_of(PalletState state) {
  switch (state) {
    case PalletState::kOnFork:
      return color(0.35, 0.75, 1.0);
    case PalletState::kUncertain:
      return color(1.0, 0.75, 0.1);
    default:
      return color(0.72, 0.55, 0.36);
  }
}

void add_zone(const std_msgs::Header& header, const Zone& zone, MarkerArray& out) {
  const int number = static_cast<int>(out.markers.size());
  const bool dock = zone.kind == ZoneKind::kDock;
  Marker border = marker(header, "zones", number, Marker::LINE_STRIP,
                         dock ? color(0.95, 0.45, 0.3, 0.9) : color(0.45, 0.65, 0.95, 0.9));
  border.scale.x = 0.06;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i <= zone.polygon_map.size(); ++i) {
    const Eigen::Vector2d& corner = zone.polygon_map[i % zone.polygon_map.size()];
    border.points.push_back(point({corner.x(), corner.y(), 0.02}));
    if (i > 0) middle += corner / static_cast<double>(zone.polygon_map.size());
  }
  Marker name = marker(header, "zone codes", number, Marker::TEXT_VIEW_FACING, border.color);
  name.pose.position = point({middle.x(), middle.y(), 0.1});
  name.scale.z = 0.6;
  name.text = zone.code;
  out.markers.insert(out.markers.end(), {border, name});
}

void add_pallet(const std_msgs::Header& header, const Pallet& pallet, const Eigen::Vector2d& size_m, MarkerArray& out) {
  const int number = static_cast<int>(out.markers.size());
  const auto box = [&](const char* ns, double from_m, double height_m, double share, const std_msgs::ColorRGBA& c) {
    Marker m = marker(header, ns, number, Marker::CUBE, c);
    m.pose = pose_message(pallet.T_map_pallet * Eigen::Translation3d(0, 0, from_m + 0.5 * height_m));
    set_scale(m, share * size_m.x(), share * size_m.y(), height_m);
    return m;
  };
  out.markers.insert(out.markers.end(), {box("pallets", 0, kDrawnPallet_m, 1, color(0.5, 0.36, 0.2)),
                                         box("goods", kDrawnPallet_m, kDrawnGoods_m, 0.95, color_of(pallet.state))});
}

void add_label(const std_msgs::Header& header, const PalletLabel& label, MarkerArray& out) {
  Marker text =
      marker(header, "pallet ids", static_cast<int>(out.markers.size()), Marker::TEXT_VIEW_FACING, color(1, 1, 1));
  text.pose.position = point(label.position_map);
  text.scale.z = kLabelLine_m;
  text.text = label.text;
  out.markers.push_back(text);
}

void add_pallets(const std_msgs::Header& header, const PalletArray& state, const std::vector<PalletSize>& sizes,
                 MarkerArray& out) {
  std::vector<Pallet> here;
  for (const PalletEntry& entry : state.pallets) {
    const auto pallet = pallet_from(entry);
    if (!pallet || pallet->state == PalletState::kGone || !has_place(*pallet)) continue;
    const auto size =
        std::find_if(sizes.begin(), sizes.end(), [&](const PalletSize& s) { return s.type == pallet->type; });
    add_pallet(header, *pallet, (size == sizes.end() ? sizes.front() : *size).size_m, out);
    here.push_back(*pallet);
  }
  for (const PalletLabel& label : pallet_labels(std::move(here), stamp_from(header.stamp)))
    add_label(header, label, out);
}

}  // namespace

PalletDrawing::PalletDrawing(ros::NodeHandle& nh, StageEdge& edge) : edge_(edge) {
  markers_ = nh.advertise<MarkerArray>("visualization/pallets", 2, true);
  subscriber_ = nh.subscribe("pallets/state", 2, &PalletDrawing::take, this);
  timer_ = nh.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { draw(); });
  draw();
}

void PalletDrawing::take(const PalletArrayConstPtr& message) {
  state_ = message;
  draw();
}

void PalletDrawing::draw() {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = edge_.map_frame();
  MarkerArray out;
  out.markers.push_back(marker(header, "", 0, Marker::CUBE, color(0, 0, 0)));
  out.markers.front().action = Marker::DELETEALL;
  for (const Zone& zone : edge_.site().zones) add_zone(header, zone, out);
  if (state_) add_pallets(header, *state_, edge_.vehicle().pallets, out);
  markers_.publish(out);
}

}  // namespace lodestar
