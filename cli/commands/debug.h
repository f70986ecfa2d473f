// What the two forms of `shadestep debug` share: one thread's whole run, or one place for all threads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/fragment_options.h"
#include "cli/thread_options.h"
#include "session/thread_values.h"

namespace shadestep::cli {

struct DebugOptions : ThreadOptions {
  int hit = -1;
  std::string at;
  std::string iteration;
  std::string call;
  std::string print;
  bool after = false, pixels = false;
  std::string image;
  std::string csv, scatter;
  std::string plan = "auto";
  bool let_run = false;
  FragmentOptions fragments;
};

// The whole run of the thread on --pixel, or, of other stages, of the one chosen.
int debugThread(session::Session&, const Common&, const DebugOptions&);
// The runs of the selected stage, which is an earlier one, that the fragment on --pixel comes from.
int debugOrigin(session::Session&, const Common&, const DebugOptions&);
// The pixels that the chosen vertex touched.
int debugPixels(session::Session&, const Common&, const DebugOptions&);
// Values at --at over all threads.
int debugValues(session::Session&, const Common&, const DebugOptions&);
// Values at --at of the fragment --hit on --pixel.
int debugHit(session::Session&, const Common&, const DebugOptions&);

}  // namespace shadestep::cli
