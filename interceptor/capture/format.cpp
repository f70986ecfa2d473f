// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/format.h"

#include <algorithm>
#include <array>

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

GLint attachmentParameter(GLenum target, GLenum attachment, GLenum name) {
  GLint value = 0;
  gl().GetFramebufferAttachmentParameteriv(target, attachment, name, &value);
  return value;
}

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

}  // namespace shadestep::capture
