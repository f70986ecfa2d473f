// Probes compiled once and chosen by uniforms: values at any of them, in any iteration, for one draw.
#pragma once

#include <vector>

#include "session/navigation.h"
#include "session/thread_values.h"

namespace shadestep::session {

class Window {
 public:
  // Serves the draw that the session stands at, and no longer. Throws cannot_debug if the text does not fit.
  Window(Session&, std::vector<instrumenter::Probe>);

  // All values of its probe that serves this one, one draw. Assumes that there is one.
  ThreadValues valuesAt(const instrumenter::Probe&);

  std::chrono::nanoseconds compileTime() const { return prepared_.compile_time; }
  std::chrono::nanoseconds drawTime() const { return draw_time_; }  // of the last draw

 private:
  std::size_t find(const instrumenter::Probe&) const;

  Session& session_;
  std::vector<instrumenter::Probe> probes_;
  instrumenter::WindowLayout layout_;
  Prepared prepared_;
  std::chrono::nanoseconds draw_time_{0};
};

// Is a probe at the place of the wanted one, and captures all that this does? Its iterations' values do not
// matter.
bool probeServes(const instrumenter::Probe&, const instrumenter::Probe& wanted);

// What is captured at a position: before its statement, or after its condition with the outcome.
instrumenter::Probe probeAt(const frontend::Shader&, const Position&);

// This probe and those that a walk from its place meets first, both sides of branches and called functions
// too; nearest first. What is in scope there of the names is watched.
std::vector<instrumenter::Probe> probesAround(const frontend::Shader&, const instrumenter::Probe& first,
                                              const std::vector<std::string>& names, std::size_t most);

}  // namespace shadestep::session
