// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/draw_target.h"

#include <algorithm>
#include <array>

#include "interceptor/capture/drawable_size.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/texture_level.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

GLint integer(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return value;
}

GLint attachmentParameter(GLenum target, GLenum attachment, GLenum name) {
  GLint value = 0;
  gl().GetFramebufferAttachmentParameteriv(target, attachment, name, &value);
  return value;
}

// ---- formats
// -------------------------------------------------------------------------------------------------

// Formats whose components all have the same number of bits.
struct Uniform {
  GLenum type;
  int bits;
  std::array<GLenum, 4> formats;  // with 1 to 4 components; 0 = none
};
constexpr std::array kUniform = {
    Uniform{GL_UNSIGNED_NORMALIZED, 8, {GL_R8, GL_RG8, GL_RGB8, GL_RGBA8}},
    Uniform{GL_UNSIGNED_NORMALIZED, 16, {GL_R16, GL_RG16, GL_RGB16, GL_RGBA16}},
    Uniform{GL_UNSIGNED_NORMALIZED, 4, {0, 0, GL_RGB4, GL_RGBA4}},
    Uniform{GL_SIGNED_NORMALIZED, 8, {GL_R8_SNORM, GL_RG8_SNORM, GL_RGB8_SNORM, GL_RGBA8_SNORM}},
    Uniform{GL_SIGNED_NORMALIZED, 16, {GL_R16_SNORM, GL_RG16_SNORM, GL_RGB16_SNORM, GL_RGBA16_SNORM}},
    Uniform{GL_FLOAT, 16, {GL_R16F, GL_RG16F, GL_RGB16F, GL_RGBA16F}},
    Uniform{GL_FLOAT, 32, {GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F}},
    Uniform{GL_INT, 8, {GL_R8I, GL_RG8I, GL_RGB8I, GL_RGBA8I}},
    Uniform{GL_INT, 16, {GL_R16I, GL_RG16I, GL_RGB16I, GL_RGBA16I}},
    Uniform{GL_INT, 32, {GL_R32I, GL_RG32I, GL_RGB32I, GL_RGBA32I}},
    Uniform{GL_UNSIGNED_INT, 8, {GL_R8UI, GL_RG8UI, GL_RGB8UI, GL_RGBA8UI}},
    Uniform{GL_UNSIGNED_INT, 16, {GL_R16UI, GL_RG16UI, GL_RGB16UI, GL_RGBA16UI}},
    Uniform{GL_UNSIGNED_INT, 32, {GL_R32UI, GL_RG32UI, GL_RGB32UI, GL_RGBA32UI}},
};

// The others.
struct Mixed {
  GLenum type;
  std::array<int, 4> bits;
  GLenum format;
};
constexpr std::array kMixed = {
    Mixed{GL_UNSIGNED_NORMALIZED, {10, 10, 10, 2}, GL_RGB10_A2},
    Mixed{GL_UNSIGNED_NORMALIZED, {10, 10, 10, 0}, GL_RGB10},
    Mixed{GL_UNSIGNED_NORMALIZED, {5, 6, 5, 0}, GL_RGB565},
    Mixed{GL_UNSIGNED_NORMALIZED, {5, 5, 5, 0}, GL_RGB5},
    Mixed{GL_UNSIGNED_NORMALIZED, {5, 5, 5, 1}, GL_RGB5_A1},
    Mixed{GL_FLOAT, {11, 11, 10, 0}, GL_R11F_G11F_B10F},
    Mixed{GL_UNSIGNED_INT, {10, 10, 10, 2}, GL_RGB10_A2UI},
};

