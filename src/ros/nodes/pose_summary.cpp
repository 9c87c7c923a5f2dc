// Prints where the truck is and how far that is from the truth, once a second: what scripts/demo shows without a
// display. `pose_summary [seconds]` ends after that wall time, or never; exits non-zero when no pose came.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/ros/convert/pose.hpp"

namespace lodestar {
namespace {

struct PlanarPose {
  Stamp stamp;
  Eigen::Vector2d position_m;
  double yaw_rad;
};

PlanarPose planar(Stamp stamp, const RigidTransform& T_map_base) {
  return {stamp, T_map_base.translation().head<2>(), roll_pitch_yaw(T_map_base.linear()).yaw_rad};
}

struct ErrorSum {
  int count = 0;
  double sum = 0, max = 0;
  void add(double error) {
    ++count;
    sum += error;
    max = std::max(max, error);
  }
  double mean() const { return sum / count; }
};

class PoseSummary {
 public:
  explicit PoseSummary(ros::NodeHandle& node)
      : pose_subscriber_(node.subscribe("pose", 100, &PoseSummary::on_pose, this)),
        truth_subscriber_(node.subscribe("ground_truth/pose", 1000, &PoseSummary::on_truth, this)) {}

  void print_now() const {
    if (!latest_) {
      std::printf("waiting for the first pose ...\n");
    } else {
      std::printf("x %7.3f m   y %7.3f m   yaw %7.2f deg", latest_->position_m.x(), latest_->position_m.y(),
                  degrees(latest_->yaw_rad));
      if (last_error_)
        std::printf("   error %5.3f m %5.2f deg", last_error_->position_m, degrees(last_error_->yaw_rad));
      std::printf("\n");
    }
    std::fflush(stdout);
  }

  bool print_total() const {
    if (poses_ == 0) {
      std::printf("No pose came.\n");
      return false;
    }
    std::printf("%d poses", poses_);
    if (position_.count > 0)
      std::printf("; error of position mean %.3f m, max %.3f m; of yaw mean %.2f deg, max %.2f deg", position_.mean(),
                  position_.max, degrees(yaw_.mean()), degrees(yaw_.max));
    std::printf(".\n");
    return true;
  }

 private:
  struct Error {
    double position_m, yaw_rad;
  };

  void on_pose(const geometry_msgs::PoseWithCovarianceStamped& message) {
    const auto pose = pose_estimate_from(message, "map");
    if (!pose) return;
    ++poses_;
    latest_ = planar(pose->stamp, pose->T_map_base);
    waiting_.push_back(*latest_);
    if (waiting_.size() > 1000) waiting_.pop_front();
  }

  void on_truth(const geometry_msgs::PoseStamped& message) {
    const auto pose = pose_from(message, "map");
    if (!pose) return;
    const PlanarPose truth = planar(pose->stamp, pose->T_parent_child);
    while (before_ && !waiting_.empty() && waiting_.front().stamp <= truth.stamp) {
      if (waiting_.front().stamp >= before_->stamp) compare(waiting_.front(), *before_, truth);
      waiting_.pop_front();
    }
    before_ = truth;
  }

  void compare(const PlanarPose& pose, const PlanarPose& before, const PlanarPose& after) {
    const double span_s = seconds(after.stamp - before.stamp);
    const double part = span_s > 0 ? seconds(pose.stamp - before.stamp) / span_s : 0;
    const Eigen::Vector2d position_m = before.position_m + part * (after.position_m - before.position_m);
    const double yaw_rad = before.yaw_rad + part * wrap_angle(after.yaw_rad - before.yaw_rad);
    last_error_ = Error{(pose.position_m - position_m).norm(), std::abs(wrap_angle(pose.yaw_rad - yaw_rad))};
    position_.add(last_error_->position_m);
    yaw_.add(last_error_->yaw_rad);
  }

  ros::Subscriber pose_subscriber_, truth_subscriber_;
  int poses_ = 0;
  std::optional<PlanarPose> latest_, before_;
  std::deque<PlanarPose> waiting_;  ///< for truth as new as they are
  std::optional<Error> last_error_;
  ErrorSum position_, yaw_;
};

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  ros::init(argc, argv, "pose_summary");
  constexpr double kMasterTimeout_s = 30;
  for (int tries = 0; !ros::master::check(); ++tries) {
    if (tries * 0.1 > kMasterTimeout_s) {
      std::printf("No roscore at %s after %.0f s.\n", ros::master::getURI().c_str(), kMasterTimeout_s);
      return EXIT_FAILURE;
    }
    ros::WallDuration(0.1).sleep();
  }
  ros::NodeHandle node;
  const double seconds = argc > 1 ? std::atof(argv[1]) : 0;
  lodestar::PoseSummary summary(node);
  const ros::WallTime start = ros::WallTime::now();
  ros::WallTime printed = start;
  while (ros::ok()) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    const ros::WallTime now = ros::WallTime::now();
    if ((now - printed).toSec() >= 1.0) {
      summary.print_now();
      printed = now;
    }
    if (seconds > 0 && (now - start).toSec() >= seconds) break;
  }
  return summary.print_total() ? EXIT_SUCCESS : EXIT_FAILURE;
}
