#pragma once

#include <stdexcept>

namespace lodestar {

/// No picture; what() says why and what to do.
struct PlotError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace lodestar
