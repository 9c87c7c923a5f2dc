#pragma once

#include <ros/ros.h>

#include <functional>

#include "lodestar/CorrectPallet.h"
#include "lodestar/FindPallets.h"
#include "lodestar/FreePlaces.h"
#include "lodestar/GetPallet.h"
#include "lodestar/base/site/zone.hpp"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"

namespace lodestar {

/// `pallets/get`, `find`, `correct` and `free_places`: what others ask of a tracker and tell it.
class PalletServices {
 public:
  /// @param on_change called with what a correction changed
  PalletServices(ros::NodeHandle& nh, PalletTracker& tracker, const std::vector<Zone>& zones,
                 std::function<void(const PalletTracker::Changes&)> on_change);

 private:
  bool get(GetPallet::Request& request, GetPallet::Response& response);
  bool find(FindPallets::Request& request, FindPallets::Response& response);
  bool correct(CorrectPallet::Request& request, CorrectPallet::Response& response);
  bool free(FreePlaces::Request& request, FreePlaces::Response& response);

  PalletTracker& tracker_;
  std::vector<Zone> zones_;
  std::function<void(const PalletTracker::Changes&)> on_change_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace lodestar
