// The program's GL error flags. What the program caused before a stop it is still told after it; what the
// agent caused it never hears of.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

// For as long as it lives the driver's error flag is the agent's; errors that were pending at its start wait.
class ErrorGuard {
 public:
  ErrorGuard();
  ~ErrorGuard();
  ErrorGuard(const ErrorGuard&) = delete;
  ErrorGuard& operator=(const ErrorGuard&) = delete;
};

// What the driver's error flag says now; the program will still be told. GL_NO_ERROR if nothing.
GLenum peekError();

// What glGetError tells the program: a waiting error of its current context first, then the driver's.
GLenum programError();

// Forgets what waits for a context that is gone.
void forgetErrors(const void* context);

// Empties the driver's error flag; true if there was an error.
bool clearErrors();

}  // namespace shadestep::guard
