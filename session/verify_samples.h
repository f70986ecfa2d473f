// Which threads and which values `verify` looks at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/thread_values.h"

namespace shadestep::session {

struct ChosenThread {
  ThreadName name;
  bool discarded =
      false;  // the pixel shows no thread, and what is looked at there is one that ends in a discard
};
std::string where(const ThreadName&);  // "pixel 3,4", "vertex 3, instance 0"

// The name of the thread at this place.
ThreadName nameOf(const ThreadValues&, std::size_t thread);

// A thread, recorded.
struct RecordedThread {
  ChosenThread chosen;
  Session::Recorded recorded;
  int thread = -1;  // of the recorded ones: the one that the pixel shows, or that has the name

  const instrumenter::ThreadRecording& run() const {
    return recorded.recording.threads[static_cast<std::size_t>(thread)];
  }
};

// Spread over all of them: the first and the last, the one nearest to their centre, random ones. Threads that
// only their order tells apart from others are left out, as long as there are others.
std::vector<ChosenThread> chooseThreads(const ThreadValues& all, int most);

// A variable, or a part of one, as it is watched.
struct Part {
  frontend::VariableId variable = frontend::kNone;
  std::string expression;
  frontend::Type type;
  std::size_t first_word = 0;  // in the variable's value
};

// All that has a value at the probe, wide values in parts.
std::vector<Part> partsInScope(const frontend::Shader&, const instrumenter::Probe&);

// May words of the variable be read before the shader has given them a value? Two plans may then differ in
// them.
bool mayBeUndefined(const frontend::Shader&, frontend::VariableId);

// Whether two captures of the same value agree: bit for bit, but for floats of mediump and lowp in GLSL ES,
// which the driver may round to 16 bits in one pass and not in the other: to two units in the last of their
// 11 binary digits. Both are `part`'s words.
bool agree(const frontend::Shader&, const Part& part, const std::uint32_t* one, const std::uint32_t* other);

bool isForInit(const frontend::Shader&, const frontend::Statement&);

}  // namespace shadestep::session
