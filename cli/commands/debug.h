// What the two forms of `shadestep debug` share: one thread's whole run, or one place for all threads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/fragment_options.h"
#include "session/thread_values.h"

namespace shadestep::cli {

struct DebugOptions {
  std::string pixel;
  int hit = -1;
  std::string at;
  std::string iteration;
  std::string call;
  std::string print;
  bool after = false;
  std::string image;
  std::string csv;
  std::string plan = "auto";
  bool let_run = false;
  FragmentOptions fragments;
};

// The whole run of the thread on --pixel.
int debugThread(session::Session&, const Common&, const DebugOptions&);
// Values at --at over all threads.
int debugValues(session::Session&, const Common&, const DebugOptions&);
// Values at --at of the fragment --hit on --pixel.
int debugHit(session::Session&, const Common&, const DebugOptions&);

}  // namespace shadestep::cli
