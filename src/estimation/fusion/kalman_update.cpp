#include "lodestar/estimation/fusion/kalman_update.hpp"

namespace lodestar::fusion {

void symmetrize(Covariance& P) {
  for (Eigen::Index j = 0; j < P.cols(); ++j)
    for (Eigen::Index i = j + 1; i < P.rows(); ++i) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
}

}  // namespace lodestar::fusion
