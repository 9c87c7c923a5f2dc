#pragma once

#include <optional>

#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/line/arrivals.hpp"
#include "lodestar/line/detection_stage.hpp"
#include "lodestar/line/fusion_stage.hpp"
#include "lodestar/line/pose_stage.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"
#include "lodestar/sensing/irlink/ir_demodulator.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// What one stage of the line needs of site, vehicle and camera rate. Every program that runs a stage, nodelet or tool,
/// takes its parameters from here, so that all of them do the same.
struct LineParams {
  BeaconDetectorParams detector;
  BeaconNamerParams namer;
  PoseSolverParams solver;
  TiltFilterParams tilt;
  PoseFilterParams filter;
  double calibration_sigma_px = 0.3;
  bool use_sightings = true;  ///< tightly coupled; off: the filter is fed with fixes alone
  DiodeArray diodes;          ///< of the IR receiver
  Duration heard_for{};       ///< how long after its announcement a beacon counts as heard
};

/// @param frame_rate_hz of the camera, for the detector's window where neither file fixes it; none for who runs other
/// stages alone
LineParams line_params(const Site& site, const Vehicle& vehicle, std::optional<double> frame_rate_hz = std::nullopt);

/// How long a beacon counts as heard: a lost frame or two must not silence it.
Duration heard_for(const Link& link);

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

  /// The accepted announcement, or why the frame was dropped. While the camera is blind it makes a coarse fix.
  Result<Announcement, IrDrop> add_ir_frame(const RawIrFrame& frame);
  /// Frames from the samples of the other kind of receiver; each goes through add_ir_frame.
  void add_ir_samples(const IrSampleBlock& samples);

  Result<Outcome, FrameDrop> process(const Image& image);

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
