#pragma once

#include <Eigen/Core>
#include <vector>

namespace lodestar {

/// What the mean normalised error squared (NEES) of an honest estimate lies within, but for one time in twenty.
struct NeesBand {
  double low = 0, high = 0;
  bool holds(double mean) const { return low <= mean && mean <= high; }
};

/// Of the mean over `draws` independent draws (a fraction is allowed) with `dof` degrees of freedom each: draws times
/// the mean is chi-square with draws * dof. Source: Y. Bar-Shalom, X.-R. Li, T. Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, section 5.4.2.
NeesBand nees_band(double draws, int dof);

/// How many independent draws the mean of e'e over a series is worth: between 1 (errors that stay) and its length
/// (white ones). Each component of e is an error over its sigma, with mean 0 if the estimate is honest. The squares of
/// a Gaussian series are correlated by the square of its own correlation r_k (about 0, not about its mean: a constant
/// error is one draw), so the variance of the mean is that of n / tau draws with tau = 1 + 2 sum (1 - k / n) r_k^2. The
/// sum ends where k is 5 tau. r_k does not depend on the size of the errors, so that a sigma that is too small widens
/// no band. Source: A. Sokal, Monte Carlo Methods in Statistical Mechanics, 1996, section 3.
double independent_draws(const std::vector<Eigen::Vector3d>& normalized_errors);

}  // namespace lodestar
