#include "lodestar/sim/random.hpp"

#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

namespace lodestar::sim {
namespace {

constexpr double kPoissonIsNormalAbove = 50;

/// FNV-1a: std::hash differs between libraries.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 14695981039346656037ull;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return h;
}

/// SplitMix64's finalizer: neighbouring seeds give unrelated streams.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view stream)
    : engine_(mix(seed + 0x9e3779b97f4a7c15ull) ^ hash(stream)) {}

double Random::uniform(double low, double high) {
  return low + (high - low) * boost::random::uniform_01<double>()(engine_);
}

double Random::normal(double sigma) {
  return sigma == 0 ? 0.0 : sigma * boost::random::normal_distribution<double>()(engine_);
}

double Random::poisson(double mean) {
  if (mean <= 0) return 0;
  if (mean > kPoissonIsNormalAbove) return std::round(mean + normal(std::sqrt(mean)));
  return boost::random::poisson_distribution<int, double>(mean)(engine_);
}

bool Random::chance(double probability) { return probability > 0 && uniform(0, 1) < probability; }

std::size_t Random::index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

}  // namespace lodestar::sim
