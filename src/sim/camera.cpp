#include "lodestar/sim/camera.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace lodestar::sim {
namespace {

constexpr std::size_t kBackgroundPixels = std::size_t{1} << 20;
constexpr double kFaintest_e = 0.02;   // a blob ends where its pixels fall below this
constexpr double kBlurStep_px = 0.25;  // the image moves by no more within a part of the exposure
constexpr int kMaxBlurSteps = 16;
constexpr double kTypicalRange_m = 5;  // of a ceiling light, to turn the camera's travel into pixels

std::shared_ptr<const CameraModel> make_model(const CameraIntrinsics& intrinsics) {
  auto model = CameraModel::create(intrinsics);
  if (!model) throw std::invalid_argument("camera: " + model.error());
  return *model;
}

double field(double value, double low, double high, const char* name) {
  if (!(value >= low && value <= high))
    throw std::invalid_argument(std::string("camera: ") + name + " is out of range");
  return value;
}

/// Share of a Gaussian that falls on each pixel of [first, first + share.size()) along one axis.
void pixel_shares(double centre_px, double sigma_px, int first, std::vector<double>& share) {
  const double scale = 1 / (std::sqrt(2.0) * sigma_px);
  double below = std::erf((first - 0.5 - centre_px) * scale);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double above = std::erf((first + static_cast<double>(i) + 0.5 - centre_px) * scale);
    share[i] = 0.5 * (above - below);
    below = above;
  }
}

}  // namespace

Camera::Camera(const CameraParams& params, std::uint64_t seed)
    : params_(params),
      model_(make_model(params.intrinsics)),
      noise_(seed, "camera noise"),
      timing_(seed, "camera timing") {
  if (params.bits != 8 && params.bits != 16) throw std::invalid_argument("camera: bits is neither 8 nor 16");
  field(params.rate_hz, 1e-3, 1e5, "rate_hz");
  field(params.exposure_s, 1e-6, 1 / params.rate_hz, "exposure_s");
  field(params.psf_sigma_px, 0.05, 50, "psf_sigma_px");
  field(params.half_field_rad, 0, 3.2, "half_field_rad");

  electrons_.assign(
      static_cast<std::size_t>(params.intrinsics.width_px) * static_cast<std::size_t>(params.intrinsics.height_px),
      0.f);
}

double Camera::next_due_s() const {
  return static_cast<double>(frame_ + 1) / params_.rate_hz * (1 + 1e-6 * params_.clock_drift_ppm);
}

Camera::Shot Camera::next_shot() {
  Shot shot;
  shot.middle_s = next_due_s() + timing_.normal(params_.jitter_s);
  shot.stamp_s = shot.middle_s + timing_.normal(params_.stamp_noise_s);
  shot.dropped = timing_.chance(params_.drop_probability);
  ++frame_;
  return shot;
}

double Camera::digitize(double electrons) {
  const double collected = std::min(noise_.poisson(electrons), params_.full_well_e);
  const double dn = params_.black_level_dn + params_.gain_dn_per_e * (collected + noise_.normal(params_.read_noise_e));
  return std::clamp(std::round(dn), 0.0, params_.bits == 8 ? 255.0 : 65535.0);
}

std::vector<Camera::Blob> Camera::blobs(const Scene& scene, const Pose& T_map_camera, double begin_s,
                                        double end_s) const {
  const RigidTransform T = T_map_camera(0.5 * (begin_s + end_s));
  const RigidTransform T_camera_map = T.inverse();
  std::vector<Blob> blobs;
  for (const Glow& glow : scene.seen_from(T.translation(), begin_s, end_s)) {
    const Eigen::Vector3d point = T_camera_map * glow.position_map;
    const double range = point.norm();
    const double off_axis = std::atan2(point.head<2>().norm(), point.z());
    if (off_axis > params_.half_field_rad) continue;
    if (std::any_of(params_.masts.begin(), params_.masts.end(), [&](const Mast& mast) { return mast.hides(point); }))
      continue;
    const auto projection = model_->project(point);
    if (!projection) continue;
    Blob blob;
    blob.pixel = projection->pixel;
    blob.electrons = glow.electrons_towards(T.translation()) / (range * range) *
                     std::pow(std::max(0.0, std::cos(off_axis)), params_.falloff_exponent);
    const double disc_px = 0.5 * glow.size_m / range * params_.intrinsics.fx_px;
    blob.sigma_px = std::hypot(params_.psf_sigma_px, disc_px);
    blobs.push_back(blob);
  }
  return blobs;
}

