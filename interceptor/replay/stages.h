// The stages of a draw up to one of them, and what transform feedback gets from the last.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <string>
#include <vector>

#include "interceptor/capture/feedback.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"
#include "wire/messages_generated.h"

namespace shadestep::replay {

GLenum shaderType(wire::Stage);
const char* stageWord(GLenum type);  // "vertex", "tessellation control", ...

// Whether a replay of the stages up to `last` has the shaders of this type.
bool runsUpTo(GLenum type, wire::Stage last);

// Before the link: the outputs that transform feedback gets, in this order.
void setFeedbackVaryings(const guard::ContextFacts&, GLuint program, const wire::PrepareT&);
// Before the link: those of the original.
void copyFeedbackVaryings(const guard::ContextFacts&, GLuint original, GLuint copy);
// After it: what the program gives to transform feedback.
capture::FeedbackLayout feedbackLayout(GLuint program, const wire::PrepareT&);

}  // namespace shadestep::replay
