#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>

namespace lodestar {

/// The range of a number, ends included unless `above` shuts the lower one out.
struct Limits {
  double min, max;
  bool above = false;
};
inline Limits within(double min, double max) { return {min, max, false}; }
inline Limits above(double min, double max) { return {min, max, true}; }
bool contains(const Limits& limits, double value);  ///< false for NaN
std::string describe(const Limits& limits);

/// A number as a person would write it, at most 10 digits.
std::string print(double value);

/// A value for a fault: in quotes, cut to a readable length, nothing unprintable. "a list", "a map" for those.
std::string quote(const YAML::Node& node);
std::string quote(const std::string& text);

/// 1-based; `otherwise` where the parser noted none.
int line_of(const YAML::Node& node, int otherwise);

/// A plain number, or empty with the reason in `why`. Text in quotes is no number, nor are .nan and .inf.
std::optional<double> parse_number(const YAML::Node& node, std::string& why);
std::optional<std::int64_t> parse_integer(const YAML::Node& node, std::string& why);

}  // namespace lodestar
