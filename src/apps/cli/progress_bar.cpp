#include "cli/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace lodestar {

ProgressBar::ProgressBar(std::string label) : label_(std::move(label)), on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_terminal_ && drawn_permille_ >= 0) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(double done) {
  constexpr int kWidth = 40;
  const int permille = static_cast<int>(1000 * std::clamp(done, 0.0, 1.0));
  if (!on_terminal_ || permille == drawn_permille_) return;
  drawn_permille_ = permille;
  const int filled = permille * kWidth / 1000;
  const std::string bar =
      std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r%s [%s] %3d %%", label_.c_str(), bar.c_str(), permille / 10);
}

}  // namespace lodestar
