// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/shadow.h"

#include <algorithm>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

GLenum colorAttachment(int index) {
  return GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
}

GLuint makeRenderbuffer(GLenum format, const DrawTarget& size) {
  GLuint name = 0;
  gl().GenRenderbuffers(1, &name);
  gl().BindRenderbuffer(GL_RENDERBUFFER, name);
  gl().RenderbufferStorage(GL_RENDERBUFFER, format, size.width, size.height);
  return name;
}

void attach(GLenum attachment, GLuint renderbuffer) {
  gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, attachment, GL_RENDERBUFFER, renderbuffer);
}

// Window-system framebuffers are stored upside down by Mesa. A copy that is not would be rasterized from the
// other side, and interpolated values would differ in their last bits.
void storeUpsideDown(const guard::ContextFacts& facts) {
  if (!facts.has("GL_MESA_framebuffer_flip_y")) return;
  if (dispatch::available("glFramebufferParameteriMESA")) {
    gl().FramebufferParameteriMESA(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, GL_TRUE);
  } else {
    gl().FramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, GL_TRUE);
  }
}

}  // namespace

Shadow::Shadow(const guard::ContextFacts& facts, const DrawTarget& target) : facts_(facts), target_(target) {}

Shadow::~Shadow() {
  if (framebuffer_ == 0) return;
  gl().DeleteFramebuffers(1, &framebuffer_);
  gl().DeleteRenderbuffers(static_cast<GLsizei>(colors_.size()), colors_.data());
  if (depth_stencil_ != 0) gl().DeleteRenderbuffers(1, &depth_stencil_);
  for (const Attached& capture : captures_) gl().DeleteRenderbuffers(1, &capture.renderbuffer);
}

guard::Refusal Shadow::fill(const guard::FramebufferGuard& clip, const std::vector<CaptureBuffer>& captures) {
  if (!built_ && !build()) return refusal_;
  clip.unclip();
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  copyProgramContents();
  attachCaptures(captures);
  selectDrawBuffers(captures);
  if (gl().CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return guard::limit("the driver takes no framebuffer with the program's buffers and " +
                        std::to_string(captures.size()) + " capture buffers; capture less at once");
  }
  for (const CaptureBuffer& capture : captures) {
    constexpr GLuint kZero[4] = {};
    constexpr GLfloat kZeroFloat[4] = {};
    if (capture.format == wire::CaptureFormat::Uint4) {
      gl().ClearBufferuiv(GL_COLOR, capture.location, kZero);
    } else {
      gl().ClearBufferfv(GL_COLOR, capture.location, kZeroFloat);
    }
  }
  clip.clipAsProgram();
  if (guard::clearErrors()) return guard::internal("the driver refused to copy the program's framebuffer");
  return {};
}

bool Shadow::build() {
  gl().GenFramebuffers(1, &framebuffer_);
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  if (target_.framebuffer == 0) storeUpsideDown(facts_);
  for (const ColorBuffer& color : target_.colors) {
    colors_.push_back(makeRenderbuffer(color.format.internal_format, target_));
    attach(colorAttachment(color.draw_buffer), colors_.back());
    if (!(attachmentFormat(GL_DRAW_FRAMEBUFFER, colorAttachment(color.draw_buffer)) == color.format)) {
      refusal_ = guard::unsupported("the driver has no framebuffer object with the format of draw buffer " +
                                    std::to_string(color.draw_buffer));
      return false;
    }
  }
  const DepthStencil& wanted = target_.depth_stencil;
  if (wanted.internal_format != 0) {
    depth_stencil_ = makeRenderbuffer(wanted.internal_format, target_);
    if (wanted.depth_bits > 0) attach(GL_DEPTH_ATTACHMENT, depth_stencil_);
    if (wanted.stencil_bits > 0) attach(GL_STENCIL_ATTACHMENT, depth_stencil_);
    if (!(depthStencilFormat(GL_DRAW_FRAMEBUFFER, false) == wanted)) {
      refusal_ = guard::unsupported(
          "the driver has no framebuffer object with the program's depth and stencil format");
      return false;
    }
  }
  guard::clearErrors();
  built_ = true;
  return true;
}

void Shadow::attachCaptures(const std::vector<CaptureBuffer>& captures) {
  const auto wanted = [&](const Attached& attached) {
    return std::find(captures.begin(), captures.end(), attached.buffer) != captures.end();
  };
  for (const Attached& attached : captures_) {
    if (wanted(attached)) continue;
    attach(colorAttachment(attached.buffer.location), 0);
    gl().DeleteRenderbuffers(1, &attached.renderbuffer);
  }
  std::erase_if(captures_, [&](const Attached& attached) { return !wanted(attached); });
  for (const CaptureBuffer& capture : captures) {
    const auto have = [&](const Attached& attached) { return attached.buffer == capture; };
    if (std::any_of(captures_.begin(), captures_.end(), have)) continue;
    const GLenum format = capture.format == wire::CaptureFormat::Uint4 ? GL_RGBA32UI : GL_RGBA32F;
    captures_.push_back({capture, makeRenderbuffer(format, target_)});
    attach(colorAttachment(capture.location), captures_.back().renderbuffer);
  }
}

