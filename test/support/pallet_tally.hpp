#pragma once

#include <algorithm>
#include <cmath>

#include "lodestar/estimation/pallet/fork.hpp"

namespace lodestar::test {

/// What a tracker told, held against the truth.
struct PalletTally {
  int moves = 0, stacks = 0, unread = 0;
  int identified = 0, wrong = 0, asked = 0;  ///< pallets lifted: known, mistaken, in doubt
  int set_down = 0;
  double error_sum_m = 0, error_max_m = 0, yaw_error_sum_rad = 0;
  double nees_sum = 0;  ///< of x, y, z, yaw

  /// @param error told minus true pose of a pallet that was set down
  void add(const PoseDifference& error) {
    const double error_m = error.value.head<2>().norm();
    ++set_down;
    error_sum_m += error_m;
    error_max_m = std::max(error_max_m, error_m);
    yaw_error_sum_rad += std::abs(error.value[3]);
    nees_sum += error.distance2();
  }

  PalletTally& operator+=(const PalletTally& other) {
    moves += other.moves;
    stacks += other.stacks;
    unread += other.unread;
    identified += other.identified;
    wrong += other.wrong;
    asked += other.asked;
    set_down += other.set_down;
    error_sum_m += other.error_sum_m;
    error_max_m = std::max(error_max_m, other.error_max_m);
    yaw_error_sum_rad += other.yaw_error_sum_rad;
    nees_sum += other.nees_sum;
    return *this;
  }

  int lifted() const { return identified + wrong + asked; }
  double mean_error_m() const { return error_sum_m / set_down; }
  double mean_yaw_error_rad() const { return yaw_error_sum_rad / set_down; }
  double mean_nees() const { return nees_sum / set_down; }
};

}  // namespace lodestar::test
