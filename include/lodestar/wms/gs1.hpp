#pragma once

#include <string>
#include <string_view>

namespace lodestar {

// GS1 keys (GS1 General Specifications 23, sections 3 and 7.9) and their canonical GS1 Digital Link URIs (GS1
// Digital Link: URI Syntax 1.2, section 4.11), the only form that the event hash of CBV 2.0 knows.

/// 13 digits, the last of which is the check digit of the others.
bool valid_gln(std::string_view text);

/// GIAI: 1 to 30 characters of AI encodable character set 82.
bool valid_giai(std::string_view text);

/// Extension of a GLN, which names a place below it: 1 to 20 characters of AI encodable character set 82.
bool valid_gln_extension(std::string_view text);

/// RFC 4122 in lower case with hyphens.
bool valid_uuid(std::string_view text);

// Each wants a valid key.
std::string sscc_uri(std::string_view sscc);
std::string giai_uri(std::string_view giai);
std::string place_uri(std::string_view gln);
std::string place_uri(std::string_view gln, std::string_view extension);
std::string uuid_uri(std::string_view uuid);

}  // namespace lodestar
