#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <string_view>

namespace lodestar::sim {

/// One stream of random numbers. Boost's generators and distributions give the same numbers on every platform, so a
/// seed names a run. Each sensor draws from a stream of its own: adding one leaves the others' samples as they were.
class Random {
 public:
  /// @param stream tells streams of one seed apart, e.g. "imu"
  Random(std::uint64_t seed, std::string_view stream);

  double uniform(double low, double high);
  double normal(double sigma);
  /// Number of events; the normal approximation above 50, where its error is below the shot noise's own by far.
  double poisson(double mean);
  bool chance(double probability);
  /// In [0, count).
  std::size_t index(std::size_t count);

 private:
  boost::random::mt19937_64 engine_;
};

}  // namespace lodestar::sim
