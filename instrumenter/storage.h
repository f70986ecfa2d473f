// Storage buffers in instrumented shaders: what they need, and where they cannot be had.
#pragma once

#include <string>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// Why the shader cannot declare a storage block; empty if it can.
std::string noStorage(const frontend::Shader&, const Target&);

// A text that declares a storage block, with the binding that its `layout(std430` needs in the shader's dialect.
std::string inStorage(const Draft&, std::string declaration);

// Has the extensions switched on that storage blocks need in the shader's dialect.
void requireStorage(Draft&);

}  // namespace shadestep::instrumenter
