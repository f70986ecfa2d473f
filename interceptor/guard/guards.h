// State that the agent touches, put back at the end of a scope. Every class saves one group when it is made
// and restores it when it goes; nothing relies on attribute stacks, which core profiles lack and which can be
// full. Method: Strengert 2010, 7.1.5. Runs inside the program under debug: throws nothing, starts no thread,
// calls GL only through dispatch::gl().
#pragma once

#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

// How many indexed viewports, and scissor tests, there are: 0 = they are not indexed.
int viewportCount(const ContextFacts&);

// A capability of glEnable for all indices that it has.
class CapabilityGuard {
 public:
  // `indices` > 0: the capability is indexed (viewports, draw buffers).
  explicit CapabilityGuard(GLenum capability, int indices = 0);
  ~CapabilityGuard() { restore(); }
  CapabilityGuard(const CapabilityGuard&) = delete;
  CapabilityGuard& operator=(const CapabilityGuard&) = delete;
  void enable() const;
  void disable() const;
  void restore() const;

 private:
  GLenum capability_;
  bool indexed_;
  std::vector<GLboolean> enabled_;
};

// Framebuffer and renderbuffer bindings, and what clips or converts clears and blits: the scissor test and
// GL_FRAMEBUFFER_SRGB.
class FramebufferGuard {
 public:
  explicit FramebufferGuard(const ContextFacts&);
  ~FramebufferGuard();
  void unclip() const;
  void clipAsProgram() const;
  GLuint drawFramebuffer() const { return draw_; }

 private:
  bool srgb_switch_;
  CapabilityGuard scissor_;
  CapabilityGuard srgb_;
  GLuint draw_ = 0, read_ = 0, renderbuffer_ = 0;
};

// The current program, or program pipeline, with its subroutine selection, which glUseProgram forgets; active
// transform feedback pauses meanwhile.
class ProgramGuard {
 public:
  explicit ProgramGuard(const ContextFacts&);
  ~ProgramGuard();
  // Makes the program and its subroutine selection current again, while the guard still lives.
  void makeCurrent() const;

 private:
  struct StageSubroutines {
    GLenum stage;
    std::vector<GLuint> indices;
  };
  GLuint stageProgram(GLenum stage) const;
  bool pipelines_;
  GLuint program_ = 0, pipeline_ = 0;
  bool paused_ = false;
  std::vector<StageSubroutines> subroutines_;
};

// All that changes what glReadPixels stores: pixel pack state and buffer, pixel transfer, read clamping. Set
// to "values as they are, rows without gaps" while it lives.
class PixelReadGuard {
 public:
  explicit PixelReadGuard(const ContextFacts&);
  ~PixelReadGuard();

 private:
  struct Parameter {
    GLenum name;
    GLfloat value;
  };
  bool clamps_ = false, transfers_ = false;
  GLint clamp_ = 0;
  GLint pack_buffer_ = 0;
  bool has_pack_buffer_ = false;
  std::vector<Parameter> pack_, transfer_;
};

// Where transform feedback goes, which is not active or paused, and rasterization, which is off while it
// lives.
class FeedbackGuard {
 public:
  explicit FeedbackGuard(const ContextFacts&);
  ~FeedbackGuard();

 private:
  bool objects_;
  CapabilityGuard discard_;
  GLint object_ = 0, generic_ = 0, buffer_ = 0;
  GLint64 start_ = 0, size_ = 0;
};

// The generic storage buffer binding and one indexed one.
class StorageBindingGuard {
 public:
  explicit StorageBindingGuard(int index);
  ~StorageBindingGuard();

 private:
  GLuint index_;
  GLint generic_ = 0, buffer_ = 0;
  GLint64 start_ = 0, size_ = 0;
};

// Vertex array and array buffer bindings.
class VertexArrayGuard {
 public:
  VertexArrayGuard();
  ~VertexArrayGuard();

 private:
  GLint vertex_array_ = 0, array_buffer_ = 0;
};

// Debug messages: none are made while it lives, so that no callback of the program hears of the agent's
// calls.
class SilenceGuard {
 public:
  explicit SilenceGuard(const ContextFacts&);
  ~SilenceGuard();

 private:
  bool was_enabled_ = false;
};

}  // namespace shadestep::guard
