#include "lodestar/base/common/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace lodestar {

double chi_square_quantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

}  // namespace lodestar
