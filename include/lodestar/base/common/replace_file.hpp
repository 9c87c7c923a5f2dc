#pragma once

#include <string>

namespace lodestar {

/// Puts `octets` in the place of what the file held. Whenever the program is killed or the power falls, the file holds
/// all of the old or all of the new; once this has returned true, the new. Uses `<path>.new`.
/// @return false, with errno, where that could not be done
bool replace_file(const std::string& path, const std::string& octets);

}  // namespace lodestar
