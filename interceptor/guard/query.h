// The current context's values. Runs inside the program under debug: GL only through dispatch::gl().
#pragma once

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

inline GLint integer(GLenum name) {
  GLint value = 0;
  dispatch::gl().GetIntegerv(name, &value);
  return value;
}

}  // namespace shadestep::guard
