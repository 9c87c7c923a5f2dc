#include "lodestar/wms/telemetry.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

using nlohmann::json;

/// A truck whose pose is told ten times a second; what its states say of driving.
class DrivingTest : public testing::Test {
 protected:
  DrivingTest() { telemetry_.at_connect({test::at(0), Instant(), true}); }

  std::vector<bool> move(double speed_m_s, double yaw_rate_rad_s) {
    std::vector<bool> told;
    for (int i = 0; i < 10; ++i) {
      time_s_ += 0.1;
      x_m_ += 0.1 * speed_m_s;
      yaw_rad_ += 0.1 * yaw_rate_rad_s;
      const Instant now(from_seconds(time_s_));
      PoseEstimate pose;
      pose.stamp = test::at(time_s_);
      pose.T_map_base = Eigen::Translation3d(x_m_, 0, 0) * Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ());
      telemetry_.take_pose(pose, now);
      for (const MqttMessage& message : telemetry_.due({pose.stamp, now, true}))
        if (message.topic.find("/state") != std::string::npos)
          told.push_back(json::parse(message.payload)["driving"].get<bool>());
    }
    return told;
  }

 private:
  static VdaParams params() {
    VdaParams params;
    params.state_period_s = 1000;
    return params;
  }
  Telemetry telemetry_{params()};
  double time_s_ = 0, x_m_ = 0, yaw_rad_ = 3;  // turning, it passes half a turn
};

TEST_F(DrivingTest, AChangeIsToldAtOnceAndOnce) {
  EXPECT_EQ(move(0, 0), (std::vector<bool>{false, false})) << "the first state, and the first that is known";
  EXPECT_EQ(move(1, 0), std::vector<bool>{true});
  EXPECT_EQ(move(-1, 0), std::vector<bool>{}) << "backwards, too, is driving";
  EXPECT_EQ(move(0, 0), std::vector<bool>{false});
}

TEST_F(DrivingTest, TurningOnTheSpotIsDriving) {
  move(0, 0);
  EXPECT_EQ(move(0, 0.2), std::vector<bool>{true});
  EXPECT_EQ(move(0, 0.01), std::vector<bool>{false});
  EXPECT_EQ(move(0, -0.2), std::vector<bool>{true});
}

}  // namespace
}  // namespace lodestar
