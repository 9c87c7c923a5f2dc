#include "lodestar/ros/params/param_reader.hpp"

#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace lodestar {
namespace {

// Set by roscpp's own tools below a node's name, not by people for the node.
const char* const kToolKeys[] = {"diagnostic_period", "image_transport"};

const char* type_name(XmlRpc::XmlRpcValue::Type type) {
  switch (type) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return "a bool";
    case XmlRpc::XmlRpcValue::TypeInt:
      return "an integer";
    case XmlRpc::XmlRpcValue::TypeDouble:
      return "a number";
    case XmlRpc::XmlRpcValue::TypeString:
      return "a text";
    case XmlRpc::XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpc::XmlRpcValue::TypeStruct:
      return "a dictionary";
    default:
      return "of another type";
  }
}

std::string out_of_range(double value, const Range& range) {
  std::ostringstream what;
  what << "is " << value << ", must be";
  if (std::isfinite(range.lowest)) what << " at least " << range.lowest;
  if (std::isfinite(range.lowest) && std::isfinite(range.highest)) what << " and";
  if (std::isfinite(range.highest)) what << " at most " << range.highest;
  if (!std::isfinite(range.lowest) && !std::isfinite(range.highest)) what << " finite";
  return what.str();
}

bool inside(double value, const Range& range) {
  return std::isfinite(value) && value >= range.lowest && value <= range.highest;
}

}  // namespace

ParamReader::ParamReader(const ros::NodeHandle& private_nh)
    : private_nh_(private_nh), known_(std::begin(kToolKeys), std::end(kToolKeys)) {}

bool ParamReader::read(const std::string& key, XmlRpc::XmlRpcValue& value) {
  known_.insert(key);
  return private_nh_.getParam(key, value);
}

void ParamReader::fault(const std::string& key, const std::string& what) {
  faults_.push_back({private_nh_.resolveName(key), 0, what});
}

double ParamReader::number(const std::string& key, double otherwise, const Range& range) {
  XmlRpc::XmlRpcValue value;
  if (!read(key, value)) return otherwise;
  const auto type = value.getType();
  if (type != XmlRpc::XmlRpcValue::TypeDouble && type != XmlRpc::XmlRpcValue::TypeInt) {
    fault(key, std::string("is ") + type_name(type) + ", must be a number");
    return otherwise;
  }
  const double number =
      type == XmlRpc::XmlRpcValue::TypeInt ? static_cast<double>(static_cast<int>(value)) : static_cast<double>(value);
  if (inside(number, range)) return number;
  fault(key, out_of_range(number, range));
  return otherwise;
}

int ParamReader::integer(const std::string& key, int otherwise, const Range& range) {
  XmlRpc::XmlRpcValue value;
  if (!read(key, value)) return otherwise;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeInt) {
    fault(key, std::string("is ") + type_name(value.getType()) + ", must be an integer");
    return otherwise;
  }
  const int number = static_cast<int>(value);
  if (inside(number, range)) return number;
  fault(key, out_of_range(number, range));
  return otherwise;
}

bool ParamReader::flag(const std::string& key, bool otherwise) {
  XmlRpc::XmlRpcValue value;
  if (!read(key, value)) return otherwise;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<bool>(value);
  fault(key, std::string("is ") + type_name(value.getType()) + ", must be true or false");
  return otherwise;
}

std::string ParamReader::text(const std::string& key, const std::string& otherwise) {
  XmlRpc::XmlRpcValue value;
  if (!read(key, value)) return otherwise;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeString) return static_cast<std::string>(value);
  fault(key, std::string("is ") + type_name(value.getType()) + ", must be a text");
  return otherwise;
}

std::string ParamReader::choice(const std::string& key, const std::string& otherwise,
                                const std::vector<std::string>& choices) {
  const std::string value = text(key, otherwise);
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
  std::string list;
  for (const auto& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  fault(key, "is '" + value + "', must be one of " + list);
  return otherwise;
}

std::vector<std::string> ParamReader::texts(const std::string& key) {
  XmlRpc::XmlRpcValue value;
  std::vector<std::string> out;
  if (!read(key, value)) return out;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    fault(key, std::string("is ") + type_name(value.getType()) + ", must be a list of texts");
    return out;
  }
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() == XmlRpc::XmlRpcValue::TypeString) {
      out.push_back(static_cast<std::string>(value[i]));
    } else {
      fault(key, "entry " + std::to_string(i + 1) + " is " + type_name(value[i].getType()) + ", must be a text");
    }
  }
  return out;
}

std::string ParamReader::path(const std::string& key) {
  const std::size_t before = faults_.size();
  const std::string value = text(key, "");
  if (value.empty() && faults_.size() == before) fault(key, "is missing: give the path of a file");
  return value;
}

void ParamReader::add(const Faults& faults) { faults_.insert(faults_.end(), faults.begin(), faults.end()); }

Faults ParamReader::faults() const {
  Faults all = faults_;
  // A nodelet's handle may lack the leading slash.
  const std::string prefix = ros::names::clean("/" + private_nh_.getNamespace()) + "/";
  std::vector<std::string> names;
  private_nh_.getParamNames(names);
  std::set<std::string> unknown;
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string key = name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
    if (known_.count(key) == 0) unknown.insert(key);
  }
  for (const std::string& key : unknown) all.push_back({prefix + key, 0, "is no parameter of this node"});
  return all;
}

void refuse_faults(const Faults& faults) {
  if (faults.empty()) return;
  std::istringstream lines(describe(faults));
  for (std::string line; std::getline(lines, line);) ROS_FATAL_STREAM(line);
  throw std::runtime_error(describe(faults));
}

}  // namespace lodestar
