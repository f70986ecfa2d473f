// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/draw_target.h"

#include <algorithm>
#include <array>

#include "interceptor/capture/drawable_size.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/query.h"
#include "interceptor/guard/texture_level.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;
using guard::integer;

GLint attachmentParameter(GLenum target, GLenum attachment, GLenum name) {
  GLint value = 0;
  gl().GetFramebufferAttachmentParameteriv(target, attachment, name, &value);
  return value;
}

// ---- attachments
// ---------------------------------------------------------------------------------------------------

// What an attachment consists of.
struct Attachment {
  int width = 0, height = 0;
  int layers = 0;  // 0 = one layer is attached
  bool fixed_sample_locations = true;
  GLenum internal_format = 0;  // as the program asked for it
  bool luminance = false;      // or intensity
  AttachedTexture texture;
};

Attachment renderbufferAttachment(GLuint renderbuffer) {
  const auto before = static_cast<GLuint>(integer(GL_RENDERBUFFER_BINDING));
  const auto ask = [](GLenum name) {
    GLint value = 0;
    gl().GetRenderbufferParameteriv(GL_RENDERBUFFER, name, &value);
    return value;
  };
  Attachment result;
  gl().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
  result.width = ask(GL_RENDERBUFFER_WIDTH);
  result.height = ask(GL_RENDERBUFFER_HEIGHT);
  result.internal_format = static_cast<GLenum>(ask(GL_RENDERBUFFER_INTERNAL_FORMAT));
  result.fixed_sample_locations = false;
  gl().BindRenderbuffer(GL_RENDERBUFFER, before);
  return result;
}

Attachment textureAttachment(GLuint texture, GLint level, bool layered) {
  const guard::TextureLevel found = guard::textureLevel(texture, level);
  Attachment result;
  result.width = found.width;
  result.height = found.height;
  result.layers = layered ? found.depth : 0;
  result.fixed_sample_locations = found.fixed_sample_locations;
  result.internal_format = found.internal_format;
  result.luminance = found.luminance;
  result.texture = {texture, found.target, level};
  return result;
}

// Takes one attachment of the program's framebuffer into account: framebuffers draw to what all attachments
// cover.
Attachment addAttachment(DrawTarget& target, GLenum attachment) {
  const auto ask = [&](GLenum name) { return attachmentParameter(GL_DRAW_FRAMEBUFFER, attachment, name); };
  const GLint object = ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
  if (object != GL_TEXTURE && object != GL_RENDERBUFFER) return {};
  const auto name = static_cast<GLuint>(ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
  Attachment found;
  if (object == GL_RENDERBUFFER) {
    found = renderbufferAttachment(name);
  } else {
    const GLint layered = ask(GL_FRAMEBUFFER_ATTACHMENT_LAYERED);
    guard::clearErrors();  // before OpenGL 3.2 nothing is layered, and asking is an error
    found = textureAttachment(name, ask(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL), layered != 0);
  }
  if (found.width <= 0 || found.height <= 0) {
    target.reason = "the size of an attachment of the program's framebuffer cannot be found out";
    return found;
  }
  const auto take = [](int& least, int one) { least = least == 0 ? one : std::min(least, one); };
  take(target.width, found.width);
  take(target.height, found.height);
  if (found.layers > 0) take(target.layers, found.layers);
  target.fixed_sample_locations = target.fixed_sample_locations && found.fixed_sample_locations;
  return found;
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
    ColorBuffer color{i, source, attachmentFormat(GL_DRAW_FRAMEBUFFER, source), {}};
    if (target.framebuffer != 0) {
      const Attachment attachment = addAttachment(target, source);
      color.texture = attachment.texture;
      // Alpha only, luminance and the like cannot be told by their components.
      if (color.format.internal_format == 0) color.format.internal_format = attachment.internal_format;
      color.format.luminance = attachment.luminance;
    }
    if (color.format.internal_format == 0) {
      target.reason = "draw buffer " + std::to_string(i) + " has a format that cannot be copied exactly";
    }
    target.colors.push_back(color);
    target.draw_buffers = i + 1;
  }
}

void measureWindow(DrawTarget& target) {
  target.fixed_sample_locations = false;
  const auto size = drawableSize();
  if (size) {
    target.width = size->width;
    target.height = size->height;
  } else if (target.reason.empty()) {
    target.reason = "the size of the program's window cannot be found out";
  }
}

// A framebuffer without attachments.
void takeDefaults(DrawTarget& target) {
  const auto ask = [](GLenum name) {
    GLint value = 0;
    gl().GetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, name, &value);
    return value;
  };
  target.width = ask(GL_FRAMEBUFFER_DEFAULT_WIDTH);
  target.height = ask(GL_FRAMEBUFFER_DEFAULT_HEIGHT);
  target.layers = ask(GL_FRAMEBUFFER_DEFAULT_LAYERS);
  target.fixed_sample_locations = ask(GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS) != 0;
}

// Why this driver cannot make a target of these layers and samples, or "".
std::string obstacle(const DrawTarget& target, const guard::ContextFacts& facts) {
  const auto srgb = [](const ColorBuffer& color) { return color.format.srgb; };
  if (target.samples > 0 && !facts.multisampleTextures()) {
    return "the draw goes to a multisampled framebuffer, whose samples this driver cannot read one by one "
           "(OpenGL "
           "3.2, ES 3.1 or GL_ARB_texture_multisample)";
  }
  if (target.samples > 0 && std::any_of(target.colors.begin(), target.colors.end(), srgb) &&
      !(facts.textureViews() && facts.multisampleStorage())) {
    return "the draw goes to a multisampled sRGB framebuffer, whose stored values this driver cannot read "
           "(OpenGL 4.3 "
           "or GL_ARB_texture_view)";
  }
  if (target.layers > 0 && !facts.textureStorage()) {
    return "the draw goes to a layered framebuffer, which this driver cannot copy (GL_ARB_texture_storage)";
  }
  return "";
}

}  // namespace

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
  if (integer(GL_SAMPLE_BUFFERS) > 0) target.samples = integer(GL_SAMPLES);
  addColorBuffers(target, facts);
  target.depth_stencil = depthStencilFormat(GL_DRAW_FRAMEBUFFER, target.framebuffer == 0);
  if (target.framebuffer == 0) {
    measureWindow(target);
  } else {
    target.depth_texture = addAttachment(target, GL_DEPTH_ATTACHMENT).texture;
    target.stencil_texture = addAttachment(target, GL_STENCIL_ATTACHMENT).texture;
    if (target.width == 0 && facts.framebufferDefaults()) takeDefaults(target);
  }
  if (target.reason.empty()) target.reason = obstacle(target, facts);
  guard::clearErrors();
  return target;
}

}  // namespace shadestep::capture
