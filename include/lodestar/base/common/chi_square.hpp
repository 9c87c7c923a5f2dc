#pragma once

namespace lodestar {

/// Quantile of the chi-square distribution: the squared distance that `probability` of the samples stay below.
/// @param probability in (0, 1)
/// @param dof degrees of freedom, > 0
double chi_square_quantile(double probability, double dof);

}  // namespace lodestar
