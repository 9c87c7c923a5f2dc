#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/sighting.hpp"

namespace lodestar {

struct BeaconDetectorParams {
  std::vector<double> tone_table_hz;
  int window_frames = 30;
};

/// Why a frame led to no result.
enum class FrameDrop {
  kNoPixels,      ///< no data, or a size of zero
  kFormat,        ///< neither mono8 nor mono16, or a stride below the width
  kSize,          ///< not the size of the calibration
  kDuplicate,     ///< the stamp of the frame before
  kBackwards,     ///< older than the frame before
  kCount
};
const char* name(FrameDrop reason);

class BeaconDetector {
 public:
  explicit BeaconDetector(const BeaconDetectorParams& params);
  const DropCounts<FrameDrop>& drops() const { return drops_; }

 private:
  DropCounts<FrameDrop> drops_;
};

}  // namespace lodestar
