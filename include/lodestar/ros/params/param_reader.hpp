#pragma once

#include <ros/node_handle.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"

namespace lodestar {

/// What a number parameter may be; both ends belong to it.
struct Range {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

/// Reads a node's private parameters and remembers everything that is wrong with them: a wrong type, a value out of
/// range, a missing one, and, at the end, each key that nobody asked for. A faulty parameter reads as its default; the
/// caller must ask faults() before it uses any.
class ParamReader {
 public:
  explicit ParamReader(const ros::NodeHandle& private_nh);

  double number(const std::string& key, double otherwise, const Range& range = {});
  int integer(const std::string& key, int otherwise, const Range& range = {});
  bool flag(const std::string& key, bool otherwise);
  std::string text(const std::string& key, const std::string& otherwise);
  std::string choice(const std::string& key, const std::string& otherwise, const std::vector<std::string>& choices);
  /// A list of texts; missing: an empty one.
  std::vector<std::string> texts(const std::string& key);
  /// The path of a file; missing or empty is a fault.
  std::string path(const std::string& key);

  void add(const Faults& faults);
  /// All faults, those of unknown keys included. Keys of roscpp's own tools are known.
  Faults faults() const;

 private:
  bool read(const std::string& key, XmlRpc::XmlRpcValue& value);
  void fault(const std::string& key, const std::string& what);

  ros::NodeHandle private_nh_;
  std::set<std::string> known_;
  Faults faults_;
};

/// Logs every fault and throws std::runtime_error when there is one: a nodelet that throws in onInit is not loaded.
void refuse_faults(const Faults& faults);

}  // namespace lodestar
