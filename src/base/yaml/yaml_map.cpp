#include "lodestar/base/yaml/yaml_map.hpp"

#include <algorithm>
#include <numeric>

namespace lodestar {

namespace {

/// The key without its unit, and whether it had one.
struct Stem {
  std::string name;
  bool has_unit;
};
Stem stem(const std::string& key) {
  for (const char* unit : {"_m_s2", "_deg_s", "_rad_s", "_m_s", "_kbps", "_bps", "_deg", "_rad", "_khz", "_hz", "_px",
                           "_mm", "_cm", "_ms", "_us", "_ns", "_m", "_s"}) {
    const std::string suffix = unit;
    if (key.size() > suffix.size() && key.compare(key.size() - suffix.size(), suffix.size(), suffix) == 0)
      return {key.substr(0, key.size() - suffix.size()), true};
  }
  return {key, false};
}

/// Levenshtein distance: letters to insert, delete or replace.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// What is wrong with an unknown key, and which one may have been meant.
std::string unknown_key(const std::string& key, const std::vector<YamlKey>& keys) {
  constexpr std::size_t kLongestKey = 64;
  const Stem given = stem(key);
  const char* nearest = nullptr;
  std::size_t least = 3;
  for (const YamlKey& known : keys) {
    const Stem meant = stem(known.name);
    if (meant.has_unit && meant.name == given.name)
      return (given.has_unit ? " has another unit: did you mean " : " has no unit: did you mean ") +
             quote(std::string(known.name)) + "?";
    const bool starts_it = key.size() > 2 && std::string(known.name).rfind(key, 0) == 0;
    const std::size_t distance = starts_it ? 0 : key.size() > kLongestKey ? least : edit_distance(key, known.name);
    if (distance < least) {
      least = distance;
      nearest = known.name;
    }
  }
  if (nearest) return " is unknown: did you mean " + quote(std::string(nearest)) + "?";
  std::string list;
  for (const YamlKey& known : keys) list += (list.empty() ? "" : ", ") + std::string(known.name);
  return " is unknown here: known are " + list;
}

}  // namespace

YamlMap::YamlMap(const YAML::Node& node, const std::string& path, int line, const std::vector<YamlKey>& keys,
                 FaultLog& faults)
    : path_(path), line_(line_of(node, line)), faults_(&faults) {
  if (!node.IsMap() && !node.IsNull()) {
    faults.add(line_, (path.empty() ? "the file" : path) + " is " + quote(node) + ": give keys with values");
    return;
  }
  if (node.IsMap())
    for (const auto& entry : node) take(entry.first, entry.second, keys);
  for (const YamlKey& key : keys)
    if (key.required && !has(key.name))
      faults.add(line_, (path.empty() ? "the file" : path) + " has no " + quote(std::string(key.name)) + ": add it");
}

void YamlMap::take(const YAML::Node& key, const YAML::Node& value, const std::vector<YamlKey>& keys) {
  const int line = line_of(key, line_);
  const std::string where = path_.empty() ? "" : path_ + ": ";
  if (!key.IsScalar()) {
    faults_->add(line, where + "a key is " + quote(key) + ": give one word");
    return;
  }
  const std::string& name = key.Scalar();
  const bool known =
      std::any_of(keys.begin(), keys.end(), [&name](const YamlKey& candidate) { return name == candidate.name; });
  if (!known) {
    faults_->add(line, where + "key " + quote(name) + unknown_key(name, keys));
  } else if (has(name)) {
    faults_->add(line, where + "key " + quote(name) + " is there twice (first on line " +
                           std::to_string(values_.at(name).line) + "): keep one");
  } else {
    values_.emplace(name, Value{value, value.IsNull() ? line : line_of(value, line)});
  }
}

int YamlMap::line(const std::string& key) const {
  const auto it = values_.find(key);
  return it == values_.end() ? line_ : it->second.line;
}

std::string YamlMap::path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

void YamlMap::fault(const std::string& key, const std::string& what) const {
  faults_->add(line(key), path(key) + " " + what);
}

std::optional<double> YamlMap::number(const YAML::Node& node, const std::string& path, int line,
                                      const Limits& limits) const {
  std::string why;
  const auto value = parse_number(node, why);
  if (!value) {
    faults_->add(line, path + " is " + quote(node) + ": " + why);
  } else if (!contains(limits, *value)) {
    faults_->add(line, path + " is " + print(*value) + ": give a number " + describe(limits));
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<double> YamlMap::number(const std::string& key, const Limits& limits) const {
  const auto it = values_.find(key);
  if (it == values_.end()) return std::nullopt;
  return number(it->second.node, path(key), it->second.line, limits);
}

std::optional<std::int64_t> YamlMap::integer(const std::string& key, const Limits& limits) const {
  const auto it = values_.find(key);
  if (it == values_.end()) return std::nullopt;
  std::string why;
  const auto value = parse_integer(it->second.node, why);
  if (!value) {
    fault(key, "is " + quote(it->second.node) + ": " + why);
  } else if (!contains(limits, static_cast<double>(*value))) {
    fault(key, "is " + std::to_string(*value) + ": give a whole number " + describe(limits));
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<std::string> YamlMap::text(const std::string& key) const {
  const auto it = values_.find(key);
  if (it == values_.end()) return std::nullopt;
  if (it->second.node.IsScalar()) return it->second.node.Scalar();
  fault(key, "is " + quote(it->second.node) + ": give one text");
  return std::nullopt;
}

std::optional<bool> YamlMap::boolean(const std::string& key) const {
  const auto value = text(key);
  if (!value) return std::nullopt;
  if (*value == "true" || *value == "false") return *value == "true";
  fault(key, "is " + quote(*value) + ": give true or false");
  return std::nullopt;
}

std::optional<std::vector<YamlMap::Number>> YamlMap::numbers(const std::string& key, std::size_t min_count,
                                                             std::size_t max_count, const Limits& limits) const {
  const auto it = values_.find(key);
  if (it == values_.end()) return std::nullopt;
  const YAML::Node& node = it->second.node;
  const std::string wanted = min_count == max_count ? std::to_string(min_count)
                                                    : std::to_string(min_count) + " to " + std::to_string(max_count);
  if (!node.IsSequence()) {
    fault(key, "is " + quote(node) + ": give a list of " + wanted + (max_count == 1 ? " number" : " numbers"));
    return std::nullopt;
  }
  bool good = node.size() >= min_count && node.size() <= max_count;
  if (!good) fault(key, "has " + std::to_string(node.size()) + " numbers: give " + wanted);
  std::vector<Number> numbers;
  for (std::size_t i = 0; i < std::min(node.size(), max_count); ++i) {
    const int line = line_of(node[i], it->second.line);
    const auto value = number(node[i], path(key) + "[" + std::to_string(i) + "]", line, limits);
    if (value)
      numbers.push_back({*value, line});
    else
      good = false;
  }
  if (!good) return std::nullopt;
  return numbers;
}

std::vector<YAML::Node> YamlMap::list(const std::string& key) const {
  const auto it = values_.find(key);
  if (it == values_.end() || it->second.node.IsNull()) return {};
  if (!it->second.node.IsSequence()) {
    fault(key, "is " + quote(it->second.node) + ": give a list");
    return {};
  }
  return {it->second.node.begin(), it->second.node.end()};
}

YamlMap YamlMap::section(const std::string& key, const std::vector<YamlKey>& keys) const {
  const auto it = values_.find(key);
  if (it != values_.end()) return YamlMap(it->second.node, path(key), it->second.line, keys, *faults_);
  return YamlMap(YAML::Node(YAML::NodeType::Null), path(key), line_, {}, *faults_);
}

}  // namespace lodestar
