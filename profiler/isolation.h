// One pixel's thread on its own: its inputs captured once for all pixels, then handed to n x n identical
// fragments as uniforms (Strengert 2010, 7.2.1). Internal.
#pragma once

#include <span>
#include <vector>

#include "profiler/profile.h"

namespace shadestep::profiler {

class Isolation {
 public:
  // Captures the inputs of all threads and prepares the isolated shader and the empty one with the same
  // interface. Throws session::Error where that does not work.
  Isolation(session::Session&, const ProfileOptions&);

  // The pixels that have a thread, all `measured`.
  const CostMap& covered() const { return covered_; }
  const session::Check& check() const { return check_; }

  // Nanoseconds of `repeats` draws of size x size fragments, all doing the work of one pixel's thread.
  std::vector<double> time(std::size_t pixel, int size, int repeats);
  // The same draws without the work.
  std::vector<double> timeBaseline(std::size_t pixel, int size, int repeats);
  // Compares the colour outputs of these pixels' threads, alone, with those of the program's own draw.
  SameOutput compareOutputs(const std::vector<std::size_t>& pixels);

 private:
  // The captured values of one input.
  struct Input {
    session::Uniform uniform;          // without words
    std::vector<std::uint32_t> words;  // per pixel
    std::size_t words_per_pixel = 0;
  };
  void captureInputs(const std::vector<instrumenter::IsolatedInput>&, const ProfileOptions&);
  void keep(const session::Captured&, const std::vector<instrumenter::IsolatedInput>&);
  session::ExecuteOptions optionsFor(std::size_t pixel, int size) const;
  std::vector<double> draw(const session::Prepared&, std::size_t pixel, int size, int repeats);

  session::Session& session_;
  CostMap covered_;
  session::Check check_;
  std::vector<Input> inputs_;
  session::Prepared isolated_, baseline_;
};

}  // namespace shadestep::profiler
