#include "lodestar/evaluation/estimate_csv.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace lodestar {
namespace {

const std::string kHeader = std::string(kEstimateCsvHeader) + "\n";
const std::string kGood = "1700000000.123456789,1,2,0.1,0,0,0.5,0.02,0.03,0.004,3,tracking\n";

Result<std::vector<EstimateRow>, Faults> read(const std::string& text) {
  std::istringstream stream(text);
  return read_estimate_csv(stream, "e.csv");
}

std::string faults(const std::string& text) {
  const auto rows = read(text);
  return rows ? "" : describe(rows.error());
}

TEST(EstimateCsv, ReadsARowToTheNanosecond) {
  const auto rows = read(kHeader + kGood);
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 1u);
  const EstimateRow& row = rows->front();
  EXPECT_EQ(row.stamp.time_since_epoch().count(), 1700000000123456789);
  EXPECT_EQ(row.T_map_base.translation(), Eigen::Vector3d(1, 2, 0.1));
  EXPECT_NEAR(roll_pitch_yaw(row.T_map_base.linear()).yaw_rad, 0.5, 1e-12);
  EXPECT_EQ(row.sigma_y_m, 0.03);
  EXPECT_EQ(row.beacons_used, 3);
  EXPECT_EQ(row.mode, "tracking");
}

TEST(EstimateCsv, HeaderAloneIsAnEmptyEstimate) {
  const auto rows = read(kHeader);
  ASSERT_TRUE(rows);
  EXPECT_TRUE(rows->empty());
}

TEST(EstimateCsv, TakesWindowsLineEnds) {
  EXPECT_TRUE(read(std::string(kEstimateCsvHeader) + "\r\n" + kGood.substr(0, kGood.size() - 1) + "\r\n"));
}

TEST(EstimateCsv, SaysLineAndReasonOfEachFault) {
  const std::string text = faults(kHeader + kGood +
                                  "1700000000.2,1,2,0,0,0,nan,0.1,0.1,0.1,3,tracking\n"    // 3
                                  "1700000000.3,1,2,0,0,0,0,0.1,0.1,0.1,3\n"               // 4
                                  "1700000000.4,1,2,0,0,0,0,-0.1,0.1,0.1,3,tracking\n"     // 5
                                  "17e8,1,2,0,0,0,0,0.1,0.1,0.1,3,tracking\n"              // 6
                                  "1700000000.1,1,2,0,0,0,0,0.1,0.1,0.1,3,tracking\n"      // 7: back in time
                                  "1700000000.6,1,2x,0,0,0,0,0.1,0.1,0.1,3,tracking\n"     // 8
                                  "1700000000.7,1,2,0,0,0,0,0.1,0.1,0.1,2.5,tracking\n");  // 9
  for (const char* expected : {"e.csv:3: yaw_rad", "e.csv:4: has 11 columns", "e.csv:5: sigma_x_m", "e.csv:6: stamp_s",
                               "e.csv:7: stamp_s is not later", "e.csv:8: y_m", "e.csv:9: beacons_used"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " is not in\n" << text;
}

TEST(EstimateCsv, RefusesAnotherHeaderOrNothing) {
  EXPECT_NE(faults("x,y\n1,2\n").find("e.csv:1: is no estimate"), std::string::npos);
  EXPECT_NE(faults("").find("is empty"), std::string::npos);
  EXPECT_FALSE(load_estimate_csv("/nowhere/e.csv"));
}

}  // namespace
}  // namespace lodestar
