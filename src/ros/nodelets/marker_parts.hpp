#pragma once

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Core>
#include <string>

namespace lodestar {

inline std_msgs::ColorRGBA color(double r, double g, double b, double a = 1.0) {
  std_msgs::ColorRGBA c;
  c.r = static_cast<float>(r);
  c.g = static_cast<float>(g);
  c.b = static_cast<float>(b);
  c.a = static_cast<float>(a);
  return c;
}

inline geometry_msgs::Point point(const Eigen::Vector3d& p) {
  geometry_msgs::Point out;
  out.x = p.x();
  out.y = p.y();
  out.z = p.z();
  return out;
}

inline visualization_msgs::Marker marker(const std_msgs::Header& header, const std::string& ns, int id, int type,
                                         const std_msgs::ColorRGBA& c) {
  visualization_msgs::Marker m;
  m.header = header;
  m.ns = ns;
  m.id = id;
  m.type = type;
  m.action = visualization_msgs::Marker::ADD;
  m.pose.orientation.w = 1;
  m.color = c;
  return m;
}

inline void set_scale(visualization_msgs::Marker& m, double x, double y, double z) {
  m.scale.x = x;
  m.scale.y = y;
  m.scale.z = z;
}

}  // namespace lodestar
