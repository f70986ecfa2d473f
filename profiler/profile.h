// What a fragment shader costs, pixel by pixel: three methods that measure different things and must agree in
// rank.
//
//   count    statements executed per thread: exact and repeatable, blind to what a statement costs
//   clock    ticks of the shader clock (GL_ARB_shader_clock, else
//            GL_EXT_shader_realtime_clock) from the start to the end of each thread, in place
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
#include "profiler/counts.h"
#include "profiler/neighbours.h"
#include "profiler/region.h"
#include "profiler/texture_access.h"
#include "profiler/thread_list.h"
#include "session/loops.h"
#include "session/session.h"

namespace shadestep::profiler {

enum class Method { count, clock, isolate, tiles };
const char* methodName(Method);

struct ProfileOptions {
  std::optional<Region> roi;    // nothing else is profiled; parts outside the draw's target are ignored
  int passes = 6;               // clock: draws, at least 2; up to twice as many while they differ. With
                                // `error`: at least so many
  double budget = 12;           // seconds of measuring (isolate, and clock with `error`); may be infinite
  std::optional<double> error;  // stop once the map is known this well: 0.05 = 5% (isolate: of the
                                // reconstruction, with 95% confidence; clock: between halves of the passes)
  std::optional<double>
      share;                // isolate: measure this share of the pixels on a regular grid, no more, no fewer
  std::optional<int> size;  // isolate: fragments per side of a measured draw, instead of a calibrated number
  int repeats = 5;          // isolate: draws of a measured pixel; at least 2
  bool quads = false;       // isolate: measure quads even where the shader would not need them
  bool lines = true;        // also count executions per line, branch, call, lookup and loop
  bool textures = false;    // also map where textures are read (profileBy)
  bool neighbours = false;  // clock: also what each pixel pays for its neighbours, by isolate (profileBy)
  // Called now and then with the share done, 0..1.
  std::function<void(double)> progress;
  // Asked now and then: true ends measuring; what was measured until then is the result.
  std::function<bool()> stop;
};

// How well a map is known of which not all pixels were measured: by pixels that were, but are withheld from
// the reconstruction, in turns. No held-out pixels: the errors are not known (NaN).
struct Reconstruction {
  std::size_t held_out = 0;
  // Root mean square of (map - truth), over the mean of what was measured. A held-out pixel has noise of its
  // own, which is not in it: that of the two halves of its repeats is independent, so the mean of
  // (reconstructed - one half) (reconstructed - other half) lacks it.
  double error = 0;
  double error_below = 0;   // with 95% confidence
  double median_error = 0;  // median of |reconstructed - measured| / measured, with that noise
  double total_error = 0;   // of the sum over all pixels: 95% half width, as a share of the sum
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
  std::optional<double> share;  // of the whole cost: by `count` exactly, else by the fit of costs to counts
  // Lines of the same number run equally often in every thread: the fit cannot tell them apart, and divides
  // what it finds for all by how many operations stand on each.
  std::size_t together = 0;
};

struct BranchCost {
  int line = 0, column = 0;
  std::string kind;  // "if", "for", "while", "do"
  std::uint64_t evaluated = 0, taken = 0;
  double active_share = 0;  // activeShare of the evaluations, in groups of Profile::grain
  double taken_share = 0;   // activeShare of what is behind the condition
};

struct FunctionCalls {
  std::string name;
  int line = 0;
  std::uint64_t calls = 0;
};

struct SamplerFetches {
  std::string sampler;   // as written at the lookup
  std::string function;  // "texture", ...
  int line = 0;
  std::uint64_t fetches = 0;
};

struct LoopCost {
  session::LoopReport report;
  double active_share = 0;  // iterations done over those that the slowest of each group makes all wait for
  // The critical path: threads that are still in the loop when less than 1% of those that entered are.
  std::uint32_t critical_from = 0;            // iteration
  std::vector<std::pair<int, int>> critical;  // their pixels, those that stay longest first; 16 at most
  std::uint64_t critical_threads = 0;
};

// Costs of lines from costs of pixels.
struct LineFit {
  double r2 = 0;           // of the pixels' variance, explained by the counts
  double start_share = 0;  // cost that every thread has, whatever it does, as a share of all
  std::size_t rows = 0;    // pixels, or groups of pixels, in the fit
};

struct Profile {
  Method method = Method::count;
  session::Stage stage = session::Stage::fragment;
  ThreadList threads;  // of other stages than the fragment stage: who each is; thread i has cost i of the map
  std::string unit;    // of a pixel's cost: "statements", "ticks", "ns"
  CostMap map;
  std::vector<double> uncertainty;        // per pixel: 95% half width, same unit; 0 where exact or not known
  std::size_t covered = 0;                // pixels on which a thread of the draw is visible (in the region)
  std::size_t measured = 0;               // of these
  int passes = 1;                         // measurements per measured pixel
  double seconds = 0;                     // the whole profile took
  double total = 0, median = 0, p95 = 0;  // over all covered pixels
  // How much the result would differ, had it been measured again: the median over pixels of the difference
  // between what the even and what the odd repeats alone give, relative; scaled to all repeats.
  double spread = 0;
  // What a step of known work costs in the same unit: makes runs on a faster and a slower day comparable. 0:
  // none.
  double yardstick = 0;
  double yardstick_noise = 0;  // 95% half width, relative
  Grain grain;                 // pixels that share a cost: a SIMD group (clock), a quad (isolate)
  // Per pixel: 1 where the threads of its grain do not all do the same, as far as is counted. Empty: not
  // counted.
  std::vector<std::uint8_t> diverging;
  Halves halves;                                 // per pixel: what half of the repeats say; empty where exact
  std::vector<double> statements;                // per pixel: executed ones, where counted
  std::optional<NeighbourCost> neighbours;       // where asked for
  std::string timer;                             // isolate: "CPU time" or "wall clock"
  bool interrupted = false;                      // by ProfileOptions::stop
  std::optional<Reconstruction> reconstruction;  // where not all covered pixels were measured
  std::optional<SameOutput> same_output;         // isolate only
  std::vector<LineCost> lines;                   // lines that ran or could have run, in order
  std::optional<LineFit> fit;                    // where `share` comes from one
  std::vector<BranchCost> branches;
  std::vector<FunctionCalls> functions;
  std::vector<SamplerFetches> samplers;
  std::vector<LoopCost> loops;
  std::optional<TextureAccesses> textures;  // where asked for
  session::Check check;                     // of all instrumented replays of the draw
  std::vector<std::string> notes;  // what a reader must know to read the numbers right, a sentence each
};

// Of the selected stage; the others measure fragments only.
Profile profileCount(session::Session&, const ProfileOptions&);
Profile profileClock(session::Session&, const ProfileOptions&);
Profile profileIsolate(session::Session&, const ProfileOptions&);

// What the draw takes in each tile of its target, whatever runs there: the only method for programs without
// GLSL source (binaries, SPIR-V), assembly programs and none. Every pixel of a tile has the same cost.
Profile profileTiles(session::Session&, const ProfileOptions&);

// The best that works here: clock, else isolate, else count, or tiles where there is no source; why the
// better ones do not stands in the notes.
Profile profileAuto(session::Session&, const ProfileOptions&);

// By the method of this name: "count", "clock", "isolate", "tiles"; any other: profileAuto. With `textures`
// where it looks up textures, which throws as mapTextures does.
Profile profileBy(const std::string& method, session::Session&, const ProfileOptions&);

}  // namespace shadestep::profiler
