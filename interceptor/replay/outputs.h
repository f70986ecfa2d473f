// Where the outputs of an instrumented fragment shader go: its own to the places that they have in the
// original, captures to draw buffers that are neither one of its outputs nor used by the program's
// framebuffer. Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <set>
#include <string>
#include <vector>

#include "interceptor/capture/draw_target.h"
#include "interceptor/capture/shadow.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/refusal.h"
#include "wire/messages_generated.h"

namespace shadestep::replay {

struct UserOutputs {
  std::set<int> locations;
  // Drivers hand on the second source of blending as the output after the first: no place for captures.
  std::set<int> second_sources;
};

// Before the link: the outputs named keep their locations, of at most `most`.
UserOutputs bindUserOutputs(GLuint original, GLuint copy, const std::vector<std::string>& outputs, int most);

// Before the link: gives every capture a location that is not in `taken`.
guard::OrRefusal<std::vector<capture::CaptureBuffer>> bindCaptures(const guard::ContextFacts&,
                                                                   const capture::DrawTarget&,
                                                                   const wire::PrepareT&, GLuint copy,
                                                                   std::set<int> taken);

// After the link, because the driver has the last word: a layout in the text overrides what was bound.
guard::Refusal confirmCaptures(const guard::ContextFacts&, const capture::DrawTarget&, const wire::PrepareT&,
                               GLuint copy, std::vector<capture::CaptureBuffer>& captures);

}  // namespace shadestep::replay
