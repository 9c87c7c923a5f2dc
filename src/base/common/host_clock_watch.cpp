#include "lodestar/base/common/host_clock_watch.hpp"

#include <utility>

namespace lodestar {

bool HostClockWatch::was_set(Duration steady_before, Stamp host, Duration steady_after) {
  const Offset now{host.time_since_epoch() - steady_after, host.time_since_epoch() - steady_before};
  const std::optional<Offset> before = std::exchange(offset_, now);
  return before && (now.least > before->most + kStep || now.most < before->least - kStep);
}

}  // namespace lodestar
