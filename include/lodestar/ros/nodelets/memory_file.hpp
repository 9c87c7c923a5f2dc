#pragma once

#include <string>

namespace lodestar {

/// Puts the text in the file's place so that a reader, or a fall of power, finds the old text or the new one: it is
/// written whole beside it, synced and renamed. Empty, or what went wrong.
std::string replace_file(const std::string& path, const std::string& text);

/// Renames a file that cannot be understood to `<path>.broken`; says so, with what is lost by it.
std::string set_aside(const std::string& path, const std::string& loss);

}  // namespace lodestar
