#pragma once

#include <string>
#include <vector>

namespace lodestar {

/// One thing wrong with a file that a person wrote: where, and what, with the value, the limit and the way out.
struct Fault {
  std::string file;
  int line = 0;  ///< 1-based; 0 where the fault is the file's as a whole
  std::string what;
};

using Faults = std::vector<Fault>;

/// "file:line: what", one a line, as compilers print it.
std::string describe(const Faults& faults);

}  // namespace lodestar
