#pragma once

#include <cstdio>
#include <string>

#include "lodestar/base/measurement/pallet.hpp"

namespace lodestar::test {

inline std::string uuid(int number) {
  char text[64];
  std::snprintf(text, sizeof text, "00000000-0000-4000-8000-%012d", number);
  return text;
}

inline Stamp at(double time_s) { return Stamp(std::chrono::seconds(1790000000)) + from_seconds(time_s); }

/// The n-th thing that happens: pallets 1 to 20 in turn are picked up and set down somewhere else.
inline PalletChange change(std::uint64_t n) {
  PalletChange change;
  change.sequence = n;
  change.life = uuid(700);
  change.stamp = at(static_cast<double>(n));
  const int pallet = static_cast<int>((n - 1) / 2 % 20) + 1;
  change.kind = n % 2 == 1 ? PalletChangeKind::kPick : PalletChangeKind::kDrop;
  change.pallet.id = uuid(pallet);
  if (pallet % 3 != 0) change.pallet.sscc = "106141412345678908";
  change.pallet.type = "epal";
  change.pallet.state = n % 2 == 1 ? PalletState::kOnFork : PalletState::kStanding;
  change.pallet.changed = change.stamp;
  const double step = static_cast<double>(n);
  change.pallet.T_map_pallet =
      Eigen::Translation3d(0.25 * step, 3.0, 0.144) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  change.pallet.covariance.diagonal() << 1e-4, 4e-4, 1e-6, 1e-6, 1e-6, 2.5e-5;
  change.pallet.zone = n % 2 == 1 ? "" : "A-" + std::to_string(pallet);
  return change;
}

/// Of what change(2) told.
inline PalletChange correction(PalletState state) {
  PalletChange out = change(3);
  out.kind = PalletChangeKind::kCorrection;
  out.pallet = change(2).pallet;
  out.pallet.state = state;
  out.pallet.zone = "A-2";
  out.reason = "stood one place further";
  out.corrects = 2;
  return out;
}

inline PalletChange uncertain() {
  PalletChange out = change(6);
  out.pallet.sscc.clear();
  out.pallet.state = PalletState::kUncertain;
  out.candidates = {uuid(3), uuid(4)};
  out.pallet.coasting = true;
  return out;
}

inline PalletChange gone() {
  PalletChange out = change(4);
  out.pallet.state = PalletState::kGone;
  out.pallet.zone = "DOCK-1";
  return out;
}

}  // namespace lodestar::test
