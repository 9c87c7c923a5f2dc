// The whole line over a simulated drive against the estimates of an earlier day. A change of more than a few mm is
// either a fault or an improvement; in the second case write the file anew: LODESTAR_WRITE_GOLDEN=1 golden_sim

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

const std::string kFolder = std::string(LODESTAR_SOURCE_DIR) + "/test/golden/sim/";

struct Row {
  double time_s, x_m, y_m, z_m, yaw_rad;
  std::size_t sightings;
};

std::vector<Row> rows_now() {
  const auto scenario = sim::load_scenario(kFolder + "line.yaml");
  EXPECT_TRUE(scenario.ok()) << describe(scenario.error());
  std::vector<Row> rows;
  int frame = 0;
  sim::run_line(scenario.value(), [&](const sim::LineStep& step) {
    if (frame++ % 10 != 0 || !step.outcome.estimate) return;
    const auto& T = step.outcome.estimate->T_map_base;
    rows.push_back({step.time_s, T.translation().x(), T.translation().y(), T.translation().z(),
                    roll_pitch_yaw(T.linear()).yaw_rad, step.outcome.sightings.sightings.size()});
  });
  return rows;
}

void write(const std::vector<Row>& rows, const std::string& path) {
  std::ofstream file(path);
  file << "time_s,x_m,y_m,z_m,yaw_rad,sightings\n" << std::fixed;
  file.precision(5);
  for (const Row& row : rows) {
    file << row.time_s << ',' << row.x_m << ',' << row.y_m << ',' << row.z_m << ',' << row.yaw_rad << ','
         << row.sightings << '\n';
  }
}

std::vector<Row> read(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    std::istringstream text(line);
    Row row{};
    char comma;
    text >> row.time_s >> comma >> row.x_m >> comma >> row.y_m >> comma >> row.z_m >> comma >> row.yaw_rad >> comma >>
        row.sightings;
    rows.push_back(row);
  }
  return rows;
}

TEST(LineGolden, EstimatesAreThoseOfTheGoldenFile) {
  const auto now = rows_now();
  if (std::getenv("LODESTAR_WRITE_GOLDEN") != nullptr) write(now, kFolder + "line.csv");
  const auto golden = read(kFolder + "line.csv");
  ASSERT_GT(golden.size(), 15u);
  ASSERT_EQ(now.size(), golden.size());
  for (std::size_t i = 0; i < golden.size(); ++i) {
    EXPECT_NEAR(now[i].time_s, golden[i].time_s, 1e-4);
    EXPECT_NEAR(now[i].x_m, golden[i].x_m, 0.003) << "at " << golden[i].time_s << " s";
    EXPECT_NEAR(now[i].y_m, golden[i].y_m, 0.003) << "at " << golden[i].time_s << " s";
    EXPECT_NEAR(now[i].z_m, golden[i].z_m, 0.003) << "at " << golden[i].time_s << " s";
    EXPECT_NEAR(now[i].yaw_rad, golden[i].yaw_rad, 0.0005) << "at " << golden[i].time_s << " s";
    EXPECT_NEAR(static_cast<double>(now[i].sightings), static_cast<double>(golden[i].sightings), 1);
  }
}

}  // namespace
}  // namespace lodestar
