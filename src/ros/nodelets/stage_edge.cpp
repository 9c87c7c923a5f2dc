#include "lodestar/ros/nodelets/stage_edge.hpp"

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

LineSetup StageEdge::read_or_refuse(ParamReader& params) {
  LineSetup setup = read_line_setup(params);
  refuse_faults(params.faults());
  return setup;
}

StageEdge::StageEdge(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, ParamReader& params,
                     const std::string& task, std::function<void()> on_reset)
    : base_frame_(params.text("base_frame", "base_link")),
      limits_(read_stale_limits(params)),
      setup_(read_or_refuse(params)),
      health_(nh, private_nh, task, setup_.vehicle.name, limits_),
      mounts_(nh, base_frame_),
      on_reset_(std::move(on_reset)) {}

bool StageEdge::admit(const ros::Time& stamp) {
  const TimeVerdict verdict = jump_.check(stamp_from(stamp), stamp_from(ros::Time::now()));
  if (verdict == TimeVerdict::kDrop) health_.drop(EdgeDrop::kTimeStep);
  if (verdict == TimeVerdict::kReset) {
    health_.count_reset();
    on_reset_();
  }
  return verdict != TimeVerdict::kDrop;
}

}  // namespace lodestar
