// Where captures stand in the text: each behind the counters of the loops that its probe numbers, in the
// copies of the functions that its calls lead through.
#pragma once

#include <string>
#include <vector>

#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/function.h"

namespace shadestep::instrumenter {

// Why nothing can be captured at the probe's place; empty if it can.
std::string misplaced(const frontend::Shader&, const Probe&);

// The outcome that a probe with `outcome` captures: its type, and how it reads in the text of the capture.
frontend::Type outcomeType(const frontend::Shader&, const Probe&);
std::string outcomeText(const Draft&, Conditions&, const Probe&);

// The uniform whose value is the number of the probe that captures, from 0; returns its name.
std::string declareProbe(Draft&);

// What runs at a probe's place, and when.
struct Placed {
  Probe probe;
  std::string guard;                 // GLSL condition, "" = always
  std::vector<std::string> numbers;  // GLSL expressions, what the counters of the numbered loops must be
  std::string capture;               // comma-separated GLSL expressions
};

// Registers the counters and the captures of all probes. Loops are counted once, however many probes number
// them. Assumes that the probes are not misplaced. Captures under a condition hide the bounds of loops
// (constructs/loop_bounds.h).
void place(Draft&, Conditions&, CallPaths&, const std::vector<Placed>&);

}  // namespace shadestep::instrumenter
