#pragma once

#include <yaml-cpp/yaml.h>

#include <exception>
#include <optional>
#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/yaml/fault_log.hpp"

namespace lodestar {

/// The whole file, or empty with the reason in `why`.
std::optional<std::string> read_file(const std::string& path, std::string& why);

/// The file's only document; empty after a fault (syntax, nothing there, more than one document).
std::optional<YAML::Node> parse_document(const std::string& text, FaultLog& faults);

/// What `read` makes of the document, or all faults that were found on the way. Throws nothing.
template <class T>
Result<T, Faults> parse_file(const std::string& text, const std::string& file_name,
                             T (*read)(const YAML::Node& root, FaultLog& faults)) {
  FaultLog faults(file_name);
  try {
    if (const auto root = parse_document(text, faults)) {
      T value = read(*root, faults);
      if (faults.empty()) return value;
    }
  } catch (const std::exception& error) {
    faults.add(0, std::string("cannot be read: ") + error.what());
  }
  return faults.sorted();
}

/// Reads the file at `path` and hands its text to `parse`.
template <class T>
Result<T, Faults> load_file(const std::string& path,
                            Result<T, Faults> (*parse)(const std::string& text, const std::string& file_name)) {
  std::string why;
  const auto text = read_file(path, why);
  if (!text) return Faults{{path, 0, why}};
  return parse(*text, path);
}

}  // namespace lodestar
