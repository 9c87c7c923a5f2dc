#include "lodestar/ros/nodelets/mount_lookup.hpp"

#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {

// The listener works on the nodelet's own queue: no thread of its own, no lock.
MountLookup::MountLookup(const ros::NodeHandle& nh, std::string base_frame)
    : base_frame_(std::move(base_frame)), listener_(buffer_, nh, false) {
  buffer_.setUsingDedicatedThread(true);
}

std::optional<RigidTransform> MountLookup::T_base(const std::string& frame) {
  const auto found = known_.find(frame);
  if (found != known_.end()) return found->second;
  if (!buffer_.canTransform(base_frame_, frame, ros::Time(0))) return std::nullopt;
  const auto T = transform_from(buffer_.lookupTransform(base_frame_, frame, ros::Time(0)).transform);
  if (!T) return std::nullopt;
  return known_.emplace(frame, *T).first->second;
}

}  // namespace lodestar
