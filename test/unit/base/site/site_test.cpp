#include "lodestar/base/site/site.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "site_text.hpp"

namespace lodestar {
namespace {

const char kGood[] = R"(site: {name: hall-12, frame_id: map}
link: {bit_rate_bps: 19200, slot_s: 0.025, slot_count: 32, key_file: ""}
tone_table_hz: [6, 8, 10, 12, 14, 16, 24, 26]
beacons:
  - {id: 1, position_m: [3.50, 3.75, 8.02], tones_hz: [6, 10], slot: 0, waveform: sine, sigma_m: 0.02}
  - id: 4294967295
    position_m: [10, -3.75, 8]
    tones_hz: [26.0]
    slot: 31
    waveform: square
)";

/// The good file with one piece of text replaced, its faults as printed.
std::string faults_with(const std::string& from, const std::string& to) {
  return faults_of(parse_site(replaced(kGood, from, to), "s.yaml"));
}

TEST(Site, reads_every_key) {
  const auto site = parse_site(kGood, "s.yaml");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  EXPECT_EQ(site->name, "hall-12");
  EXPECT_EQ(site->frame_id, "map");
  EXPECT_EQ(site->link.slot_count, 32);
  EXPECT_FALSE(site->link.key);
  EXPECT_EQ(site->tone_table_hz.size(), 8u);
  ASSERT_EQ(site->beacons.size(), 2u);
  EXPECT_EQ(site->beacons[0].id, BeaconId{1});
  EXPECT_EQ(site->beacons[0].position_map, Eigen::Vector3d(3.5, 3.75, 8.02));
  EXPECT_EQ(site->beacons[0].tones, (ToneSet{0, 2}));
  EXPECT_EQ(site->beacons[0].slot, 0);
  EXPECT_EQ(site->beacons[0].waveform, Waveform::kSine);
  EXPECT_EQ(site->beacons[0].sigma_m, 0.02);
  EXPECT_EQ(site->beacons[1].id, BeaconId{4294967295u});
  EXPECT_EQ(site->beacons[1].tones, ToneSet{7});
  EXPECT_EQ(site->beacons[1].waveform, Waveform::kSquare);
  EXPECT_EQ(site->beacons[1].sigma_m, 0.01);
}

TEST(Site, needs_a_name_and_a_tone_table_only) {
  const auto site = parse_site("site: {name: x}\ntone_table_hz: [5]\n", "s.yaml");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  EXPECT_EQ(site->frame_id, "map");
  EXPECT_EQ(site->link.bit_rate_bps, 19200);
  EXPECT_EQ(site->link.slot_s, 0.025);
  EXPECT_EQ(site->link.slot_count, 32);
  EXPECT_TRUE(site->beacons.empty());
  EXPECT_TRUE(parse_site("site: {name: x}\ntone_table_hz: [5]\nbeacons:\nlink:\n", "s.yaml").ok());
  EXPECT_TRUE(parse_site("site: {name: x}\ntone_table_hz: [5]\nbeacons: []\n", "s.yaml").ok());
}

TEST(Site, says_where_and_what_the_way_out_is) {
  EXPECT_EQ(faults_with("slot: 31", "slot: 32"), "s.yaml:9: beacons[1].slot is 32: give a whole number from 0 to 31\n");
}

struct Wrong {
  const char* from;
  const char* to;
  const char* fault;  ///< the whole text after "s.yaml:"
};

class WrongSite : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSite, has_this_fault_and_no_other) {
  EXPECT_EQ(faults_with(GetParam().from, GetParam().to), std::string("s.yaml:") + GetParam().fault + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    Keys, WrongSite,
    testing::Values(
        Wrong{"slot: 0,", "slot: 0, colour: red,",
              "5: beacons[0]: key \"colour\" is unknown here: known are id, position_m, tones_hz, slot, waveform, "
              "sigma_m"},
        Wrong{"sigma_m: 0.02", "sigma: 0.02", "5: beacons[0]: key \"sigma\" has no unit: did you mean \"sigma_m\"?"},
        Wrong{"sigma_m: 0.02", "sigma_mm: 20",
              "5: beacons[0]: key \"sigma_mm\" has another unit: did you mean \"sigma_m\"?"},
        Wrong{"waveform: square", "wavefrom: square",
              "10: beacons[1]: key \"wavefrom\" is unknown: did you mean \"waveform\"?"},
        Wrong{"frame_id: map", "frame: map", "1: site: key \"frame\" is unknown: did you mean \"frame_id\"?"},
        Wrong{"beacons:\n", "racks: []\nbeacons:\n",
              "4: key \"racks\" is unknown here: known are site, link, tone_table_hz, beacons, zones"},
        Wrong{"    slot: 31\n", "", "6: beacons[1] has no \"slot\": add it"},
        Wrong{"name: hall-12, ", "", "1: site has no \"name\": add it"},
        Wrong{"site: {name: hall-12, frame_id: map}\n", "", "1: the file has no \"site\": add it"},
        Wrong{"    slot: 31\n", "    slot: 31\n    slot: 30\n",
              "10: beacons[1]: key \"slot\" is there twice (first on line 9): keep one"},
        Wrong{"site: {", "[a, b]: c\nsite: {", "1: a key is a list: give one word"}));

INSTANTIATE_TEST_SUITE_P(
    Values, WrongSite,
    testing::Values(
        Wrong{"8.02]", ".nan]", "5: beacons[0].position_m[2] is \".nan\": give a finite number"},
        Wrong{"8.02]", "-.INF]", "5: beacons[0].position_m[2] is \"-.INF\": give a finite number"},
        Wrong{"8.02]", "8.02 m]",
              "5: beacons[0].position_m[2] is \"8.02 m\": give a plain number; the unit is in the key's name"},
        Wrong{"8.02]", "1e999]",
              "5: beacons[0].position_m[2] is \"1e999\": give a plain number; the unit is in the key's name"},
        Wrong{"8.02]", "\"8.02\"]", "5: beacons[0].position_m[2] is \"8.02\": it is text; take the quotes off"},
        Wrong{"8.02]", "[8.02]]", "5: beacons[0].position_m[2] is a list: give one number"},
        Wrong{", 8.02]", "]", "5: beacons[0].position_m has 2 numbers: give 3"},
        Wrong{"[3.50, 3.75, 8.02]", "8.02", "5: beacons[0].position_m is \"8.02\": give a list of 3 numbers"},
        Wrong{"[10, -3.75, 8]", "[3e6, -3.75, 8]",
              "7: beacons[1].position_m[0] is 3000000: give a number from -2147483.647 to 2147483.647"},
        Wrong{"id: 1,", "id: 0,", "5: beacons[0].id is 0: give a whole number from 1 to 4294967295"},
        Wrong{"id: 1,", "id: 1.0,", "5: beacons[0].id is \"1.0\": give a whole number in decimal digits"},
        Wrong{"id: 1,", "id: 4294967296,", "5: beacons[0].id is 4294967296: give a whole number from 1 to 4294967295"},
        Wrong{"id: 1,", "id: 99999999999999999999,",
              "5: beacons[0].id is \"99999999999999999999\": give a whole number in decimal digits"},
        Wrong{"id: 1,", "id: 4294967295,",
              "6: id 4294967295 is taken by the beacon on line 5: give each beacon its own"},
        Wrong{"slot: 0,", "slot: -1,", "5: beacons[0].slot is -1: give a whole number from 0 to 31"},
        Wrong{"slot: 0,", "slot: ,", "5: beacons[0].slot is empty: give one number"},
        Wrong{"sigma_m: 0.02", "sigma_m: 0", "5: beacons[0].sigma_m is 0: give a number above 0 and up to 1"},
        Wrong{"waveform: sine", "waveform: triangle", "5: beacons[0].waveform is \"triangle\": give sine or square"},
        Wrong{"waveform: sine", "waveform: square",
              "5: beacons[0].waveform is square with 2 tones: give one tone, or make it sine"},
        Wrong{"frame_id: map", "frame_id: /map",
              "1: site.frame_id is \"/map\": give a tf frame without slash or space, as map"},
        Wrong{"name: hall-12", "name: \"\"", "1: site.name is empty: give the site a name"},
        Wrong{"name: hall-12", "name: []",
              "1: site.name is a list: give one text\n"
              "s.yaml:1: site.name is empty: give the site a name"},
        Wrong{"site: {name: hall-12, frame_id: map}", "site: hall-12",
              "1: site is \"hall-12\": give keys with values"}));

INSTANTIATE_TEST_SUITE_P(
    Tones, WrongSite,
    testing::Values(
        Wrong{"[6, 10]", "[6, 11]", "5: beacons[0].tones_hz: 11 is not in tone_table_hz; the nearest there is 10"},
        Wrong{"[6, 10]", "[6, 6.0]", "5: beacons[0].tones_hz: 6 is there twice: give each tone once"},
        Wrong{"[6, 10]", "[]", "5: beacons[0].tones_hz has 0 numbers: give 1 to 3"},
        Wrong{"[6, 10]", "[6, 8, 10, 12]", "5: beacons[0].tones_hz has 4 numbers: give 1 to 3"},
        Wrong{"[6, 10]", "6", "5: beacons[0].tones_hz is \"6\": give a list of 1 to 3 numbers"},
        Wrong{"24, 26]", "24, 26, 8]", "3: tone_table_hz has 8 twice: give each tone once"},
        Wrong{"24, 26]", "24, 26,\n  -3]", "4: tone_table_hz[8] is -3: give a number above 0 and up to 1000"},
        Wrong{"[6, 8, 10, 12, 14, 16, 24, 26]", "[]", "3: tone_table_hz has 0 numbers: give 1 to 32"}));

INSTANTIATE_TEST_SUITE_P(
    Link, WrongSite,
    testing::Values(
        Wrong{"slot_s: 0.025", "slot_s: 0.020",
              "2: link.slot_s is too little: a frame of 400 bits takes 0.02083333333 s at 19200 bit/s and slot_s is "
              "0.02; raise either"},
        Wrong{"bit_rate_bps: 19200, slot_s: 0.025", "bit_rate_bps: 9600",
              "2: link.bit_rate_bps is too little: a frame of 400 bits takes 0.04166666667 s at 9600 bit/s and slot_s "
              "is 0.025; raise either"},
        Wrong{"bit_rate_bps: 19200", "bit_rate_bps: 0",
              "2: link.bit_rate_bps is 0: give a number from 100 to 10000000"},
        Wrong{"slot_s: 0.025", "slot: 0.025", "2: link: key \"slot\" has no unit: did you mean \"slot_s\"?"},
        Wrong{"slot_count: 32", "slot_count: 257", "2: link.slot_count is 257: give a whole number from 1 to 256"},
        Wrong{"key_file: \"\"", "key_file: no/such.key",
              "2: link.key_file \"no/such.key\" cannot be read: check the path and the rights"}));

INSTANTIATE_TEST_SUITE_P(
    Clashes, WrongSite,
    testing::Values(
        Wrong{"slot: 31", "slot: 0",
              "9: slot 0 is also that of beacon 1 on line 5, 9.92 m away: within 30 m give each beacon its own"},
        Wrong{"tones_hz: [26.0]\n    slot: 31\n    waveform: square", "tones_hz: [10, 6]\n    slot: 31",
              "8: the code (tones_hz) is also that of beacon 1 on line 5, 9.92 m away: within 30 m give each beacon "
              "its own"},
        Wrong{"[10, -3.75, 8]\n    tones_hz: [26.0]\n    slot: 31",
              "[33.5, 3.75, 8.02]\n    tones_hz: [26]\n    slot: 0",
              "9: slot 0 is also that of beacon 1 on line 5, 30 m away: within 30 m give each beacon its own"}));

TEST(Site, allows_reuse_of_code_and_slot_beyond_30_m) {
  EXPECT_EQ(faults_with("[10, -3.75, 8]\n    tones_hz: [26.0]\n    slot: 31\n    waveform: square",
                        "[33.51, 3.75, 8.02]\n    tones_hz: [6, 10]\n    slot: 0"),
            "");
}

TEST(Site, lists_all_faults_at_once_in_the_order_of_lines) {
  const std::string text =
      replaced(replaced(replaced(replaced(kGood, "id: 1,", "id: x,"), "slot: 31", "slot: 99"), "6, 8,", "6, 8, 8,"),
               "slot_count: 32", "slot_count: 0");
  const auto site = parse_site(text, "s.yaml");
  ASSERT_FALSE(site.ok());
  std::vector<int> lines;
  for (const Fault& fault : site.error()) lines.push_back(fault.line);
  EXPECT_EQ(lines, (std::vector<int>{2, 3, 5, 9})) << describe(site.error());
}

TEST(Site, a_beacon_with_a_fault_still_takes_part_in_the_clash_checks) {
  const std::string faults =
      faults_of(parse_site(replaced(replaced(kGood, "sigma_m: 0.02", "sigma_m: -1"), "slot: 31", "slot: 0"), "s.yaml"));
  EXPECT_NE(faults.find("sigma_m is -1"), std::string::npos) << faults;
  EXPECT_NE(faults.find("slot 0 is also"), std::string::npos) << faults;
}

TEST(Site, syntax_errors_have_their_line) {
  const std::string faults = faults_of(parse_site("site: {name: x}\ntone_table_hz: [5, 10\nbeacons: []\n", "s.yaml"));
  EXPECT_EQ(faults.rfind("s.yaml:3: this is not YAML: ", 0), 0u) << faults;
}

TEST(Site, empty_text_and_second_documents_are_faults) {
  EXPECT_NE(faults_of(parse_site("", "s.yaml")), "");
  EXPECT_NE(faults_of(parse_site("# nothing but a comment\n", "s.yaml")), "");
  EXPECT_NE(faults_of(parse_site(std::string(kGood) + "---\n" + kGood, "s.yaml")), "");
  EXPECT_NE(faults_of(parse_site("- a\n- b\n", "s.yaml")), "");
}

TEST(Site, a_missing_file_and_a_folder_are_faults) {
  EXPECT_EQ(faults_of(load_site("/no/such/site.yaml")),
            "/no/such/site.yaml: cannot be read: No such file or directory; check the path and the rights\n");
  EXPECT_EQ(faults_of(load_site("/")), "/: cannot be read: it is a folder; name the file in it\n");
}

/// A site file with a key file beside it, in a folder of its own.
class KeyedSite : public testing::Test {
 protected:
  Result<Site, Faults> load(const std::string& key) {
    const std::string folder = testing::TempDir();
    std::ofstream(folder + "lodestar_site_test.key") << key;
    const std::string path = folder + "lodestar_site_test.yaml";
    std::ofstream(path) << replaced(kGood, "key_file: \"\"", "key_file: lodestar_site_test.key");
    auto site = load_site(path);
    std::remove(path.c_str());
    std::remove((folder + "lodestar_site_test.key").c_str());
    return site;
  }
};

TEST_F(KeyedSite, finds_the_key_beside_the_site_file) {
  const auto site = load("000102030405060708090a0B0c0D0e0f\n");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  ASSERT_TRUE(site->link.key);
  for (int i = 0; i < 16; ++i) EXPECT_EQ((*site->link.key)[static_cast<std::size_t>(i)], i);
}

TEST_F(KeyedSite, a_wrong_key_is_a_fault_that_does_not_show_it) {
  for (const char* key :
       {"", "000102030405060708090a0b0c0d0e", "000102030405060708090a0b0c0d0e0f00", "000102030405060708090a0b0c0d0eXX",
        "00010203 0405060708090a0b0c0d0e0f", "000102030405060708090a0b0c0d0e0f 2"}) {
    const std::string faults = faults_of(load(key));
    EXPECT_NE(faults.find(".yaml:2: link.key_file"), std::string::npos) << faults;
    EXPECT_EQ(faults.find("0001"), std::string::npos) << faults;
  }
}

TEST_F(KeyedSite, is_written_with_the_name_of_its_key_file) {
  const auto site = load("000102030405060708090a0b0c0d0e0f");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  EXPECT_NE(to_yaml(*site).find("key_file: \"lodestar_site_test.key\""), std::string::npos);
  EXPECT_EQ(to_yaml(*site).find("0001"), std::string::npos);
}

/// The text is that of the same site: read again and written again it is the same.
TEST(SiteText, is_read_back_to_the_same_site) {
  auto site = parse_site(kGood, "s.yaml");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  Site odd = *site;
  odd.name = "\"hall\": {12}\n# no";
  odd.tone_table_hz = {6.6667, 8.3333};
  odd.beacons.resize(1);
  odd.beacons[0].tones = ToneSet{0, 1};
  odd.beacons[0].position_map = {-2147483.647, 1e-3, 12.345678};
  Site empty = *site;
  empty.beacons.clear();
  for (const Site& one : {*site, odd, empty}) {
    const auto read = parse_site(to_yaml(one), "s.yaml");
    ASSERT_TRUE(read.ok()) << describe(read.error()) << to_yaml(one);
    EXPECT_EQ(read->name, one.name);
    EXPECT_EQ(read->tone_table_hz, one.tone_table_hz);
    ASSERT_EQ(read->beacons.size(), one.beacons.size());
    for (std::size_t i = 0; i < one.beacons.size(); ++i) {
      EXPECT_EQ(read->beacons[i].position_map, one.beacons[i].position_map);
      EXPECT_EQ(read->beacons[i].tones, one.beacons[i].tones);
      EXPECT_EQ(read->beacons[i].waveform, one.beacons[i].waveform);
    }
    EXPECT_EQ(to_yaml(*read), to_yaml(one));
  }
}

class Survey : public testing::Test {
 protected:
  static Result<Site, Faults> load(const std::string& text) {
    const std::string path = testing::TempDir() + "lodestar_survey_test.yaml";
    std::ofstream(path) << text;
    auto survey = load_survey(path);
    std::remove(path.c_str());
    return survey;
  }
};

TEST_F(Survey, needs_id_and_position_only) {
  const auto survey = load("site: {name: x}\nbeacons:\n  - {id: 7, position_m: [1, 2, 3], sigma_m: 0.02}\n");
  ASSERT_TRUE(survey.ok()) << describe(survey.error());
  ASSERT_EQ(survey->beacons.size(), 1u);
  EXPECT_EQ(survey->beacons[0].id, BeaconId{7});
  EXPECT_EQ(survey->beacons[0].position_map, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(survey->beacons[0].sigma_m, 0.02);
  EXPECT_TRUE(survey->beacons[0].tones.empty());
}

/// Codes and slots are to be made anew: what clashes or is not in the table is no fault, whatever else is wrong is.
TEST_F(Survey, passes_over_codes_and_slots_only) {
  EXPECT_TRUE(load(replaced(kGood, "tones_hz: [6, 10]", "tones_hz: [26, 11]")).ok());
  EXPECT_TRUE(load(replaced(kGood, "slot: 0", "slot: 31")).ok());
  EXPECT_NE(faults_of(load(replaced(kGood, "id: 1,", "id: 4294967295,"))).find(":6: id 4294967295 is taken"),
            std::string::npos);
  EXPECT_NE(faults_of(load(replaced(kGood, "8.02", ".nan"))).find(":5: beacons[0].position_m[2]"), std::string::npos);
  EXPECT_NE(faults_of(load(replaced(kGood, "slot: 0", "slots: 0"))).find("did you mean \"slot\""), std::string::npos);
}

}  // namespace
}  // namespace lodestar
