#include "cli/estimate_writer.hpp"

#include <cmath>
#include <cstdio>

#include "cli/command_line.hpp"

namespace lodestar {

EstimateWriter::EstimateWriter(const std::string& path) : file_(path) {
  if (!file_) throw UserError(path + ": cannot be written; choose another --out.");
  file_ << "stamp_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,beacons_used,mode\n";
}

void EstimateWriter::add(const StateEstimate& estimate, std::size_t beacons_used, FilterMode mode) {
  const auto ns = estimate.stamp.time_since_epoch().count();
  const auto& t = estimate.T_map_base.translation();
  const auto rpy = roll_pitch_yaw(estimate.T_map_base.linear());
  char row[320];
  std::snprintf(row, sizeof row, "%lld.%09lld,%.6f,%.6f,%.6f,%.7f,%.7f,%.7f,%.6f,%.6f,%.7f,%zu,%s\n",
                static_cast<long long>(ns / 1000000000), static_cast<long long>(ns % 1000000000), t.x(), t.y(), t.z(),
                rpy.roll_rad, rpy.pitch_rad, rpy.yaw_rad, std::sqrt(estimate.covariance(0, 0)),
                std::sqrt(estimate.covariance(1, 1)), std::sqrt(estimate.covariance(5, 5)), beacons_used, name(mode));
  file_ << row;
}

}  // namespace lodestar
