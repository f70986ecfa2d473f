// The types of uniforms and of what transform feedback writes (OpenGL 4.6, table 7.3;
// GL_ARB_gpu_shader_int64).
#pragma once

#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

enum class Scalar { float_, int_, uint_, double_, int64_, uint64_ };

struct ValueType {
  GLenum type;
  Scalar scalar;
  int rows, columns;  // columns > 1: a matrix
  bool wide() const {
    return scalar == Scalar::double_ || scalar == Scalar::int64_ || scalar == Scalar::uint64_;
  }
  int components() const { return rows * columns; }
  int words() const { return components() * (wide() ? 2 : 1); }
};

// Null for samplers, images and all that has no number of its own.
const ValueType* valueType(GLenum type);

}  // namespace shadestep::guard
