#include "lodestar/sensing/beacon/spot_filter.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

using Row = Eigen::Array<float, Patch::kSide, 1>;

/// Share of a Gaussian's light in each of the patch's columns (or rows), with derivatives by centre and width.
struct Profile {
  Row share, by_centre, by_sigma;

  Profile(float centre, float sigma) {
    using Edges = Eigen::Array<float, Patch::kSide + 3, 1>;  // the columns' edges, and what makes them whole vectors
    const Edges z = (Edges::LinSpaced(0, Patch::kSide + 2) - (Patch::kHalf + 0.5f) - centre) / sigma;
    const Edges bell = (-0.5f * z.square()).exp();
    // The integral of the bell, to 1.5e-7: Abramowitz and Stegun, Handbook of Mathematical Functions, 7.1.26.
    const Edges t = 1 / (1 + 0.3275911f * std::sqrt(0.5f) * z.abs());
    const Edges tail =
        0.5f * bell * t *
        (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
    const Edges below = (z > 0).select(1 - tail, tail);
    const Edges density = bell * static_cast<float>(1 / std::sqrt(2 * kPi));
    const Edges moment = density * z;
    share = difference(below);
    by_centre = -difference(density) / sigma;
    by_sigma = -difference(moment) / sigma;
  }

 private:
  template <class Edges>
  static Row difference(const Edges& at) {
    return at.template segment<Patch::kSide>(1) - at.template segment<Patch::kSide>(0);
  }
};

void outer(const Row& vertical, const Row& horizontal, Patch::Array& out) {
  for (int v = 0; v < Patch::kSide; ++v) out.segment<Patch::kSide>(v * Patch::kSide) = vertical[v] * horizontal;
}

template <class Pixel>
void copy(const Image& image, const Eigen::Vector2i& centre, Patch::Array& values) {
  for (int v = 0; v < Patch::kSide; ++v) {
    const Pixel* row = image.row<Pixel>(centre.y() - Patch::kHalf + v) + centre.x() - Patch::kHalf;
    for (int u = 0; u < Patch::kSide; ++u) values[v * Patch::kSide + u] = row[u];
  }
}

}  // namespace

bool Patch::read(const Image& image, const Eigen::Vector2i& centre_px) {
  if (centre_px.x() < kHalf || centre_px.y() < kHalf || centre_px.x() >= image.width_px - kHalf ||
      centre_px.y() >= image.height_px - kHalf) {
    return false;
  }
  centre = centre_px;
  if (image.bits == 8) {
    copy<std::uint8_t>(image, centre, values);
  } else {
    copy<std::uint16_t>(image, centre, values);
  }
  return true;
}

float Patch::clipped_radius(const Eigen::Vector2d& place, float white_level) const {
  if (values.maxCoeff() < white_level) return 0;
  double radius = 0;
  for (int i = 0; i < kPixels; ++i) {
    if (values[i] < white_level) continue;
    radius = std::max(radius, ((centre + offset(i)).cast<double>() - place).norm());
  }
  return static_cast<float>(radius);
}

Eigen::Vector2d Patch::centroid() const {
  float border = 0;
  for (int i = 0; i < kSide; ++i) {
    border += values[i] + values[kPixels - 1 - i] + values[i * kSide] + values[i * kSide + kSide - 1];
  }
  border /= 4 * kSide;
  const float floor = 0.5f * (border + values.maxCoeff());
  double light = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (int i = 0; i < kPixels; ++i) {
    if (values[i] <= floor) continue;
    light += values[i] - floor;
    moment += static_cast<double>(values[i] - floor) * offset(i).cast<double>();
  }
  return centre.cast<double>() + (light > 0 ? Eigen::Vector2d(moment / light) : Eigen::Vector2d::Zero());
}

void SpotFilter::design(const Eigen::Vector2d& place, const SpotShape& shape) {
  const Profile u(static_cast<float>(place.x()), shape.sigma_px), v(static_cast<float>(place.y()), shape.sigma_px);
  Eigen::Array<float, Patch::kPixels, 4> model;
  Patch::Array column, second;
  outer(v.share, u.share, column);
  model.col(0) = column;
  outer(v.share, u.by_centre, column);
  model.col(1) = column;
  outer(v.by_centre, u.share, column);
  model.col(2) = column;
  outer(v.by_sigma, u.share, column);
  outer(v.share, u.by_sigma, second);
  model.col(3) = column + second;

  Patch::Array weight = Patch::Array::Ones();
  if (shape.shot > 0) weight = 1.0f / (1.0f + shape.shot * model.col(0) / model.col(0).maxCoeff());
  if (shape.clipped_radius_px > 0) {
    for (int i = 0; i < Patch::kPixels; ++i)
      if ((Patch::offset(i).cast<double>() - place).norm() < shape.clipped_radius_px) weight[i] = 0;
  }

  // Gram-Schmidt under the weights: each column keeps what the background and the ones before it cannot explain.
  const float total = std::max(weight.sum(), 1e-6f);
  for (int c = 0; c < 4; ++c) {
    auto filter = filters_.col(c);
    filter = model.col(c) - (weight * model.col(c)).sum() / total;
    for (int before = 0; before < c; ++before) {
      // filters_ already holds weight * direction * variance.
      const float share = (filters_.col(before) * filter).sum();
      filter -= share * model.col(before);
    }
    model.col(c) = filter;
    const float power = std::max((weight * filter.square()).sum(), 1e-12f);
    variance_[c] = 1.0f / power;
    filter *= weight * variance_[c];
  }
}

SpotLight SpotFilter::read(const Patch& patch) const {
  const auto dot = [&](int c) { return (filters_.col(c) * patch.values).sum(); };
  return {dot(0), {dot(1), dot(2)}, dot(3)};
}

}  // namespace lodestar