// Blits copy bit for bit between equal formats once nothing clips or converts them.
void Shadow::copyProgramContents() const {
  const auto blit = [&](GLbitfield buffers) {
    gl().BlitFramebuffer(0, 0, target_.width, target_.height, 0, 0, target_.width, target_.height, buffers,
                         GL_NEAREST);
  };
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer);
  GLint read_buffer = 0;
  gl().GetIntegerv(GL_READ_BUFFER, &read_buffer);
  for (const ColorBuffer& color : target_.colors) {
    std::vector<GLenum> only(static_cast<std::size_t>(color.draw_buffer) + 1, GL_NONE);
    only.back() = colorAttachment(color.draw_buffer);
    gl().DrawBuffers(static_cast<GLsizei>(only.size()), only.data());
    gl().ReadBuffer(color.source);
    blit(GL_COLOR_BUFFER_BIT);
  }
  gl().ReadBuffer(static_cast<GLenum>(read_buffer));
  GLbitfield rest = 0;
  if (target_.depth_stencil.depth_bits > 0) rest |= GL_DEPTH_BUFFER_BIT;
  if (target_.depth_stencil.stencil_bits > 0) rest |= GL_STENCIL_BUFFER_BIT;
  if (rest != 0) blit(rest);
}

void Shadow::selectDrawBuffers(const std::vector<CaptureBuffer>& captures) const {
  std::vector<GLenum> buffers;
  const auto use = [&](int index) {
    if (buffers.size() <= static_cast<std::size_t>(index))
      buffers.resize(static_cast<std::size_t>(index) + 1, GL_NONE);
    buffers[static_cast<std::size_t>(index)] = colorAttachment(index);
  };
  for (const ColorBuffer& color : target_.colors) use(color.draw_buffer);
  for (const CaptureBuffer& capture : captures) use(capture.location);
  if (buffers.empty()) buffers.push_back(GL_NONE);
  gl().DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
}

std::size_t Shadow::pixels() const {
  return static_cast<std::size_t>(target_.width) * static_cast<std::size_t>(target_.height);
}

// ---- reading
// -------------------------------------------------------------------------------------------------

void Shadow::readCapture(const CaptureBuffer& capture, void* words) const {
  const bool integer = capture.format == wire::CaptureFormat::Uint4;
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl().ReadBuffer(colorAttachment(capture.location));
  gl().ReadPixels(0, 0, target_.width, target_.height, integer ? GL_RGBA_INTEGER : GL_RGBA,
                  integer ? GL_UNSIGNED_INT : GL_FLOAT, words);
}

void Shadow::readOutput(const ColorBuffer& color, void* words) const {
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl().ReadBuffer(colorAttachment(color.draw_buffer));
  const Format& format = color.format;
  if (format.integer()) {
    gl().ReadPixels(0, 0, target_.width, target_.height, GL_RGBA_INTEGER, format.type, words);
    return;
  }
  if (!facts_.es || format.type == GL_FLOAT) {
    gl().ReadPixels(0, 0, target_.width, target_.height, GL_RGBA, GL_FLOAT, words);
    return;
  }
  // OpenGL ES reads normalized formats as bytes only: widened in place, from the end.
  gl().ReadPixels(0, 0, target_.width, target_.height, GL_RGBA, GL_UNSIGNED_BYTE, words);
  const auto* bytes = static_cast<const std::uint8_t*>(words);
  auto* floats = static_cast<float*>(words);
  for (std::size_t i = pixels() * 4; i-- > 0;) floats[i] = static_cast<float>(bytes[i]) / 255.0F;
}

std::vector<guard::Section> Shadow::sections() const {
  std::vector<guard::Section> result;
  for (const ColorBuffer& color : target_.colors) {
    // Components that the format lacks read as constants: they never differ, and are not counted.
    result.push_back({"draw buffer " + std::to_string(color.draw_buffer), pixels() * 16, 4,
                      pixels() * static_cast<std::size_t>(color.format.components()), true});
  }
  if (facts_.es) return result;
  if (target_.depth_stencil.depth_bits > 0) result.push_back({"the depth buffer", pixels() * 4, 4, pixels()});
  if (target_.depth_stencil.stencil_bits > 0) result.push_back({"the stencil buffer", pixels(), 1, pixels()});
  return result;
}

void Shadow::readOriginals(std::byte* destination) const {
  for (const ColorBuffer& color : target_.colors) {
    readOutput(color, destination);
    destination += pixels() * 16;
  }
  if (facts_.es) return;
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  if (target_.depth_stencil.depth_bits > 0) {
    gl().ReadPixels(0, 0, target_.width, target_.height, GL_DEPTH_COMPONENT,
                    target_.depth_stencil.depth_float ? GL_FLOAT : GL_UNSIGNED_INT, destination);
    destination += pixels() * 4;
  }
  if (target_.depth_stencil.stencil_bits > 0) {
    gl().ReadPixels(0, 0, target_.width, target_.height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, destination);
  }
}

}  // namespace shadestep::capture
