#include "lodestar/estimation/fusion/mm_floor.hpp"

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::fusion {

Innovation<2> floor_innovation(const CoreState& x, const PoseFilterParams& params) {
  const Eigen::Vector3d up_map = x.q_map_base * Eigen::Vector3d::UnitZ();
  Innovation<2> m;
  m.residual = -up_map.head<2>();
  m.H.block<2, 3>(0, kRotation) = -skew(up_map).topRows<2>();
  m.R.diagonal().setConstant(params.level_sigma_rad * params.level_sigma_rad);
  return m;
}

}  // namespace lodestar::fusion
