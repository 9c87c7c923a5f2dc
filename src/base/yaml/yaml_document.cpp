#include "lodestar/base/yaml/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {
namespace {

/// Where the document's content begins, and nothing else of it.
class Beginning : public YAML::EventHandler {
 public:
  std::optional<int> line() const { return line_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override { note(mark); }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnMapEnd() override {}

 private:
  void note(const YAML::Mark& mark) {
    if (!line_) line_ = mark.line + 1;
  }
  std::optional<int> line_;
};

/// The line of a second document, if there is one. Not YAML::LoadAll: on some broken texts yaml-cpp 0.7 finds empty
/// documents for ever.
std::optional<int> second_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Beginning first, second;
  if (!parser.HandleNextDocument(first) || !parser.HandleNextDocument(second)) return std::nullopt;
  return second.line().value_or(0);
}

}  // namespace

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
    YAML::Node document = YAML::Load(text);
    if (document.IsNull()) {
      faults.add(0, "there is nothing in this file: start from an example in config/");
      return std::nullopt;
    }
    if (const auto line = second_document(text)) {
      faults.add(*line, "a second document starts here: keep one a file");
      return std::nullopt;
    }
    return document;
  } catch (const YAML::Exception& error) {
    faults.add(error.mark.is_null() ? 0 : error.mark.line + 1, "this is not YAML: " + error.msg);
    return std::nullopt;
  }
}

}  // namespace lodestar
