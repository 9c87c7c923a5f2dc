#include "lodestar/estimation/fusion/mm_standstill.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kStillVelocity_m_s = 0.01;  ///< below the wheels' resolution
constexpr double kStillRate_rad_s = 5e-4;    ///< a mast that nods, a driver who moves

}  // namespace

Innovation<3> standing_velocity_innovation(const CoreState& x) {
  Innovation<3> m;
  m.residual = -x.velocity;
  m.H.block<3, 3>(0, kVelocity).setIdentity();
  m.R.diagonal().setConstant(kStillVelocity_m_s * kStillVelocity_m_s);
  return m;
}

Innovation<3> standing_gyro_innovation(const CoreState& x, const Eigen::Vector3d& measured_angular_velocity_rad_s,
                                       const PoseFilterParams& params) {
  const double noise = params.gyro_noise_rad_s;
  Innovation<3> m;
  m.residual = measured_angular_velocity_rad_s - x.gyro_bias;
  m.H.block<3, 3>(0, kGyroBias).setIdentity();
  m.R.diagonal().setConstant(noise * noise + kStillRate_rad_s * kStillRate_rad_s);
  return m;
}

}  // namespace lodestar::fusion
