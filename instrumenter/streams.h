// The vertex streams of geometry shaders (GLSL 4.00, 4.4.2).
#pragma once

#include <string>

#include "glsl-frontend/shader.h"

namespace shadestep::instrumenter {

// The stream that an output belongs to, by its own name or that in transform feedback (feedbackOutputs): as its
// declaration, its block's, or the last default before it says; 0 of all others.
int streamOf(const frontend::Shader&, const std::string& name);

}  // namespace shadestep::instrumenter
