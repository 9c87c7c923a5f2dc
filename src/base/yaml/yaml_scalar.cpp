#include "lodestar/base/yaml/yaml_scalar.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <sstream>

namespace lodestar {

namespace {

constexpr std::size_t kLongestQuote = 40;

bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

bool is_not_finite(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.erase(0, 1);
  if (!text.empty() && text[0] == '.') text.erase(0, 1);
  return text == "nan" || text == "inf" || text == "infinity";
}

/// Leaves the scalar's text, or empty with the reason why it cannot be a number.
std::optional<std::string> number_text(const YAML::Node& node, std::string& why) {
  if (!node.IsScalar()) {
    why = "give one number";
  } else if (is_quoted(node)) {
    why = "it is text; take the quotes off";
  } else if (is_not_finite(node.Scalar())) {
    why = "give a finite number";
  } else {
    return node.Scalar();
  }
  return std::nullopt;
}

}  // namespace

bool contains(const Limits& limits, double value) {
  return (limits.above ? value > limits.min : value >= limits.min) && value <= limits.max;
}

std::string describe(const Limits& limits) {
  return (limits.above ? "above " : "from ") + print(limits.min) + (limits.above ? " and up to " : " to ") +
         print(limits.max);
}

std::string print(double value) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(10);
  stream << value;
  return stream.str();
}

std::string quote(const std::string& text) {
  std::string shown = text.substr(0, kLongestQuote);
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return '"' + shown + (text.size() > kLongestQuote ? "..." : "") + '"';
}

std::string quote(const YAML::Node& node) {
  if (node.IsScalar()) return quote(node.Scalar());
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a map";
  return "empty";
}

int line_of(const YAML::Node& node, int otherwise) {
  const YAML::Mark mark = node.Mark();
  return mark.line < 0 ? otherwise : mark.line + 1;
}

std::optional<double> parse_number(const YAML::Node& node, std::string& why) {
  const auto text = number_text(node, why);
  if (!text) return std::nullopt;
  std::istringstream stream(*text);
  stream.imbue(std::locale::classic());
  double value = 0;
  stream >> std::noskipws >> value;
  if (stream.fail() || !stream.eof() || !std::isfinite(value)) {
    why = "give a plain number; the unit is in the key's name";
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> parse_integer(const YAML::Node& node, std::string& why) {
  const auto text = number_text(node, why);
  if (!text) return std::nullopt;
  const std::size_t sign = (*text)[0] == '-' ? 1 : 0;
  constexpr std::size_t kMostDigits = 18;
  const std::size_t digits = text->size() - sign;
  const bool all_digits = std::all_of(text->begin() + static_cast<std::ptrdiff_t>(sign), text->end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
  if (digits == 0 || digits > kMostDigits || !all_digits) {
    why = "give a whole number in decimal digits";
    return std::nullopt;
  }
  return std::stoll(*text);
}

}  // namespace lodestar
