#include "lodestar/ros/convert/beacon_table.hpp"

#include "tones.hpp"

namespace lodestar {

std::vector<BeaconEntry> beacon_table_message(const BeaconTable& table, Stamp now) {
  std::vector<BeaconEntry> rows;
  for (const auto& [id, entry] : table.entries()) {
    BeaconEntry row;
    row.beacon_id = id.value;
    row.position.x = entry.beacon.position_map.x();
    row.position.y = entry.beacon.position_map.y();
    row.position.z = entry.beacon.position_map.z();
    row.tones = tones_message(entry.beacon.tones);
    row.slot = static_cast<std::uint8_t>(entry.beacon.slot);
    if (entry.in_site_file) row.source |= BeaconEntry::SITE_FILE;
    if (entry.heard > 0) row.source |= BeaconEntry::ANNOUNCEMENT;
    row.conflict = entry.conflict;
    row.heard = entry.heard;
    row.age_s = entry.last ? seconds(now - entry.last->stamp) : -1;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace lodestar
