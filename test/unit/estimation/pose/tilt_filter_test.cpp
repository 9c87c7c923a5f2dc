#include "lodestar/estimation/pose/tilt_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/tilting_drive.hpp"

namespace lodestar {
namespace {

using test::TiltingDrive;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Hardly any noise: what remains is the method's own error.
TiltFilterParams almost_perfect() {
  TiltFilterParams params;
  params.gyro_noise_rad_s = 1e-5;
  params.gyro_bias_rad_s = 1e-4;
  params.accelerometer_noise_m_s2 = 1e-3;
  params.accelerometer_bias_m_s2 = 1e-4;
  params.odometry_velocity_sigma_m_s = 1e-3;
  params.odometry_yaw_rate_sigma_rad_s = 1e-3;
  params.odometry_scale_sigma = 1e-4;
  params.slip_s2 = params.sideslip_s2 = 0;
  return params;
}

/// Feeds 100 Hz of inertial and 50 Hz of wheel samples; calls check(t) after each.
template <class Check>
void drive(TiltFilter& filter, TiltingDrive& truth, double from_s, double to_s, Check check, bool wheels = true) {
  for (int i = static_cast<int>(std::lround(from_s * 100)); i < static_cast<int>(std::lround(to_s * 100)); ++i) {
    const double t_s = i * 0.01;
    if (wheels && i % 2 == 0) filter.add_odometry(truth.odometry(t_s));
    filter.add_imu(truth.imu(t_s));
    check(t_s);
  }
}

double error_rad(const TiltFilter& filter, const TiltingDrive& truth, double t_s) {
  const auto tilt = filter.tilt();
  return std::hypot(tilt->roll_rad - truth.roll_rad(t_s), tilt->pitch_rad - truth.pitch_rad(t_s));
}

TEST(TiltFilter, NothingHeardNothingSaid) { EXPECT_FALSE(TiltFilter({}).tilt()); }

TEST(TiltFilter, FlatFloorWhenOnlyWheelsAreHeard) {
  TiltFilter filter({});
  TiltingDrive truth(1, {}, 0, 0);
  filter.add_odometry(truth.odometry(0));
  const auto tilt = filter.tilt();
  ASSERT_TRUE(tilt);
  EXPECT_EQ(tilt->roll_rad, 0);
  EXPECT_EQ(tilt->pitch_rad, 0);
  EXPECT_EQ(tilt->sigma_rad, 0.02);
}

TEST(TiltFilter, FirstSampleGivesATilt) {
  TiltFilter filter({});
  TiltingDrive truth(1, almost_perfect(), 0, 0);
  filter.add_imu(truth.imu(0));
  ASSERT_TRUE(filter.tilt());
  EXPECT_LT(error_rad(filter, truth, 0), 0.001);
  EXPECT_GT(filter.tilt()->sigma_rad, 0.02);  // nobody said that the truck stands
}

TEST(TiltFilter, AtRestTheBiasIsAllThatIsLeft) {
  TiltFilterParams params;
  TiltFilter filter(params);
  TiltingDrive truth(1, params, 0, 0);
  drive(filter, truth, 0, 20, [](double) {});
  const double bias_rad = params.accelerometer_bias_m_s2 / 9.81;
  EXPECT_GT(filter.tilt()->sigma_rad, 0.99 * bias_rad);
  EXPECT_LT(filter.tilt()->sigma_rad, 1.1 * bias_rad);
}

TEST(TiltFilter, FollowsTheFloorThroughHardDriving) {
  TiltFilter filter(almost_perfect());
  TiltingDrive truth(3, almost_perfect(), 5, 0.01);
  double worst = 0;
  drive(filter, truth, 0, 40, [&](double t_s) {
    if (t_s > 1) worst = std::fmax(worst, error_rad(filter, truth, t_s));
  });
  EXPECT_LT(worst, 0.001);  // 2 m/s^2, taken for gravity, would be 0.2
}

TEST(TiltFilter, DrivingWithOrdinarySensors) {
  for (int seed = 0; seed < 5; ++seed) {
    TiltFilter filter({});
    TiltingDrive truth(seed, {}, 5, 0.01);
    drive(filter, truth, 0, 40, [&](double t_s) {
      if (t_s > 1) {
        ASSERT_LT(error_rad(filter, truth, t_s), 4 * filter.tilt()->sigma_rad) << "seed " << seed << " at " << t_s;
        ASSERT_LT(filter.tilt()->sigma_rad, 0.008);
      }
    });
  }
}

TEST(TiltFilter, TyresThatSlipDoNotTiltTheTruck) {
  TiltFilter filter({});
  TiltingDrive truth(3, almost_perfect(), 5, 0.01);
  truth.slip_s2 = 0.005;
  double worst = 0;
  drive(filter, truth, 0, 40, [&](double t_s) {
    if (t_s > 1) worst = std::fmax(worst, error_rad(filter, truth, t_s));
  });
  EXPECT_LT(worst, 0.005);  // wheels that are believed: 0.007
}

TEST(TiltFilter, SensorFarFromBaseLink) {
  for (const bool told : {true, false}) {
    TiltFilter filter(almost_perfect());
    TiltingDrive truth(3, almost_perfect(), 5, 0.01);
    truth.imu_position_base << 1.5, -0.4, 1;
    if (told) filter.set_imu(truth.imu_position_base);
    filter.reset();  // keeps the place
    double worst = 0;
    drive(filter, truth, 0, 40, [&](double t_s) {
      if (t_s > 1) worst = std::fmax(worst, error_rad(filter, truth, t_s));
    });
    EXPECT_EQ(worst < 0.002, told) << worst;
  }
}

TEST(TiltFilter, StartsWhileDriving) {
  TiltFilter filter({});
  TiltingDrive truth(4, {}, 5, 0.01);
  drive(filter, truth, 2.5, 12, [&](double t_s) {  // in the middle of 2 m/s^2
    if (t_s < 2.7) {
      EXPECT_GT(filter.tilt()->sigma_rad, 0.05);
    }
    if (t_s > 5) {
      EXPECT_LT(error_rad(filter, truth, t_s), 4 * filter.tilt()->sigma_rad);
    }
  });
  EXPECT_LT(filter.tilt()->sigma_rad, 0.01);
}

TEST(TiltFilter, WorksWithoutWheels) {
  TiltFilter filter({});
  TiltingDrive truth(5, {}, 0, 0.005);
  drive(
      filter, truth, 0, 30, [](double) {}, false);
  EXPECT_LT(error_rad(filter, truth, 29.99), 3 * filter.tilt()->sigma_rad);
  EXPECT_LT(filter.tilt()->sigma_rad, 0.05);
}

TEST(TiltFilter, BadSamplesChangeNothing) {
  TiltFilter filter({}), undisturbed({});
  TiltingDrive truth(6, {}, 3, 0.01), same_truth(6, {}, 3, 0.01);
  drive(undisturbed, same_truth, 0, 5, [](double) {});
  drive(filter, truth, 0, 5, [&](double t_s) {
    ImuSample imu;
    imu.stamp = TiltingDrive::stamp(t_s);
    filter.add_imu(imu);  // a duplicate stamp, and free fall
    imu.stamp = TiltingDrive::stamp(t_s - 0.05);
    filter.add_imu(imu);
    imu.stamp = TiltingDrive::stamp(t_s + 0.001);
    imu.specific_force_m_s2.x() = kNan;
    filter.add_imu(imu);
    imu.specific_force_m_s2.x() = 0;
    imu.angular_velocity_rad_s.z() = INFINITY;
    filter.add_imu(imu);
    OdometrySample odometry;
    odometry.velocity_m_s.x() = 50;
    odometry.stamp = TiltingDrive::stamp(t_s - 0.5);
    filter.add_odometry(odometry);
    odometry.stamp = TiltingDrive::stamp(t_s + 0.001);
    odometry.velocity_m_s.x() = kNan;
    filter.add_odometry(odometry);
  });
  EXPECT_EQ(filter.tilt()->roll_rad, undisturbed.tilt()->roll_rad);
  EXPECT_EQ(filter.tilt()->pitch_rad, undisturbed.tilt()->pitch_rad);
  EXPECT_EQ(filter.tilt()->sigma_rad, undisturbed.tilt()->sigma_rad);
}

TEST(TiltFilter, TimeGoingBackStartsAnew) {
  TiltFilter filter({}), fresh({});
  TiltingDrive before(7, {}, 3, 0.01), after(8, {}, 3, 0.01), same_after(8, {}, 3, 0.01);
  drive(filter, before, 100, 110, [](double) {});
  drive(filter, after, 0, 5, [](double) {});
  drive(fresh, same_after, 0, 5, [](double) {});
  EXPECT_EQ(filter.tilt()->roll_rad, fresh.tilt()->roll_rad);
  EXPECT_EQ(filter.tilt()->sigma_rad, fresh.tilt()->sigma_rad);
}

TEST(TiltFilter, AGapStartsAnew) {
  TiltFilter filter({});
  TiltingDrive truth(9, {}, 3, 0.01);
  drive(filter, truth, 0, 10, [](double) {});
  drive(filter, truth, 15, 15.01, [](double) {});
  EXPECT_GT(filter.tilt()->sigma_rad, 0.006);
}

TEST(TiltFilter, ResetForgets) {
  TiltFilter filter({});
  TiltingDrive truth(10, {}, 3, 0.01);
  drive(filter, truth, 0, 3, [](double) {});
  filter.reset();
  EXPECT_FALSE(filter.tilt());
}

}  // namespace
}  // namespace lodestar
