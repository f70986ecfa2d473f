// What a fragment shader costs, pixel by pixel: three methods that measure different things and must agree in
// rank.
//
//   count    statements executed per thread: exact and repeatable, blind to what a statement costs
//   clock    GL_ARB_shader_clock ticks from the start to the end of each thread, in place
//   isolate  Strengert 2010, 7.2.1: the thread of one pixel drawn n x n times on its own, timed on the CPU's
//   clock
//
// All three throw session::Error: cannot_debug with the reason where the method does not work on this draw or
// driver.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "profiler/cost_map.h"
#include "session/session.h"

namespace shadestep::profiler {

enum class Method { count, clock, isolate };
const char* methodName(Method);

// Pixels, lower left corner and size; gl_FragCoord's origin.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;
  bool contains(int px, int py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

struct ProfileOptions {
  std::optional<Region> roi;  // nothing else is profiled; parts outside the draw's target are ignored
  int passes = 5;             // clock: draws, of which each pixel's median counts; at least 1
  double budget = 12;         // isolate: seconds of measuring
  bool lines = true;          // also count executions per source line
  // Called now and then with the share done, 0..1.
  std::function<void(double)> progress;
};

// How well pixels that were not measured are known: pixels measured but withheld from the reconstruction, and
// the median over them of |reconstructed - measured| / measured. No held-out pixels: the error is not known
// (NaN).
struct Reconstruction {
  std::size_t held_out = 0;
  double error = 0;
};

// isolate: does a thread alone compute what it computes in the program's draw? Of the pixels tried, how many
// have bit for bit the same colour outputs. Blending and overlapping fragments make them differ too, so this
// judges the method only where the draw has neither.
struct SameOutput {
  std::size_t tried = 0, same = 0;
};

struct LineCost {
  int line = 0;
  std::uint64_t hits = 0;       // executions of statements that begin on the line, over all profiled threads
  std::optional<double> share;  // of the whole cost; only `count` can tell it
};

struct Profile {
  Method method = Method::count;
  std::string unit;  // of a pixel's cost: "statements", "ticks", "ns"
  CostMap map;
  std::size_t covered = 0;                // pixels on which a thread of the draw is visible (in the region)
  std::size_t measured = 0;               // of these
  int passes = 1;                         // measurements per measured pixel
  double seconds = 0;                     // the whole profile took
  double total = 0, median = 0, p95 = 0;  // over all covered pixels
  double spread = 0;  // median over pixels of the relative spread of its repeats (relativeSpread)
  std::optional<Reconstruction> reconstruction;  // where not all covered pixels were measured
  std::optional<SameOutput> same_output;         // isolate only
  std::vector<LineCost> lines;                   // lines that ran or could have run, in order
  session::Check check;                          // of all instrumented replays of the draw
  std::vector<std::string> notes;  // what a reader must know to read the numbers right, a sentence each
};

Profile profileCount(session::Session&, const ProfileOptions&);
Profile profileClock(session::Session&, const ProfileOptions&);
Profile profileIsolate(session::Session&, const ProfileOptions&);

// The best that works here: clock, else isolate, else count; why the better ones do not stands in the notes.
Profile profileAuto(session::Session&, const ProfileOptions&);

}  // namespace shadestep::profiler
