// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/fragment_guards.h"

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/query.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

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

// ---- single draw buffers
// -------------------------------------------------------------------------------------

CaptureBufferGuard::CaptureBufferGuard(const ContextFacts& facts, const std::vector<int>& draw_buffers) {
  if (!facts.indexedDrawBuffers()) return;
  for (const int buffer : draw_buffers) {
    Saved saved{static_cast<GLuint>(buffer), GL_FALSE, {}};
    saved.blend = gl().IsEnabledi(GL_BLEND, saved.index);
    gl().GetBooleani_v(GL_COLOR_WRITEMASK, saved.index, saved.mask);
    gl().Disablei(GL_BLEND, saved.index);
    gl().ColorMaski(saved.index, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    saved_.push_back(saved);
  }
}

CaptureBufferGuard::~CaptureBufferGuard() {
  for (const Saved& saved : saved_) {
    if (saved.blend) gl().Enablei(GL_BLEND, saved.index);
    gl().ColorMaski(saved.index, saved.mask[0], saved.mask[1], saved.mask[2], saved.mask[3]);
  }
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

// ---- the provoking vertex
// ------------------------------------------------------------------------------------

ProvokingVertexGuard::ProvokingVertexGuard(const wire::RasterT* raster) {
  const wire::Provoking wanted = raster != nullptr ? raster->provoking : wire::Provoking::Keep;
  if (wanted == wire::Provoking::Keep || !dispatch::available("glProvokingVertex")) return;
  before_ = integer(GL_PROVOKING_VERTEX);
  gl().ProvokingVertex(wanted == wire::Provoking::First ? GL_FIRST_VERTEX_CONVENTION
                                                        : GL_LAST_VERTEX_CONVENTION);
}

ProvokingVertexGuard::~ProvokingVertexGuard() {
  if (before_ != 0) gl().ProvokingVertex(static_cast<GLenum>(before_));
}

// ---- a plain raster
// ------------------------------------------------------------------------------------------

PlainRasterGuard::PlainRasterGuard(const ContextFacts& facts, int width, int height)
    : viewport_arrays_(facts.viewportArrays()),
      polygon_mode_(!facts.es),
      clip_control_(facts.clipControl()),
      masks_(facts) {
  const int viewports = viewportCount(facts);

  for (int i = 0; i < (viewport_arrays_ ? viewports : 1); ++i) {
    Viewport viewport{};
    if (viewport_arrays_) {
      gl().GetFloati_v(GL_VIEWPORT, static_cast<GLuint>(i), viewport.box);
    } else {
      gl().GetFloatv(GL_VIEWPORT, viewport.box);
    }
    viewports_.push_back(viewport);
  }
  gl().Viewport(0, 0, width, height);

  if (clip_control_) {
    clip_origin_ = integer(GL_CLIP_ORIGIN);
    clip_depth_ = integer(GL_CLIP_DEPTH_MODE);
    gl().ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  }

  disable(GL_SCISSOR_TEST, viewports);
  disable(GL_BLEND, blendedBuffers(facts));
  disable(GL_DEPTH_TEST);
  disable(GL_STENCIL_TEST);
  disable(GL_CULL_FACE);
  if (facts.atLeast(30, 30)) disable(GL_RASTERIZER_DISCARD);
  if (facts.es) return;
  disable(GL_COLOR_LOGIC_OP);
  for (GLenum plane = 0; plane < 6; ++plane) disable(GL_CLIP_PLANE0 + plane);
  if (facts.srgbSwitch()) disable(GL_FRAMEBUFFER_SRGB);
  if (facts.compatibility()) {
    disable(GL_ALPHA_TEST);
    disable(GL_POLYGON_STIPPLE);
    disable(GL_POLYGON_SMOOTH);
  }
  gl().GetIntegerv(GL_POLYGON_MODE, polygon_modes_);
  gl().PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void PlainRasterGuard::disable(GLenum capability, int indices) {
  capabilities_.emplace_back(capability, indices).disable();
}

PlainRasterGuard::~PlainRasterGuard() {
  for (GLuint i = 0; i < viewports_.size(); ++i) {
    const GLfloat* box = viewports_[i].box;
    if (viewport_arrays_) {
      gl().ViewportIndexedf(i, box[0], box[1], box[2], box[3]);
    } else {
      gl().Viewport(static_cast<GLint>(box[0]), static_cast<GLint>(box[1]), static_cast<GLsizei>(box[2]),
                    static_cast<GLsizei>(box[3]));
    }
  }
  if (clip_control_) gl().ClipControl(static_cast<GLenum>(clip_origin_), static_cast<GLenum>(clip_depth_));
  if (!polygon_mode_) return;
  if (polygon_modes_[0] == polygon_modes_[1]) {
    gl().PolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_modes_[0]));
  } else {
    gl().PolygonMode(GL_FRONT, static_cast<GLenum>(polygon_modes_[0]));
    gl().PolygonMode(GL_BACK, static_cast<GLenum>(polygon_modes_[1]));
  }
}

}  // namespace shadestep::guard
