#include "lodestar/estimation/naming/possible_names.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Beacon beacon(std::uint32_t id, double x_m, ToneSet tones) {
  Beacon b;
  b.id = {id};
  b.position_map << x_m, 0, 8;
  b.tones = tones;
  return b;
}

Sighting blob(ToneSet tones) {
  Sighting s;
  s.tones = tones;
  return s;
}

const ToneSet kA{0, 1}, kB{0, 2}, kC{1, 2};

/// A and B hang side by side at two ends of the plant, C at one of them alone.
const std::vector<Beacon> kPlant = {beacon(1, 0, kA), beacon(2, 5, kB), beacon(11, 100, kA), beacon(12, 105, kB),
                                    beacon(13, 110, kC)};

std::vector<std::optional<BeaconId>> names(const Sightings& s) {
  std::vector<std::optional<BeaconId>> out;
  for (const Sighting& sighting : s.sightings) out.push_back(sighting.beacon);
  return out;
}

TEST(PossibleNames, AreAsManyAsThePlacesOfTheRarestCode) {
  const auto ways = possible_names({{}, {blob(kA), blob(kB)}}, kPlant);
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_EQ(names(ways[0]), (std::vector<std::optional<BeaconId>>{BeaconId{1}, BeaconId{2}}));
  EXPECT_EQ(names(ways[1]), (std::vector<std::optional<BeaconId>>{BeaconId{11}, BeaconId{12}}));
}

TEST(PossibleNames, OneCodeThatIsThereOnceSettlesAll) {
  const auto ways = possible_names({{}, {blob(kA), blob(kC), blob(kB)}}, kPlant);
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_EQ(names(ways[0]), (std::vector<std::optional<BeaconId>>{BeaconId{11}, BeaconId{13}, BeaconId{12}}));
}

TEST(PossibleNames, BlobsThatShareACodeStayUnnamed) {
  const auto ways = possible_names({{}, {blob(kA), blob(kA), blob(kC)}}, kPlant);
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_EQ(names(ways[0]), (std::vector<std::optional<BeaconId>>{std::nullopt, std::nullopt, BeaconId{13}}));
}

TEST(PossibleNames, NoBeaconsCodeNoName) {
  EXPECT_TRUE(possible_names({{}, {blob(ToneSet{5})}}, kPlant).empty());
  EXPECT_TRUE(possible_names({}, kPlant).empty());
}

}  // namespace
}  // namespace lodestar
