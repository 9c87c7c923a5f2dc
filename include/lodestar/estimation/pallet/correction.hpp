#pragma once

#include <optional>
#include <string>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/site/zone.hpp"
#include "lodestar/estimation/pallet/fork.hpp"
#include "lodestar/estimation/pallet/pallet_ledger.hpp"

namespace lodestar {

/// What a person or the warehouse's software knows better of one pallet. What is left out stays as it is; its doubt, if
/// any, ends: with nothing but the id the pallet is confirmed as it is told. One that is gone stays gone, unless it
/// is told to stand somewhere else than in a dock zone.
struct PalletCorrection {
  Stamp stamp;
  std::string id;                  ///< of the pallet that is told wrong, or asked for
  std::string same_as;             ///< it is this pallet; what was told as `id` never was another
  std::string sscc;                ///< its label
  std::string type;                ///< as the vehicle file names the sizes
  bool gone = false;               ///< it is no longer on the site
  std::optional<PalletPose> pose;  ///< it stands here
  std::string reason;
};

constexpr std::size_t kLongestReason = 1000;  ///< octets: it goes out with each document of the correction

/// Why a correction was not taken: nothing of it was.
enum class CorrectionFault {
  kUnknownPallet,  ///< no pallet has `id`
  kUnknownSame,    ///< no other pallet has `same_as`, or the fork carries that one and not this
  kSscc,           ///< not 18 digits with a right check digit
  kSsccTaken,      ///< another pallet has this label: say `same_as`
  kSeenSince,      ///< `id` is gone, and `same_as` stood or was carried since
  kTwoLabels,      ///< `id` and `same_as` have labels, and different ones: say which is right
  kType,           ///< the vehicle file has no such size
  kPose,           ///< nothing can stand there, or so unsurely (is_possible), or so far from upright
  kReason,         ///< longer than kLongestReason
  kOnFork,         ///< the fork carries it: neither pose nor gone can be told
};
const char* name(CorrectionFault fault);

/// Writes the correction into the ledger, or says why not.
std::optional<CorrectionFault> correct(PalletLedger& ledger, const std::vector<Zone>& zones,
                                       const PalletCorrection& correction);

}  // namespace lodestar
