#pragma once

#include <ros/ros.h>

#include <functional>

#include "lodestar/CorrectPallet.h"
#include "lodestar/FindPallets.h"
#include "lodestar/FreePlaces.h"
#include "lodestar/GetPallet.h"
#include "lodestar/PalletEventsAfter.h"
#include "lodestar/base/site/site.hpp"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"

namespace lodestar {

/// `pallets/get`, `find`, `correct`, `free_places` and `events_after`: what others ask of a tracker and tell it.
class PalletServices {
 public:
  /// @param tracker, site must outlive this @param on_change called with what a correction changed
  PalletServices(ros::NodeHandle& nh, PalletTracker& tracker, const Site& site,
                 std::function<void(const PalletTracker::Changes&)> on_change);

 private:
  bool get(GetPallet::Request& request, GetPallet::Response& response);
  bool find(FindPallets::Request& request, FindPallets::Response& response);
  bool correct(CorrectPallet::Request& request, CorrectPallet::Response& response);
  bool free(FreePlaces::Request& request, FreePlaces::Response& response);
  bool events_after(PalletEventsAfter::Request& request, PalletEventsAfter::Response& response);

  PalletTracker& tracker_;
  const Site& site_;
  std::function<void(const PalletTracker::Changes&)> on_change_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace lodestar
