// Which pixels and which values `verify` looks at.
#pragma once

#include <string>
#include <vector>

#include "session/thread_values.h"

namespace shadestep::session {

struct Pixel {
  int x = 0, y = 0;
  bool discarded = false;  // it shows no thread, and what is looked at there is one that ends in a discard
};
std::string where(const Pixel&);  // "pixel 3,4"

// A pixel's visible thread, recorded.
struct RecordedPixel {
  Pixel pixel;
  Session::Recorded recorded;
  int thread = -1;  // that the pixel shows

  const instrumenter::ThreadRecording& run() const {
    return recorded.recording.threads[static_cast<std::size_t>(thread)];
  }
};

// Spread over what the draw covers: its first and last pixel, the one nearest to its centre, random ones.
std::vector<Pixel> choosePixels(const ThreadValues& cover, int most);

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

bool isForInit(const frontend::Shader&, const frontend::Statement&);

}  // namespace shadestep::session