void Camera::collect(const Blob& blob) {
  const double peak = blob.electrons / (2 * blob.sigma_px * blob.sigma_px);
  if (peak <= kFaintest_e) return;
  const double radius = 1 + blob.sigma_px * std::sqrt(2 * std::log(peak / kFaintest_e));
  const int width = params_.intrinsics.width_px, height = params_.intrinsics.height_px;
  if (!(std::abs(blob.pixel.x()) < 1e6 && std::abs(blob.pixel.y()) < 1e6)) return;
  Patch patch{static_cast<int>(std::floor(blob.pixel.x() - radius)),
              static_cast<int>(std::floor(blob.pixel.y() - radius)),
              static_cast<int>(std::ceil(blob.pixel.x() + radius)) + 1,
              static_cast<int>(std::ceil(blob.pixel.y() + radius)) + 1};
  patch = {std::max(patch.u0, 0), std::max(patch.v0, 0), std::min(patch.u1, width), std::min(patch.v1, height)};
  if (patch.u0 >= patch.u1 || patch.v0 >= patch.v1) return;

  std::vector<double> u_share(static_cast<std::size_t>(patch.u1 - patch.u0));
  std::vector<double> v_share(static_cast<std::size_t>(patch.v1 - patch.v0));
  pixel_shares(blob.pixel.x(), blob.sigma_px, patch.u0, u_share);
  pixel_shares(blob.pixel.y(), blob.sigma_px, patch.v0, v_share);
  for (int v = patch.v0; v < patch.v1; ++v) {
    float* row = &electrons_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width)];
    const double row_electrons = blob.electrons * v_share[static_cast<std::size_t>(v - patch.v0)];
    for (int u = patch.u0; u < patch.u1; ++u)
      row[u] += static_cast<float>(row_electrons * u_share[static_cast<std::size_t>(u - patch.u0)]);
  }
  patches_.push_back(patch);
}

void Camera::fill_background() {
  const std::size_t bytes = static_cast<std::size_t>(params_.bits / 8);
  background_.resize((kBackgroundPixels + static_cast<std::size_t>(params_.intrinsics.width_px)) * bytes);
  for (std::size_t i = 0; i < background_.size(); i += bytes) {
    const auto value = static_cast<std::uint16_t>(digitize(params_.ambient_e));
    if (bytes == 1)
      background_[i] = static_cast<std::uint8_t>(value);
    else
      std::memcpy(&background_[i], &value, bytes);
  }
}

void Camera::develop(std::uint8_t* data) {
  const auto width = static_cast<std::size_t>(params_.intrinsics.width_px);
  const auto height = static_cast<std::size_t>(params_.intrinsics.height_px);
  const std::size_t bytes = static_cast<std::size_t>(params_.bits / 8);
  if (background_.empty()) fill_background();
  for (std::size_t v = 0; v < height; ++v)
    std::memcpy(data + v * width * bytes, &background_[noise_.index(kBackgroundPixels) * bytes], width * bytes);

  for (const Patch& patch : patches_)
    for (int v = patch.v0; v < patch.v1; ++v)
      for (int u = patch.u0; u < patch.u1; ++u) {
        const std::size_t i = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
        if (electrons_[i] == 0.f) continue;  // of an overlapping patch, done already
        const auto value = static_cast<std::uint16_t>(digitize(params_.ambient_e + static_cast<double>(electrons_[i])));
        if (bytes == 1)
          data[i] = static_cast<std::uint8_t>(value);
        else
          std::memcpy(data + i * bytes, &value, bytes);
        electrons_[i] = 0.f;
      }
  patches_.clear();
}

Image Camera::expose(const Scene& scene, const Pose& T_map_camera, double middle_s) {
  const double begin = middle_s - 0.5 * params_.exposure_s;
  const RigidTransform T_first = T_map_camera(begin), T_last = T_map_camera(begin + params_.exposure_s);
  const double travel_px =
      params_.intrinsics.fx_px * (so3_log(T_first.linear().transpose() * T_last.linear()).norm() +
                                  (T_last.translation() - T_first.translation()).norm() / kTypicalRange_m);
  const int steps = std::clamp(static_cast<int>(std::ceil(travel_px / kBlurStep_px)), 1, kMaxBlurSteps);
  const double step = params_.exposure_s / steps;
  for (int i = 0; i < steps; ++i)
    for (const Blob& blob : blobs(scene, T_map_camera, begin + i * step, begin + (i + 1) * step)) collect(blob);

  Image image;
  image.width_px = params_.intrinsics.width_px;
  image.height_px = params_.intrinsics.height_px;
  image.bits = params_.bits;
  image.stride_bytes = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(params_.bits / 8);
  auto pixels =
      std::make_shared<std::vector<std::uint8_t>>(image.stride_bytes * static_cast<std::size_t>(image.height_px));
  develop(pixels->data());
  image.data = pixels->data();
  image.owner = pixels;
  return image;
}

}  // namespace lodestar::sim
