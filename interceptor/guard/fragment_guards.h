// What decides on a fragment after its shader: tests, blending and masks. Saved and put back as in guards.h.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <deque>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/guards.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"
#include "wire/messages_generated.h"

namespace shadestep::guard {

// The masks of colour buffers: while it lives, every component is written.
class ColorMaskGuard {
 public:
  explicit ColorMaskGuard(const ContextFacts&);
  ~ColorMaskGuard();
  ColorMaskGuard(const ColorMaskGuard&) = delete;
  ColorMaskGuard& operator=(const ColorMaskGuard&) = delete;

 private:
  struct Mask {
    GLboolean write[4];
  };
  bool indexed_;
  std::vector<Mask> masks_;
};

// The same of depth and stencil too: clears are complete.
class WriteMaskGuard {
 public:
  explicit WriteMaskGuard(const ContextFacts&);
  ~WriteMaskGuard();
  WriteMaskGuard(const WriteMaskGuard&) = delete;
  WriteMaskGuard& operator=(const WriteMaskGuard&) = delete;

 private:
  ColorMaskGuard colors_;
  GLboolean depth_ = GL_TRUE;
  GLint stencil_front_ = 0, stencil_back_ = 0;
};

// The functions of blending: while it lives they are those that blending starts with, which take no second
// source.
class BlendFunctionGuard {
 public:
  explicit BlendFunctionGuard(const ContextFacts&);
  ~BlendFunctionGuard();
  BlendFunctionGuard(const BlendFunctionGuard&) = delete;
  BlendFunctionGuard& operator=(const BlendFunctionGuard&) = delete;

 private:
  struct Functions {
    GLenum source_rgb, target_rgb, source_alpha, target_alpha;
  };
  bool indexed_;
  std::vector<Functions> functions_;
};

// Everything between a fragment's outputs and the colour buffers: while it lives they are written as they
// are.
class PlainColorGuard {
 public:
  explicit PlainColorGuard(const ContextFacts&);
  ~PlainColorGuard();
  PlainColorGuard(const PlainColorGuard&) = delete;
  PlainColorGuard& operator=(const PlainColorGuard&) = delete;

 private:
  ColorMaskGuard masks_;
  BlendFunctionGuard functions_;
  std::deque<CapabilityGuard> capabilities_;  // stays in place: guards neither move nor copy
  bool clamps_;
  GLint clamp_ = 0;
};

// Blending and colour mask of single draw buffers; while it lives they write unblended and unmasked.
class CaptureBufferGuard {
 public:
  CaptureBufferGuard(const ContextFacts&, const std::vector<int>& draw_buffers);
  ~CaptureBufferGuard();

 private:
  struct Saved {
    GLuint index;
    GLboolean blend;
    GLboolean mask[4];
  };
  std::vector<Saved> saved_;
};

// Tests and blending, forced on or off while it lives. Null: all as the program has it.
class FragmentTestsGuard {
 public:
  FragmentTestsGuard(const ContextFacts&, const wire::RasterT*);

 private:
  void force(GLenum capability, wire::Switch, int indices = 0);
  std::deque<CapabilityGuard> capabilities_;
};

// Which vertex flat outputs come from while it lives. Null: as the program has it, as where the driver does
// not let choose.
class ProvokingVertexGuard {
 public:
  explicit ProvokingVertexGuard(const wire::RasterT*);
  ~ProvokingVertexGuard();
  ProvokingVertexGuard(const ProvokingVertexGuard&) = delete;
  ProvokingVertexGuard& operator=(const ProvokingVertexGuard&) = delete;

 private:
  GLint before_ = 0;  // 0: nothing is to be put back
};

// Everything between a triangle and a plain target: tests, blending, masks, culling, viewports. While it
// lives a triangle is rasterized whole and written as it is to a target of `width` x `height`.
class PlainRasterGuard {
 public:
  PlainRasterGuard(const ContextFacts&, int width, int height);
  ~PlainRasterGuard();

 private:
  struct Viewport {
    GLfloat box[4];
  };
  void disable(GLenum capability, int indices = 0);

  bool viewport_arrays_, polygon_mode_, clip_control_;
  ColorMaskGuard masks_;
  GLint clip_origin_ = 0, clip_depth_ = 0;
  std::vector<Viewport> viewports_;
  GLint polygon_modes_[2] = {};
  std::deque<CapabilityGuard> capabilities_;  // stays in place: guards neither move nor copy
};

}  // namespace shadestep::guard