GLenum internalFormat(const Format& format) {
  const int* bits = format.bits;
  if (format.srgb) {
    if (bits[0] != 8 || bits[1] != 8 || bits[2] != 8) return 0;
    return bits[3] == 8 ? GL_SRGB8_ALPHA8 : bits[3] == 0 ? GL_SRGB8 : 0;
  }
  for (const Mixed& mixed : kMixed) {
    if (mixed.type == format.type && std::equal(mixed.bits.begin(), mixed.bits.end(), bits))
      return mixed.format;
  }
  const int count = format.components();
  for (int i = 0; i < 4; ++i) {
    if (bits[i] != (i < count ? bits[0] : 0)) return 0;  // alpha only, luminance and the like
  }
  for (const Uniform& uniform : kUniform) {
    if (count > 0 && uniform.type == format.type && uniform.bits == bits[0]) {
      return uniform.formats[static_cast<std::size_t>(count - 1)];
    }
  }
  return 0;
}

GLenum depthStencilInternalFormat(const DepthStencil& bits) {
  if (bits.stencil_bits > 0 && bits.depth_bits > 0)
    return bits.depth_float ? GL_DEPTH32F_STENCIL8 : GL_DEPTH24_STENCIL8;
  if (bits.stencil_bits > 0) return GL_STENCIL_INDEX8;
  if (bits.depth_float) return GL_DEPTH_COMPONENT32F;
  switch (bits.depth_bits) {
    case 0:
      return 0;
    case 16:
      return GL_DEPTH_COMPONENT16;
    case 32:
      return GL_DEPTH_COMPONENT32;
    default:
      return GL_DEPTH_COMPONENT24;
  }
}

// ---- sizes
// ---------------------------------------------------------------------------------------------------

struct Size {
  int width = 0, height = 0;
};

Size renderbufferSize(GLuint renderbuffer) {
  const auto before = static_cast<GLuint>(integer(GL_RENDERBUFFER_BINDING));
  Size size;
  gl().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
  gl().GetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_WIDTH, &size.width);
  gl().GetRenderbufferParameteriv(GL_RENDERBUFFER, GL_RENDERBUFFER_HEIGHT, &size.height);
  gl().BindRenderbuffer(GL_RENDERBUFFER, before);
  return size;
}

// Takes one attachment of the program's framebuffer into account: framebuffers draw to what all attachments
// cover.
void addAttachment(DrawTarget& target, GLenum attachment) {
  const auto ask = [&](GLenum name) { return attachmentParameter(GL_DRAW_FRAMEBUFFER, attachment, name); };
  const GLint object = ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
  if (object != GL_TEXTURE && object != GL_RENDERBUFFER) return;
  const auto name = static_cast<GLuint>(ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
  Size size;
  if (object == GL_RENDERBUFFER) {
    size = renderbufferSize(name);
  } else {
    GLint layered = 0;
    gl().GetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment,
                                             GL_FRAMEBUFFER_ATTACHMENT_LAYERED, &layered);
    guard::clearErrors();  // before OpenGL 3.2 nothing is layered, and asking is an error
    if (layered) target.reason = "the draw goes to a layered framebuffer, which cannot be captured yet";
    const guard::TextureLevel level = guard::textureLevel(name, ask(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL));
    size = {level.width, level.height};
  }
  if (size.width <= 0 || size.height <= 0) {
    target.reason = "the size of an attachment of the program's framebuffer cannot be found out";
    return;
  }
  target.width = target.width == 0 ? size.width : std::min(target.width, size.width);
  target.height = target.height == 0 ? size.height : std::min(target.height, size.height);
}

// The buffer of the window system's framebuffer that a draw buffer names: what it is called in questions
// about attachments, and in glReadBuffer.
GLenum defaultBuffer(GLenum draw_buffer, bool es) {
  if (es) return GL_BACK;
  switch (draw_buffer) {
    case GL_FRONT:
    case GL_FRONT_LEFT:
      return GL_FRONT_LEFT;
    case GL_BACK:
    case GL_BACK_LEFT:
      return GL_BACK_LEFT;
    case GL_FRONT_RIGHT:
    case GL_BACK_RIGHT:
      return draw_buffer;
    default:
      return 0;
  }
}

