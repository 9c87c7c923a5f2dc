#pragma once

#include <string>

namespace lodestar {

/// RFC 4122, version 4, in lower case.
std::string random_uuid();

}  // namespace lodestar
