// Values at one place for one of several fragments on a pixel, hidden and discarded ones included: only a
// recording tells them apart.
#pragma once

#include <string>
#include <vector>

#include "session/recorded_visits.h"
#include "session/thread_run.h"
#include "session/thread_values.h"

namespace shadestep::session {

struct HitValues {
  PixelHits hits;
  int hit = 0;
  bool reached = false;  // it gets to the place; else there are no values
  std::vector<NamedValue> values;
  Check check;
};

// What a recorded thread had in a variable, or a part of one. Throws cannot_debug for what is not recorded.
instrumenter::Value recordedValue(const frontend::Shader&, const LastVisit&, const frontend::Watch&);

// Throws nothing_matches for a pixel, a hit, a place or a name that is not there, cannot_debug where the
// driver cannot record, for a place inside a chosen call, and for names that a recording does not hold (what
// the shader itself never sets: inputs and uniforms).
HitValues valuesOfHit(Session&, int x, int y, int hit, const PlaceSelection&,
                      const std::vector<std::string>& watches);

}  // namespace shadestep::session
