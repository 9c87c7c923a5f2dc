#include "lodestar/estimation/pose/tilt_filter.hpp"

#include <gtest/gtest.h>

#include "support/tilting_drive.hpp"

namespace lodestar {
namespace {

// The filter tells one sigma for both angles, that of the worse; so the mean normalised error is to stay a little
// below one, never above.
TEST(TiltFilterConsistency, SigmaIsHonestAtRestAndInDrives) {
  for (const double top_speed_m_s : {0.0, 2.0, 5.0}) {
    double sum = 0;
    int count = 0;
    for (int seed = 0; seed < 60; ++seed) {
      TiltFilterParams params;
      TiltFilter filter(params);
      test::TiltingDrive truth(seed, params, top_speed_m_s, 0.008);
      for (int i = 0; i < 3000; ++i) {
        const double t_s = i * 0.01;
        if (i % 2 == 0) filter.add_odometry(truth.odometry(t_s));
        filter.add_imu(truth.imu(t_s));
        if (i % 100 != 99) continue;
        const Tilt tilt = *filter.tilt();
        sum += (std::pow(tilt.roll_rad - truth.roll_rad(t_s), 2) + std::pow(tilt.pitch_rad - truth.pitch_rad(t_s), 2)) /
               (2 * tilt.sigma_rad * tilt.sigma_rad);
        ++count;
      }
    }
    EXPECT_GT(sum / count, 0.6) << top_speed_m_s;
    EXPECT_LT(sum / count, 1.2) << top_speed_m_s;
  }
}

}  // namespace
}  // namespace lodestar
