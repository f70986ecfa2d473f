#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace shadestep::cli {

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), shown_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - drawn_ < std::chrono::milliseconds(50)) return;
  drawn_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r%s\033[K", progressText(label_, share, elapsed).c_str());
  std::fflush(stderr);
}

std::string progressText(const std::string& label, double share, double elapsed_seconds) {
  constexpr int width = 30;
  share = std::clamp(share, 0.0, 1.0);
  const auto full = static_cast<std::size_t>(std::lround(share * width));
  std::string text = label + "  [" + std::string(full, '#') + std::string(width - full, '.') + "]  " +
                     std::to_string(std::lround(100 * share)) + " %";
  if (share > 0.02 && share < 1 && elapsed_seconds > 1)
    text += "  " + std::to_string(std::lround(elapsed_seconds * (1 - share) / share)) + " s left";
  return text;
}

}  // namespace shadestep::cli
