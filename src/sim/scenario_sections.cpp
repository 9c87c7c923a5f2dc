#include "scenario_sections.hpp"

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

const Limits kCoordinate = within(-10000, 10000);

}  // namespace

Section Section::section(const char* key, const std::vector<YamlKey>& keys) const {
  return {map_.section(key, keys), *faults_};
}

void Section::number(const char* key, const Limits& limits, double& value) const {
  value = map_.number(key, limits).value_or(value);
}

void Section::integer(const char* key, const Limits& limits, int& value) const {
  if (const auto read = map_.integer(key, limits)) value = static_cast<int>(*read);
}

void Section::degrees(const char* key, const Limits& limits_deg, double& value_rad) const {
  if (const auto value_deg = map_.number(key, limits_deg)) value_rad = radians(*value_deg);
}

void Section::flag(const char* key, bool& value) const {
  const auto text = map_.text(key);
  if (!text) return;
  if (*text != "true" && *text != "false") map_.fault(key, "is " + quote(*text) + ": give true or false");
  value = *text == "true";
}

bool Section::vector(const char* key, Eigen::Vector2d& value) const {
  const auto read = map_.numbers(key, 2, 2, kCoordinate);
  if (read) value = {(*read)[0].value, (*read)[1].value};
  return read.has_value();
}

bool Section::vector(const char* key, Eigen::Vector3d& value) const {
  const auto read = map_.numbers(key, 3, 3, kCoordinate);
  if (read) value = {(*read)[0].value, (*read)[1].value, (*read)[2].value};
  return read.has_value();
}

void Section::mount(const char* key, RigidTransform& T_base_sensor) const {
  if (!map_.has(key)) return;
  const Section mount = section(key, {{"xyz_m", true}, {"rpy_deg", true}});
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero(), rpy_deg = Eigen::Vector3d::Zero();
  if (!mount.vector("xyz_m", xyz) || !mount.vector("rpy_deg", rpy_deg)) return;
  T_base_sensor.translation() = xyz;
  T_base_sensor.linear() = rotation({radians(rpy_deg.x()), radians(rpy_deg.y()), radians(rpy_deg.z())});
}

}  // namespace lodestar::sim
