#include "lodestar/base/common/fault.hpp"

namespace lodestar {

std::string describe(const Faults& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    text += fault.file;
    if (fault.line > 0) text += ":" + std::to_string(fault.line);
    text += ": " + fault.what + "\n";
  }
  return text;
}

}  // namespace lodestar