void addColorBuffers(DrawTarget& target, const guard::ContextFacts& facts) {
  const int most = integer(GL_MAX_DRAW_BUFFERS);
  for (int i = 0; i < most; ++i) {
    auto source = static_cast<GLenum>(integer(GL_DRAW_BUFFER0 + static_cast<GLenum>(i)));
    if (source == GL_NONE) continue;
    if (target.framebuffer == 0) source = defaultBuffer(source, facts.es);
    if (source == 0) {
      target.reason =
          "the draw goes to several window buffers at once (GL_FRONT_AND_BACK or stereo), which cannot "
          "be captured";
      return;
    }
    if (attachmentParameter(GL_DRAW_FRAMEBUFFER, source, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == GL_NONE)
      continue;
    if (target.framebuffer != 0) addAttachment(target, source);
    const ColorBuffer color{i, source, attachmentFormat(GL_DRAW_FRAMEBUFFER, source)};
    if (color.format.internal_format == 0) {
      target.reason = "draw buffer " + std::to_string(i) + " has a format that cannot be copied exactly";
    }
    target.colors.push_back(color);
    target.draw_buffers = i + 1;
  }
}

}  // namespace

bool Format::operator==(const Format& other) const {
  return type == other.type && srgb == other.srgb && std::equal(bits, bits + 4, other.bits);
}

Format attachmentFormat(GLenum target, GLenum attachment) {
  Format format;
  constexpr std::array kSizes = {GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
                                 GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE};
  for (std::size_t i = 0; i < kSizes.size(); ++i)
    format.bits[i] = attachmentParameter(target, attachment, kSizes[i]);
  format.type =
      static_cast<GLenum>(attachmentParameter(target, attachment, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE));
  format.srgb = attachmentParameter(target, attachment, GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING) == GL_SRGB;
  format.internal_format = internalFormat(format);
  return format;
}

DepthStencil depthStencilFormat(GLenum target, bool default_framebuffer) {
  const GLenum depth = default_framebuffer ? GL_DEPTH : GL_DEPTH_ATTACHMENT;
  const GLenum stencil = default_framebuffer ? GL_STENCIL : GL_STENCIL_ATTACHMENT;
  DepthStencil format;
  if (attachmentParameter(target, depth, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_NONE) {
    format.depth_bits = attachmentParameter(target, depth, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    format.depth_float =
        format.depth_bits > 0 &&
        attachmentParameter(target, depth, GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE) == GL_FLOAT;
  }
  if (attachmentParameter(target, stencil, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) != GL_NONE) {
    format.stencil_bits = attachmentParameter(target, stencil, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE);
  }
  format.internal_format = depthStencilInternalFormat(format);
  return format;
}

DrawTarget drawTarget(const guard::ContextFacts& facts) {
  DrawTarget target;
  if (!facts.framebufferObjects()) {
    target.reason =
        "the driver offers no framebuffer objects (OpenGL 3.0 or GL_ARB_framebuffer_object), which "
        "captures need";
    return target;
  }
  target.framebuffer = static_cast<GLuint>(integer(GL_DRAW_FRAMEBUFFER_BINDING));
  if (gl().CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    target.reason = "the program's draw framebuffer is not complete: the draw does nothing";
    return target;
  }
  if (integer(GL_SAMPLE_BUFFERS) > 0 && integer(GL_SAMPLES) > 0) {
    target.reason = "the draw goes to a multisampled framebuffer, which cannot be captured yet";
  }
  addColorBuffers(target, facts);
  target.depth_stencil = depthStencilFormat(GL_DRAW_FRAMEBUFFER, target.framebuffer == 0);
  if (target.framebuffer == 0) {
    const auto size = drawableSize();
    if (size) {
      target.width = size->width;
      target.height = size->height;
    } else if (target.reason.empty()) {
      target.reason = "the size of the program's window cannot be found out";
    }
  } else {
    addAttachment(target, GL_DEPTH_ATTACHMENT);
    addAttachment(target, GL_STENCIL_ATTACHMENT);
    if (target.width == 0 && (facts.atLeast(43, 31) || facts.has("GL_ARB_framebuffer_no_attachments"))) {
      gl().GetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, &target.width);
      gl().GetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, &target.height);
    }
  }
  guard::clearErrors();
  return target;
}

}  // namespace shadestep::capture
