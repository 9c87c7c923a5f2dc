#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

const char* name(NoFrame reason) {
  switch (reason) {
    case NoFrame::kTimeout:
      return "silent";
    case NoFrame::kIncomplete:
      return "incomplete";
    case NoFrame::kFormat:
      return "format";
    case NoFrame::kEnd:
      return "end";
    case NoFrame::kCount:
      break;
  }
  return "?";
}

}  // namespace lodestar
