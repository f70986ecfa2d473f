// The bytes of the program's buffers: copied on the GPU, and read by way of a buffer of the agent's own,
// because the program may have mapped its own for good. Runs inside the program under debug: throws nothing,
// starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <cstddef>

#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

// The buffer bindings of copies, GL_COPY_READ_BUFFER and GL_COPY_WRITE_BUFFER, put back when it goes. What
// follows wants one.
class CopyBindingGuard {
 public:
  CopyBindingGuard();
  ~CopyBindingGuard();
  CopyBindingGuard(const CopyBindingGuard&) = delete;
  CopyBindingGuard& operator=(const CopyBindingGuard&) = delete;

 private:
  GLuint read_, write_;
};

void copyBytes(GLuint from, GLint64 from_offset, GLuint to, GLint64 to_offset, GLint64 bytes);

// A buffer of the agent's own; bound for writing copies. 0: no memory.
GLuint makeBuffer(GLint64 bytes);

// False: there is no memory for a copy, or the buffer does not let itself be copied, as one that is mapped
// (not for good).
bool readBytes(GLuint buffer, GLint64 offset, GLint64 bytes, std::byte* destination);

// 0 for what is no buffer.
GLint64 bufferSize(GLuint buffer);

}  // namespace shadestep::guard
