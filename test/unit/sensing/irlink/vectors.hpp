#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// Key of the signed vectors.
constexpr std::array<std::uint8_t, 16> kVectorKey = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// A worked example of optical_link.md: an announcement and the octets that it is sent as.
struct Vector {
  Announcement announcement;
  std::array<std::uint8_t, RawIrFrame::kOctets> octets{};
};

inline std::vector<Vector> read_vectors() {
  std::vector<Vector> vectors;
  std::ifstream file(LODESTAR_SOURCE_DIR "/test/data/optical_link_vectors.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    Vector vector;
    Announcement& a = vector.announcement;
    int slot = 0, status = 0;
    double x_mm = 0, y_mm = 0, z_mm = 0;
    std::string tones, colon, hex;
    fields >> a.beacon.value >> slot >> a.superframe >> x_mm >> y_mm >> z_mm >> tones >> status >> a.is_signed >>
        colon >> hex;
    if (!fields || hex.size() != 2 * vector.octets.size()) return {};
    a.slot = static_cast<std::uint8_t>(slot);
    a.position_map = Eigen::Vector3d(x_mm, y_mm, z_mm) * 1e-3;
    std::istringstream indices(tones);
    for (std::string index; std::getline(indices, index, ',');) a.tones.insert(std::stoi(index));
    a.led_fault = (status & 1) != 0;
    a.supply_low = (status & 2) != 0;
    a.surveyed = (status & 4) != 0;
    for (std::size_t i = 0; i < vector.octets.size(); ++i)
      vector.octets[i] = static_cast<std::uint8_t>(std::stoi(hex.substr(2 * i, 2), nullptr, 16));
    vectors.push_back(vector);
  }
  return vectors;
}

}  // namespace lodestar
