// One thread (or the four of a pixel's quad) on its own: the inputs captured once for all threads, then
// handed to n x n fragments (Strengert 2010, 7.2.1); of a vertex or an invocation to all threads of the
// program's own call. Below a vertex or an invocation is a pixel of the map, too. Internal.
#pragma once

#include <random>
#include <span>
#include <vector>

#include "instrumenter/measures.h"
#include "profiler/profile.h"

namespace shadestep::profiler {

// Which of the two clocks of a draw is believed.
struct Timer {
  enum class Kind { cpu, wall } kind = Kind::cpu;
  const char* name() const { return kind == Kind::cpu ? "CPU time" : "wall clock"; }
};
// Times of one, two and three times the same work, as a timer gave them: does it run in proportion? `ratio`:
// what the two added thirds took over what one took; 2 is right.
struct TimerTest {
  bool trusted = false;
  double ratio = 0;
};
TimerTest testTimer(double once, double twice, double thrice);

class Isolation {
 public:
  // Captures the inputs of all threads, prepares the isolated shader, the empty one with the same outputs and
  // one of known work, and chooses the timer. Quads where the shader uses derivatives or implicit levels of
  // detail, or where asked for. Throws session::Error where that does not work, or no timer can be trusted.
  Isolation(session::Session&, const ProfileOptions&);

  // The pixels that have a thread, all `measured`; of other stages who they are.
  const CostMap& covered() const { return place_.map; }
  const ThreadList& threads() const { return place_.threads; }
  // How many threads a draw of this size has: other stages' call has what it has.
  double threadsDrawn(int size) const;
  const session::Check& check() const { return check_; }
  bool quads() const { return mode_ == instrumenter::Isolation::quad; }
  const Timer& timer() const { return timer_; }
  // CPU time cannot be had of a device of its own; why the other timer was not taken.
  const std::string& timerNote() const { return timer_note_; }
  // Quads with a neighbour outside the draw, whose inputs are continued linearly from inside.
  std::size_t continued() const { return continued_; }

  // Nanoseconds of draws of size x size fragments, all doing the work of one pixel's thread (of its quad's):
  // result[pixel][repeat]. All pixels are drawn once, then all again in another order.
  std::vector<std::vector<double>> time(std::span<const std::size_t> pixels, int size, int repeats);
  // The same draws without the work.
  std::vector<double> timeBaseline(int size, int repeats);
  // The same draws with `steps` steps of known work.
  std::vector<double> timeKnown(int size, int steps, int repeats);

  // Compares the colour outputs of these pixels' threads, alone, with those of the program's own draw.
  // Other stages: what transform feedback gets of them; none tried where there is nothing of the kind.
  SameOutput compareOutputs(const std::vector<std::size_t>& pixels);

 private:
  void captureInputs(const std::vector<instrumenter::IsolatedInput>&, const ProfileOptions&);
  void keep(const session::Captured&, const std::vector<instrumenter::IsolatedInput>&);
  void prepare();
  SameOutput compareColors(const std::vector<std::size_t>& pixels);
  SameOutput compareRecords(const std::vector<std::size_t>& pixels);
  void chooseTimer();
  std::vector<session::Uniform> inputsOf(std::size_t pixel);
  std::vector<std::uint32_t> wordsAt(int x, int y, int fallback_x, int fallback_y);
  std::vector<double> draw(const session::Prepared&, const session::ExecuteOptions&);

  session::Session& session_;
  session::Stage stage_;
  Profile place_;  // only where threads have their place
  session::Check check_;
  instrumenter::Isolation mode_ = instrumenter::Isolation::plain;
  instrumenter::IsolatedShader shader_;
  std::vector<std::uint32_t> words_;    // 4 * vectors_per_thread for each pixel
  std::vector<std::uint8_t> is_float_;  // per word of a thread: may be continued linearly
  session::Prepared isolated_, baseline_, known_;
  std::string work_uniform_;  // of `known_`
  Timer timer_;
  std::string timer_note_;
  std::size_t continued_ = 0;
  std::mt19937 random_{1};
};

}  // namespace shadestep::profiler
