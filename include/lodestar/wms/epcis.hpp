#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/wms/clock.hpp"

namespace lodestar {

/// Who tells the events, and where.
struct EpcisParams {
  std::string giai;                         ///< of the truck
  std::string gln;                          ///< of the site; a zone's code extends it
  std::string coordinate_reference_system;  ///< URI of the site's map frame
};

/// What becomes of one change in EPCIS 2.0, as far as it is known when it happens: JSON, ours alone.
///
/// Pick: AssociationEvent ADD, parent the truck's GIAI, child the pallet. Drop: AssociationEvent DELETE, then
/// ObjectEvent OBSERVE with the standing pose as sensor element. Correction: ObjectEvent OBSERVE; where a pallet
/// without a label is gone by it, DELETE (decommissioning). The pallet is named by its SSCC, where none was read by
/// urn:uuid. Text that is not UTF-8 is mended; a label that is no SSCC must not get here.
std::string epcis_draft(const EpcisParams& params, const PalletChange& change);

/// What is only known when the change is handed over for the first time.
struct HandOver {
  std::string stream;             ///< UUID of the store that numbers the documents
  std::uint64_t sequence = 0;     ///< of the document
  Stamp now;                      ///< wall clock
  WallClock clock;                ///< by which the event was stamped
  std::vector<std::string> told;  ///< of a correction: the documents about its pallet that are known, oldest first
};

/// The EPCISDocument of a draft: final, to be kept and sent again byte for byte. What a correction shows to have been
/// told wrong, under another name or at another place, is told again word for word with an errorDeclaration, whose
/// correctiveEventIDs name the event that replaces it (EPCIS 2.0, section 7.4.1.2). Those follow, of the same kind and
/// time, then the correction's own event. Nothing else is declared wrong.
std::string epcis_document(const std::string& draft, const HandOver& hand_over);

}  // namespace lodestar
