#include "lodestar/wms/gs1.hpp"

#include <algorithm>

#include "lodestar/base/measurement/sscc.hpp"

namespace lodestar {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool in_set_82(char c) {
  return is_digit(c) || is_letter(c) || std::string_view("!\"%&'()*+,-./:;<=>?_").find(c) != std::string_view::npos;
}

bool is_text_of_set_82(std::string_view text, std::size_t longest) {
  return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), in_set_82);
}

/// RFC 3986: everything but the unreserved characters.
std::string percent_encoded(std::string_view text) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    if (is_digit(c) || is_letter(c) || std::string_view("-._~").find(c) != std::string_view::npos) {
      out += c;
    } else {
      const auto octet = static_cast<unsigned char>(c);
      out += {'%', kHex[octet >> 4], kHex[octet & 15]};
    }
  }
  return out;
}

const std::string kDigitalLink = "https://id.gs1.org/";

}  // namespace

bool valid_gln(std::string_view text) {
  return text.size() == 13 && std::all_of(text.begin(), text.end(), is_digit) &&
         text.back() == gs1_check_digit(std::string(text.substr(0, 12)));
}

bool valid_giai(std::string_view text) { return is_text_of_set_82(text, 30); }

bool valid_gln_extension(std::string_view text) { return is_text_of_set_82(text, 20); }

bool valid_uuid(std::string_view text) {
  if (text.size() != 36) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool hyphen = i == 8 || i == 13 || i == 18 || i == 23;
    if (hyphen ? text[i] != '-' : !(is_digit(text[i]) || (text[i] >= 'a' && text[i] <= 'f'))) return false;
  }
  return true;
}

std::string sscc_uri(std::string_view sscc) { return kDigitalLink + "00/" + std::string(sscc); }

std::string giai_uri(std::string_view giai) { return kDigitalLink + "8004/" + percent_encoded(giai); }

std::string place_uri(std::string_view gln) { return kDigitalLink + "414/" + std::string(gln); }

std::string place_uri(std::string_view gln, std::string_view extension) {
  return place_uri(gln) + "/254/" + percent_encoded(extension);
}

std::string uuid_uri(std::string_view uuid) { return "urn:uuid:" + std::string(uuid); }

}  // namespace lodestar
