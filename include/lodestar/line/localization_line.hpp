#pragma once

#include <optional>

#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/line/arrivals.hpp"
#include "lodestar/line/detection_stage.hpp"
#include "lodestar/line/fusion_stage.hpp"
#include "lodestar/line/line_params.hpp"
#include "lodestar/line/pose_stage.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"
#include "lodestar/sensing/irlink/ir_demodulator.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// The whole optical line in one object, for replay and simulation: the same stages that the nodelets run.
/// Calls come in the order of reception.
class LocalizationLine {
 public:
  /// What one image led to.
  struct Outcome {
    Sightings sightings;
    std::optional<Fix> fix;
    std::optional<StateEstimate> estimate;  ///< at the image's stamp; empty before the first fix
  };

  LocalizationLine(const Site& site, const LineParams& params);

  void set_camera(const CameraMount& camera);
  /// Where the inertial sensor sits, in base_link (m).
  void set_imu(const Eigen::Vector3d& imu_position_base);
  /// Where the photodiodes sit; without it no direction is read from their levels.
  void set_ir_array(const RigidTransform& T_base_ir);
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);

  /// The accepted announcement, or why the frame was dropped. While the camera makes no fix one a second makes a
  /// coarse fix.
  Result<Announcement, IrDrop> add_ir_frame(const RawIrFrame& frame);
  /// Frames from the samples of the other kind of receiver; each goes through add_ir_frame.
  void add_ir_samples(const IrSampleBlock& samples);

  Result<Outcome, FrameDrop> process(const Image& image);

  /// Somebody has looked after a beacon that was left out: what it last said is right. False: it was never heard.
  /// @param stamp when he did; what is found out later leaves the beacon out again
  bool confirm(BeaconId id, Stamp stamp);

  void reset();

  const BeaconTable& beacon_table() const { return table_; }
  const DetectionStage& detection() const { return detection_; }
  const PoseStage& pose() const { return pose_; }
  const FusionStage& fusion() const { return fusion_; }

 private:
  void share_beacons();
  bool plausible(const Announcement& announcement) const;
  void fix_by_arrivals(Stamp stamp);

  Duration heard_for_;
  IrDemodulator demodulator_;
  IrFrameDecoder decoder_;
  BeaconTable table_;
  Arrivals arrivals_;
  DetectionStage detection_;
  PoseStage pose_;
  FusionStage fusion_;
};

}  // namespace lodestar
