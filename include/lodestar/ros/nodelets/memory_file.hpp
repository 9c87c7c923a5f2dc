#pragma once

#include <string>

namespace lodestar {

/// What a node keeps over restarts, whole whatever happens (replace_file). Empty, or what went wrong.
std::string write_memory(const std::string& path, const std::string& octets);

/// Renames a file that cannot be understood to `<path>.broken`; says so, with what is lost by it.
std::string set_aside(const std::string& path, const std::string& loss);

}  // namespace lodestar
