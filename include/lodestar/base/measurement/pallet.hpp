#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// What becomes of a pallet.
enum class PalletState : std::uint8_t {
  kOnFork = 1,     ///< of this truck
  kStanding = 2,   ///< where it was set down
  kGone = 3,       ///< left the site by a dock zone, or proved to be another pallet that is known
  kUncertain = 4,  ///< it, or where it is, is in doubt: a person is asked, nothing is guessed
};

/// One pallet as this truck knows it (lodestar/PalletEntry on the wire).
struct Pallet {
  std::string id;    ///< RFC 4122 UUID in lower case, given when it was first met; never changes
  std::string sscc;  ///< GS1 SSCC, 18 digits with a valid check digit; empty: its label was never read
  std::string type;  ///< as the vehicle file names the pallet sizes
  PalletState state = PalletState::kStanding;
  Stamp changed;                                             ///< when it came into this state
  RigidTransform T_map_pallet = RigidTransform::Identity();  ///< of the middle of its underside; x along its length
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< as PoseEstimate's
  int level = 0;          ///< 0: on the floor; else how many pallets or rack levels are below
  std::string zone;       ///< code of the site's zone that it stands in; empty: in none
  bool coasting = false;  ///< localization had no beacon then, or did not say: the covariance says how good it is
};

enum class PalletChangeKind : std::uint8_t {
  kPick = 1,        ///< lifted by the fork
  kDrop = 2,        ///< set down
  kCorrection = 3,  ///< a person, the warehouse's software or a label read later knew better
};

/// What happened to one pallet, with the pallet as it is afterwards (lodestar/PalletEvent on the wire).
struct PalletChange {
  std::uint64_t sequence = 0;  ///< 1 for this truck's first; without gaps
  std::string life;            ///< UUID of the tracker's run that gave the number: with it no number comes twice
  Stamp stamp;                 ///< when it happened
  PalletChangeKind kind = PalletChangeKind::kPick;
  Pallet pallet;
  std::vector<std::string> candidates;  ///< ids of the pallets that it may be, most likely first; empty: no doubt
  std::string reason;                   ///< of a correction, in the words of who made it
  std::uint64_t corrects = 0;           ///< the sequence number of the event that a correction calls wrong; 0: none
};

}  // namespace lodestar
