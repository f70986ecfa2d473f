// The progress bar of long work: on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace shadestep::cli {

class ProgressBar {
 public:
  // Shows nothing if `quiet`, or if stderr is no terminal.
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();  // removes the bar
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(double share);  // 0..1; redraws at most 20 times a second

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
};

// The bar as text: "clock  [######....]  60 %  4 s left"; the time left once there is something to judge it
// by.
std::string progressText(const std::string& label, double share, double elapsed_seconds);

}  // namespace shadestep::cli
