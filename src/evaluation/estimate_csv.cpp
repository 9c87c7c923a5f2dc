#include "lodestar/evaluation/estimate_csv.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <locale>
#include <optional>
#include <sstream>

namespace lodestar {
namespace {

constexpr std::size_t kColumns = 12;
constexpr std::size_t kMostFaults = 20;
constexpr std::size_t kFractionDigits = 9;

const std::array<const char*, kColumns> kNames{"stamp_s",   "x_m",           "y_m",          "z_m",
                                               "roll_rad",  "pitch_rad",     "yaw_rad",      "sigma_x_m",
                                               "sigma_y_m", "sigma_yaw_rad", "beacons_used", "mode"};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

bool all_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Seconds since the epoch to the nanosecond: a double would lose 0.2 us.
std::optional<Stamp> parse_stamp(const std::string& text) {
  const auto dot = text.find('.');
  const std::string whole = text.substr(0, dot);
  std::string fraction = dot == std::string::npos ? "0" : text.substr(dot + 1);
  if (!all_digits(whole) || !all_digits(fraction) || whole.size() > 10) return std::nullopt;
  fraction.resize(kFractionDigits, '0');
  return Stamp(std::chrono::seconds(std::stoll(whole)) + std::chrono::nanoseconds(std::stoll(fraction)));
}

std::optional<double> parse_number(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The row, or what is wrong with it.
Result<EstimateRow, std::string> parse_row(const std::string& line) {
  const std::vector<std::string> cells = split(line);
  if (cells.size() != kColumns)
    return "has " + std::to_string(cells.size()) + " columns: give " + std::to_string(kColumns);
  const auto wrong = [&](std::size_t i, const char* expected) {
    return std::string(kNames[i]) + " is \"" + cells[i] + "\": give " + expected;
  };
  EstimateRow row;
  const auto stamp = parse_stamp(cells[0]);
  if (!stamp) return wrong(0, "seconds since the epoch");
  row.stamp = *stamp;
  std::array<double, 10> value{};
  for (std::size_t i = 1; i < value.size(); ++i) {
    const auto number = parse_number(cells[i]);
    if (!number) return wrong(i, "a finite number");
    value[i] = *number;
    if (i >= 7 && *number < 0) return wrong(i, "a sigma, not negative");
  }
  if (!all_digits(cells[10]) || cells[10].size() > 6) return wrong(10, "a whole number");
  if (cells[11].empty()) return wrong(11, "one word");
  row.T_map_base.translation() << value[1], value[2], value[3];
  row.T_map_base.linear() = rotation({value[4], value[5], value[6]});
  row.sigma_x_m = value[7];
  row.sigma_y_m = value[8];
  row.sigma_yaw_rad = value[9];
  row.beacons_used = std::stoi(cells[10]);
  row.mode = cells[11];
  return row;
}

bool next_line(std::istream& input, std::string& line) {
  if (!std::getline(input, line)) return false;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

}  // namespace

const char* const kEstimateCsvHeader =
    "stamp_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,beacons_used,mode";

Result<std::vector<EstimateRow>, Faults> read_estimate_csv(std::istream& input, const std::string& file_name) {
  std::string line;
  if (!next_line(input, line))
    return Faults{{file_name, 0, "is empty: expected the header " + std::string(kEstimateCsvHeader)}};
  if (line != kEstimateCsvHeader)
    return Faults{{file_name, 1, "is no estimate: the first line must be " + std::string(kEstimateCsvHeader)}};
  std::vector<EstimateRow> rows;
  Faults faults;
  for (int number = 2; next_line(input, line) && faults.size() < kMostFaults; ++number) {
    if (line.empty()) continue;
    auto row = parse_row(line);
    if (!row)
      faults.push_back({file_name, number, row.error()});
    else if (!rows.empty() && row->stamp <= rows.back().stamp)
      faults.push_back(
          {file_name, number, "stamp_s is not later than the row before: sort the rows, keep each stamp once"});
    else
      rows.push_back(std::move(row).value());
  }
  if (!faults.empty()) return faults;
  return rows;
}

Result<std::vector<EstimateRow>, Faults> load_estimate_csv(const std::string& path) {
  std::ifstream file(path);
  if (!file) return Faults{{path, 0, "cannot be read: give the CSV file that replay wrote"}};
  return read_estimate_csv(file, path);
}

}  // namespace lodestar
