// Breakpoints along the picked thread's recorded way.
#pragma once

#include <functional>
#include <map>

#include "debugger-gui/backend/debuggee.h"

namespace shadestep::gui {

// The thread comes by a breakpoint.
struct Visit {
  int step = 0;  // of its run
  session::Position position;
  int line = 0;
  std::string condition;  // an expression of its values; empty: always
  int ignore = 0;         // of the line's visits at which it holds, so many are passed by first
};

// What conditions were at the visits of one run: asking costs a draw each.
struct KnownConditions {
  RunPtr run;
  std::map<std::pair<int, std::string>, bool> held;
};

// Goes along the visits (in their order) to the next one behind that step, or before it, at which the thread
// stops, and stays there; nothing: at none of them, or cancelled. `asked` hears how many conditions were
// asked for. Throws nothing_matches for a condition that is none.
std::optional<Place> findStop(Debuggee&, const std::vector<Visit>&, int step, bool backwards,
                              KnownConditions&, const std::function<void(std::size_t)>& asked);

}  // namespace shadestep::gui
