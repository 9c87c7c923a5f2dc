#pragma once

#include <map>
#include <optional>
#include <string>

#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {

/// The rigid joints of a vehicle, as a tree.
class Mounts {
 public:
  void add(const Mount& mount) { joints_[mount.child] = mount; }

  /// T_root_frame, through as many joints as it takes. Empty: no chain of joints leads from `frame` to `root`.
  std::optional<RigidTransform> find(const std::string& root, const std::string& frame) const {
    RigidTransform T_joint_frame = RigidTransform::Identity();
    std::string joint = frame;
    // A chain longer than the tree is a circle.
    for (std::size_t steps = 0; steps <= joints_.size(); ++steps) {
      if (joint == root) return T_joint_frame;
      const auto found = joints_.find(joint);
      if (found == joints_.end()) return std::nullopt;
      T_joint_frame = found->second.T_parent_child * T_joint_frame;
      joint = found->second.parent;
    }
    return std::nullopt;
  }

 private:
  std::map<std::string, Mount> joints_;  ///< by child
};

}  // namespace lodestar
