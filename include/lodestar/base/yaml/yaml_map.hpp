#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/yaml/fault_log.hpp"
#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {

/// A key that a map may have.
struct YamlKey {
  const char* name;
  bool required;
};

/// One map of a file that a person wrote. What is wrong with it goes to the fault log: unknown, missing and double
/// keys at once, values when they are read. The readers return empty where the key is missing or its value wrong.
class YamlMap {
 public:
  /// @param path what the map is called in faults, as `beacons[2]`; empty for the file's root
  /// @param line where it stands when the parser noted no line
  YamlMap(const YAML::Node& node, const std::string& path, int line, const std::vector<YamlKey>& keys,
          FaultLog& faults);

  bool has(const std::string& key) const { return values_.count(key) > 0; }
  int line() const { return line_; }
  int line(const std::string& key) const;          ///< of the value; of the map where there is none
  std::string path(const std::string& key) const;  ///< as `beacons[2].slot`

  std::optional<double> number(const std::string& key, const Limits& limits) const;
  std::optional<std::int64_t> integer(const std::string& key, const Limits& limits) const;
  std::optional<bool> boolean(const std::string& key) const;      ///< true or false
  std::optional<std::string> text(const std::string& key) const;  ///< may be empty text

  /// A list of numbers with the line of each.
  struct Number {
    double value;
    int line;
  };
  std::optional<std::vector<Number>> numbers(const std::string& key, std::size_t min_count, std::size_t max_count,
                                             const Limits& limits) const;

  /// The items of a list; none where the key is missing or null.
  std::vector<YAML::Node> list(const std::string& key) const;

  /// The map under `key`; without keys where it is missing or null.
  YamlMap section(const std::string& key, const std::vector<YamlKey>& keys) const;

  /// Notes a fault of the value of `key`.
  void fault(const std::string& key, const std::string& what) const;

 private:
  void take(const YAML::Node& key, const YAML::Node& value, const std::vector<YamlKey>& keys);
  std::optional<double> number(const YAML::Node& node, const std::string& path, int line, const Limits& limits) const;

  struct Value {
    YAML::Node node;
    int line;
  };
  std::string path_;
  int line_;
  std::map<std::string, Value> values_;
  FaultLog* faults_;
};

}  // namespace lodestar
