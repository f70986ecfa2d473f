// What a draw would be carried out with: the answer to Describe.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/calls/hooks.h"
#include "interceptor/calls/tracking.h"
#include "interceptor/capture/draw_target.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/replay/pipeline.h"
#include "interceptor/replay/program_copy.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

// The facts of one stop, asked once.
struct DrawFacts {
  guard::ContextFacts context;
  GLuint program = 0;                        // the current one, or the one of the pipeline's fragment stage
  GLuint pipeline = 0;                       // 0: a program is current
  std::vector<replay::StageProgram> stages;  // with a pipeline: where each stage comes from
  std::string program_reason;                // why there is nothing to debug ("" if there is)
  std::shared_ptr<const calls::LinkedProgram> linked;
  capture::DrawTarget target;   // its reason also says why this draw cannot be replayed
  std::string replay_reason;    // why it cannot, even without a target ("" if it can)
  int feedback_components = 0;  // that transform feedback can take at this draw
  bool draws_points = false;    // the call can be replayed with other primitives
  GLenum index_type = 0;        // GL_UNSIGNED_SHORT, ...; 0: the call reads no indices
};

DrawFacts drawFacts(const calls::DrawCall&);
// The program that a stage of the draw comes from. Keeps a reference to the facts.
replay::Original originalOf(const DrawFacts&, wire::Stage);
wire::DrawT describe(const DrawFacts&);

}  // namespace shadestep::agent
