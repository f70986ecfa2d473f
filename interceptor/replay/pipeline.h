// Program pipeline objects: each stage of the draw may come from a program of its own.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <set>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::replay {

struct StageProgram {
  GLenum stage = 0;  // GL_FRAGMENT_SHADER, ...
  GLuint program = 0;
};

// The stages of the bound pipeline that have a program.
std::vector<StageProgram> pipelineStages(GLuint pipeline);

// A pipeline of the agent's own with the same programs, but `copy`, which is separable, in place of
// `original`.
GLuint copyPipeline(const std::vector<StageProgram>&, GLuint original, GLuint copy);

}  // namespace shadestep::replay
