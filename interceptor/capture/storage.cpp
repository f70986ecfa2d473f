// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/storage.h"

#include <algorithm>
#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

// Zeros are uploaded in pieces where the driver cannot clear a buffer itself.
constexpr std::uint32_t kZeros[16 * 1024] = {};

void clear(std::uint64_t bytes) {
  if (dispatch::available("glClearBufferData")) {
    gl().ClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
    if (!guard::clearErrors()) return;
  }
  for (std::uint64_t at = 0; at < bytes; at += sizeof kZeros) {
    gl().BufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(at),
                       static_cast<GLsizeiptr>(std::min<std::uint64_t>(sizeof kZeros, bytes - at)), kZeros);
  }
}

}  // namespace

StorageBuffer::~StorageBuffer() {
  release();
}

void StorageBuffer::release() {
  if (buffer_ != 0) gl().DeleteBuffers(1, &buffer_);
  buffer_ = 0;
  words_ = 0;
}

guard::Refusal StorageBuffer::reset(const std::vector<std::uint32_t>& initial, std::uint64_t words) {
  const std::uint64_t size = std::max<std::uint64_t>({words, initial.size(), 1});
  GLint64 most = 0;
  gl().GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (size > static_cast<std::uint64_t>(most) / 4) {
    return guard::limit("a storage buffer of " + std::to_string(size) +
                        " words is asked for; this driver allows " + std::to_string(most / 4) +
                        " (GL_MAX_SHADER_STORAGE_BLOCK_SIZE)");
  }
  if (buffer_ == 0) gl().GenBuffers(1, &buffer_);
  gl().BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
  if (size != words_) {
    gl().BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(size * 4), nullptr, GL_DYNAMIC_READ);
    if (guard::clearErrors()) {
      words_ = 0;
      return guard::limit("the driver has no memory for a storage buffer of " + std::to_string(size) +
                          " words");
    }
    words_ = size;
  }
  clear(size * 4);
  if (!initial.empty()) {
    gl().BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(initial.size() * 4),
                       initial.data());
  }
  return {};
}

void StorageBuffer::bind(int index) const {
  gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(index), buffer_);
}

void StorageBuffer::read(void* words) const {
  gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl().BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
  // Mapped, because OpenGL ES has no glGetBufferSubData. An error is left to the caller.
  const std::size_t bytes = words_ * 4;
  const void* mapped =
      gl().MapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT);
  if (mapped == nullptr) return;
  std::memcpy(words, mapped, bytes);
  gl().UnmapBuffer(GL_SHADER_STORAGE_BUFFER);
}

}  // namespace shadestep::capture
