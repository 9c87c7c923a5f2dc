#include "lodestar/base/yaml/yaml_document.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {

std::optional<std::string> read_file(const std::string& path, std::string& why) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    why = "cannot be read: it is a folder; name the file in it";
    return std::nullopt;
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    why = std::string("cannot be read: ") + std::strerror(errno) + "; check the path and the rights";
    return std::nullopt;
  }
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<YAML::Node> parse_document(const std::string& text, FaultLog& faults) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty() || documents.front().IsNull()) {
      faults.add(0, "there is nothing in this file: start from an example in config/");
      return std::nullopt;
    }
    if (documents.size() > 1) {
      faults.add(line_of(documents[1], 0), "a second document starts here: keep one a file");
      return std::nullopt;
    }
    return documents.front();
  } catch (const YAML::Exception& error) {
    faults.add(error.mark.is_null() ? 0 : error.mark.line + 1, "this is not YAML: " + error.msg);
    return std::nullopt;
  }
}

}  // namespace lodestar
