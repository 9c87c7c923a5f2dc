#pragma once

#include "lodestar/base/yaml/yaml_map.hpp"
#include "lodestar/sim/scenario.hpp"

namespace lodestar::sim {

/// A map of the scenario file with what every section needs: values that keep their default where the key is missing.
class Section {
 public:
  Section(const YamlMap& map, FaultLog& faults) : map_(map), faults_(&faults) {}

  Section section(const char* key, const std::vector<YamlKey>& keys) const;
  /// Calls `read` with each item of a list of maps.
  template <class Read>
  void each(const char* key, const std::vector<YamlKey>& keys, Read&& read) const {
    std::size_t i = 0;
    for (const YAML::Node& node : map_.list(key))
      read(Section(YamlMap(node, map_.path(key) + "[" + std::to_string(i++) + "]", map_.line(key), keys, *faults_),
                   *faults_));
  }

  void number(const char* key, const Limits& limits, double& value) const;
  void integer(const char* key, const Limits& limits, int& value) const;
  void degrees(const char* key, const Limits& limits_deg, double& value_rad) const;
  void flag(const char* key, bool& value) const;
  /// @return whether it was there and right
  bool vector(const char* key, Eigen::Vector2d& value) const;
  bool vector(const char* key, Eigen::Vector3d& value) const;
  void mount(const char* key, RigidTransform& T_base_sensor) const;

  const YamlMap& map() const { return map_; }
  FaultLog& faults() const { return *faults_; }

 private:
  YamlMap map_;
  FaultLog* faults_;
};

/// The parts of a scenario file, each from the file's root.
void read_sensors(const Section& file, Scenario& scenario);
void read_world(const Section& file, Scenario& scenario);
void read_route(const Section& file, Scenario& scenario);

}  // namespace lodestar::sim
