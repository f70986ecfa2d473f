// Values of chosen variables at one place of the shader, for all threads of the draw at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

// A place in the source, as the user names it.
struct PlaceSelection {
  int line = 0;
  int column = 0;               // 0: the first statement of the line
  std::vector<int> iteration;   // per enclosing loop over the call path, outermost first
  std::vector<int> call_lines;  // lines of the calls that lead to the place, outermost first
  bool after = false;           // after the statement instead of before it
};

// One watched value over all threads.
struct WatchedValues {
  std::string name;
  frontend::Type type;
  std::size_t stride = 0;            // words per thread, in canonical order (frontend::components)
  std::vector<std::uint32_t> words;  // width*height*stride, rows bottom up; 0 where not reached
  std::string no_value = {};  // why there is none, for the user ("" = there is one); then `words` are 0

  const std::uint32_t* at(std::size_t pixel) const { return words.data() + pixel * stride; }
  instrumenter::Value valueAt(std::size_t pixel) const { return {type, {at(pixel), at(pixel) + stride}}; }
};

struct ThreadValues {
  int width = 0, height = 0;
  std::uint64_t launched = 0;       // threads whose fragment is visible, and those that end in a discard
  std::uint64_t reached = 0;        // of these, those that got to the place
  std::uint64_t discarded = 0;      // of these, those that end in a discard
  std::vector<std::uint8_t> marks;  // width*height: instrumenter::kLaunched | kReached | kDiscarded
  // Of other stages than the fragment stage, whose threads lie in one row: who they are, by one value each of
  // "vertex" and "instance", "primitive" and what is on it ("invocation", "vertex", or "u" and "v"), or "x",
  // "y" and "z". Last comes "repeat" where several threads have the same numbers otherwise, as those of
  // different instances have: in the order in which the driver ran them.
  std::vector<WatchedValues> identity;
  std::vector<WatchedValues> values;
  frontend::StatementId statement = frontend::kNone;
  Check check;

  // The thread of this name (of fragments: pixelName); nothing if there is none.
  std::optional<std::size_t> find(const ThreadName&) const;
  bool reachedAt(std::size_t pixel) const { return (marks[pixel] & instrumenter::kReached) != 0; }
};

// The thread of this name. Throws nothing_matches, saying what there is.
std::size_t requireThread(const ThreadValues&, const ThreadName&);

// Runs as many single-probe passes as the watches need and joins them.
// Throws nothing_matches for a place or a name that is not there, saying what is.
ThreadValues valuesAt(Session&, const PlaceSelection&, const std::vector<std::string>& watches);

// The same for a probe; with names, its `watches` are replaced. With `outcome`, the first value is the
// condition's, named "".
ThreadValues valuesAt(Session&, instrumenter::Probe, const std::vector<std::string>& watches);
ThreadValues valuesAt(Session&, instrumenter::Probe);

// What the names mean where the probe is. Throws nothing_matches for what is not in scope or holds no value.
std::vector<frontend::Watch> watchesAt(const frontend::Shader&, const instrumenter::Probe&,
                                       const std::vector<std::string>& names);
frontend::WatchResult watchAt(const frontend::Shader&, const instrumenter::Probe&, const std::string& name);
// The statement whose scope holds at a probe: at the head of a `for`, what its init declares can be named
// too.
frontend::StatementId scopeAt(const frontend::Shader&, const instrumenter::Probe&);

// Takes in one pass over a place: its marks, which must be those of the passes before, its fields and its
// check.
void addPass(ThreadValues&, const ThreadWords&, const instrumenter::AttachmentLayout&, const Check&);

// Takes in what another look at the same place shows of the same threads. Throws failed if they are others.
void join(ThreadValues&, ThreadValues&& part);

// What one pass shows, its threads named.
ThreadValues onePass(Session&, const instrumenter::AttachmentShader&);

// To be called after the last pass: numbers the threads of a dialect that does not tell them apart, and
// leaves one of those that are the same thread (a vertex that several indices name is one, whatever the
// driver makes of it; so is a generated one). Others of the same identity get a number each, "repeat".
void nameThreads(ThreadValues&, Stage, const DrawStop&);

// The statement and call path that a selection means. Throws nothing_matches.
instrumenter::Probe probeAt(const frontend::Shader&, const PlaceSelection&);

// Statistics of one component over all threads that reached the place; none if there is no value.
struct ComponentStatistics {
  std::string access;                 // "" or ".x", "[1].z", ".field[2]"
  double min = 0, max = 0, mean = 0;  // over finite values; 0 when there is none
  std::uint64_t finite = 0, nan = 0, inf = 0;
};
std::vector<ComponentStatistics> statistics(const ThreadValues&, const WatchedValues&);

}  // namespace shadestep::session
