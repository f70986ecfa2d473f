// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/buffer_bytes.h"

#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

GLuint binding(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return static_cast<GLuint>(value);
}

}  // namespace

CopyBindingGuard::CopyBindingGuard()
    : read_(binding(GL_COPY_READ_BUFFER_BINDING)), write_(binding(GL_COPY_WRITE_BUFFER_BINDING)) {}

CopyBindingGuard::~CopyBindingGuard() {
  gl().BindBuffer(GL_COPY_READ_BUFFER, read_);
  gl().BindBuffer(GL_COPY_WRITE_BUFFER, write_);
}

void copyBytes(GLuint from, GLint64 from_offset, GLuint to, GLint64 to_offset, GLint64 bytes) {
  gl().BindBuffer(GL_COPY_READ_BUFFER, from);
  gl().BindBuffer(GL_COPY_WRITE_BUFFER, to);
  gl().CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(from_offset),
                         static_cast<GLintptr>(to_offset), static_cast<GLsizeiptr>(bytes));
}

GLuint makeBuffer(GLint64 bytes) {
  GLuint buffer = 0;
  gl().GenBuffers(1, &buffer);
  gl().BindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  gl().BufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
  if (!clearErrors()) return buffer;
  gl().DeleteBuffers(1, &buffer);
  return 0;
}

bool readBytes(GLuint buffer, GLint64 offset, GLint64 bytes, std::byte* destination) {
  const GLuint copy = makeBuffer(bytes);
  if (copy == 0) return false;
  copyBytes(buffer, offset, copy, 0, bytes);
  const bool copied = !clearErrors();
  const void* mapped =
      copied ? gl().MapBufferRange(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT)
             : nullptr;
  if (mapped != nullptr) std::memcpy(destination, mapped, static_cast<std::size_t>(bytes));
  gl().DeleteBuffers(1, &copy);  // which unmaps it
  return mapped != nullptr;
}

GLint64 bufferSize(GLuint buffer) {
  gl().BindBuffer(GL_COPY_READ_BUFFER, buffer);
  GLint64 size = 0;
  if (dispatch::available("glGetBufferParameteri64v")) {
    gl().GetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
  } else {
    GLint small = 0;
    gl().GetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &small);
    size = small;
  }
  return clearErrors() ? 0 : size;
}

}  // namespace shadestep::guard
