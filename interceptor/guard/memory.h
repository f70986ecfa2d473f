// What a draw's shaders can write besides their outputs: ranges of buffers bound as storage or atomic counter
// buffers, and the images at image units. Saved as it is when a stop begins, by copies on the GPU, and put
// back before every replay and after the last: the program's own draw then writes it once, not once a replay.
// (Transform feedback buffers are not written: the feedback pauses, see ProgramGuard.)
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <set>
#include <string>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/guard/section.h"
#include "interceptor/guard/texture_level.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

// Indexed bindings that a program's shaders can write to.
struct WritableBindings {
  std::set<GLuint> storage;   // of GL_SHADER_STORAGE_BUFFER
  std::set<GLuint> counters;  // of GL_ATOMIC_COUNTER_BUFFER
  std::set<GLuint> images;    // image units
};

class WritableMemory {
 public:
  explicit WritableMemory(const ContextFacts& facts) : facts_(facts) {}
  ~WritableMemory();
  WritableMemory(const WritableMemory&) = delete;
  WritableMemory& operator=(const WritableMemory&) = delete;

  // Saves what is bound there and not saved yet. Everything saved before must be as it was then.
  // Empty text: done.
  Refusal save(const WritableBindings&);
  void restore() const;

  // What is saved, as it is now. The caller holds the guards of framebuffers and of pixel reads.
  std::vector<Section> sections() const;
  Refusal read(std::byte*) const;

 private:
  struct BufferRange {
    std::string name;
    GLuint buffer;
    GLint64 offset, bytes;
    GLuint copy;
  };
  struct Image {
    std::string name;
    GLuint texture;
    GLint level;
    TextureLevel shape;
    GLuint copy;
  };
  Refusal saveBinding(GLenum target, GLenum start, GLenum size, GLuint index, const std::string& name);
  Refusal saveRange(BufferRange);
  Refusal saveImage(GLuint unit);
  void readImage(const Image&, std::byte*) const;
  std::size_t texelBytes(const Image&) const;

  const ContextFacts& facts_;
  std::vector<BufferRange> ranges_;
  std::vector<Image> images_;
};

// Puts the memory back when it goes, however the replays between went.
class MemoryGuard {
 public:
  explicit MemoryGuard(const WritableMemory& memory) : memory_(memory) {}
  ~MemoryGuard() { memory_.restore(); }
  MemoryGuard(const MemoryGuard&) = delete;
  MemoryGuard& operator=(const MemoryGuard&) = delete;

 private:
  const WritableMemory& memory_;
};

}  // namespace shadestep::guard
