// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/fragment_guards.h"

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

GLint integer(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return value;
}

int blendedBuffers(const ContextFacts& facts) {
  return facts.indexedDrawBuffers() ? integer(GL_MAX_DRAW_BUFFERS) : 0;
}

bool clampsFragments(const ContextFacts& facts) {
  return facts.compatibility() && (facts.atLeast(30, 0) || facts.has("GL_ARB_color_buffer_float"));
}

}  // namespace

// ---- masks
// ---------------------------------------------------------------------------------------------------

ColorMaskGuard::ColorMaskGuard(const ContextFacts& facts) : indexed_(facts.indexedDrawBuffers()) {
  const int count = indexed_ ? integer(GL_MAX_DRAW_BUFFERS) : 1;
  for (int i = 0; i < count; ++i) {
    Mask mask{};
    if (indexed_) {
      gl().GetBooleani_v(GL_COLOR_WRITEMASK, static_cast<GLuint>(i), mask.write);
    } else {
      gl().GetBooleanv(GL_COLOR_WRITEMASK, mask.write);
    }
    masks_.push_back(mask);
  }
  gl().ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

ColorMaskGuard::~ColorMaskGuard() {
  for (GLuint i = 0; i < masks_.size(); ++i) {
    const GLboolean* write = masks_[i].write;
    if (indexed_) {
      gl().ColorMaski(i, write[0], write[1], write[2], write[3]);
    } else {
      gl().ColorMask(write[0], write[1], write[2], write[3]);
    }
  }
}

WriteMaskGuard::WriteMaskGuard(const ContextFacts& facts)
    : colors_(facts),
      stencil_front_(integer(GL_STENCIL_WRITEMASK)),
      stencil_back_(integer(GL_STENCIL_BACK_WRITEMASK)) {
  gl().GetBooleanv(GL_DEPTH_WRITEMASK, &depth_);
  gl().DepthMask(GL_TRUE);
  gl().StencilMask(~0U);
}

WriteMaskGuard::~WriteMaskGuard() {
  gl().DepthMask(depth_);
  gl().StencilMaskSeparate(GL_FRONT, static_cast<GLuint>(stencil_front_));
  gl().StencilMaskSeparate(GL_BACK, static_cast<GLuint>(stencil_back_));
}

// ---- colours
// -------------------------------------------------------------------------------------------------

BlendFunctionGuard::BlendFunctionGuard(const ContextFacts& facts)
    : indexed_(facts.atLeast(40, 32) || facts.has("GL_ARB_draw_buffers_blend")) {
  const int count = indexed_ ? integer(GL_MAX_DRAW_BUFFERS) : 1;
  for (int i = 0; i < count; ++i) {
    const auto ask = [&](GLenum name) {
      GLint value = 0;
      indexed_ ? gl().GetIntegeri_v(name, static_cast<GLuint>(i), &value) : gl().GetIntegerv(name, &value);
      return static_cast<GLenum>(value);
    };
    functions_.push_back(
        {ask(GL_BLEND_SRC_RGB), ask(GL_BLEND_DST_RGB), ask(GL_BLEND_SRC_ALPHA), ask(GL_BLEND_DST_ALPHA)});
  }
  gl().BlendFunc(GL_ONE, GL_ZERO);
}

BlendFunctionGuard::~BlendFunctionGuard() {
  for (GLuint i = 0; i < functions_.size(); ++i) {
    const Functions& one = functions_[i];
    if (!indexed_) {
      gl().BlendFuncSeparate(one.source_rgb, one.target_rgb, one.source_alpha, one.target_alpha);
    } else if (dispatch::available("glBlendFuncSeparatei")) {
      gl().BlendFuncSeparatei(i, one.source_rgb, one.target_rgb, one.source_alpha, one.target_alpha);
    } else {
      gl().BlendFuncSeparateiARB(i, one.source_rgb, one.target_rgb, one.source_alpha, one.target_alpha);
    }
  }
}

PlainColorGuard::PlainColorGuard(const ContextFacts& facts)
    : masks_(facts), functions_(facts), clamps_(clampsFragments(facts)) {
  const auto disable = [&](GLenum capability, int indices = 0) {
    capabilities_.emplace_back(capability, indices).disable();
  };
  disable(GL_BLEND, blendedBuffers(facts));
  if (facts.es) return;
  disable(GL_COLOR_LOGIC_OP);
  disable(GL_SAMPLE_ALPHA_TO_ONE);
  if (!clamps_) return;
  clamp_ = integer(GL_CLAMP_FRAGMENT_COLOR);
  gl().ClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
}

PlainColorGuard::~PlainColorGuard() {
  if (clamps_) gl().ClampColor(GL_CLAMP_FRAGMENT_COLOR, static_cast<GLenum>(clamp_));
}

// ---- tests
// ---------------------------------------------------------------------------------------------------

FragmentTestsGuard::FragmentTestsGuard(const ContextFacts& facts, const wire::RasterT* raster) {
  if (raster == nullptr) return;
  if (facts.compatibility()) force(GL_ALPHA_TEST, raster->alpha_test);
  force(GL_DEPTH_TEST, raster->depth_test);
  force(GL_STENCIL_TEST, raster->stencil_test);
  force(GL_BLEND, raster->blend, blendedBuffers(facts));
}

void FragmentTestsGuard::force(GLenum capability, wire::Switch to, int indices) {
  if (to == wire::Switch::Keep) return;
  const CapabilityGuard& guard = capabilities_.emplace_back(capability, indices);
  to == wire::Switch::On ? guard.enable() : guard.disable();
}

}  // namespace shadestep::guard
