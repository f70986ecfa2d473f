// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/shadow.h"

#include <algorithm>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/fragment_guards.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

GLenum colorAttachment(int index) {
  return GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
}

void detach(GLenum attachment) {
  gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, attachment, GL_RENDERBUFFER, 0);
}

// Window-system framebuffers are stored from the top by Mesa. A copy that is not would be rasterized from the
// other side, and interpolated values would differ in their last bits. Mesa has the extension's own command in
// every context, but refuses it in those of the compatibility profile. Returns whether the copy is stored so.
bool storeAsWindow(const guard::ContextFacts& facts) {
  if (!facts.storesUpsideDown()) return false;
  guard::clearErrors();
  if (!facts.es || facts.framebufferDefaults()) {
    if (!dispatch::available("glFramebufferParameteri")) return false;
    gl().FramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, GL_TRUE);
  } else {
    gl().FramebufferParameteriMESA(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, GL_TRUE);
  }
  return gl().GetError() == GL_NO_ERROR;
}

// All of the target's pixels. Drivers count the bytes of one call in 32 bits, perhaps with a sign, and crash
// beyond: rows in parts.
void readPixels(const DrawTarget& target, GLenum format, GLenum type, std::size_t pixel_bytes, void* pixels) {
  constexpr std::size_t kMost = std::size_t{256} << 20;
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(target.width);
  const int rows = static_cast<int>(std::max<std::size_t>(kMost / std::max<std::size_t>(row_bytes, 1), 1));
  auto* destination = static_cast<std::byte*>(pixels);
  for (int y = 0; y < target.height; y += rows) {
    gl().ReadPixels(0, y, target.width, std::min(rows, target.height - y), format, type,
                    destination + row_bytes * static_cast<std::size_t>(y));
  }
}

// As readOutput gives it.
guard::Number numberOf(const Format& format) {
  if (!format.integer()) return guard::Number::real;
  return format.type == GL_INT ? guard::Number::signed_integer : guard::Number::unsigned_integer;
}

}  // namespace

Shadow::Shadow(const guard::ContextFacts& facts, const DrawTarget& target)
    : facts_(facts), target_(target), reader_(facts, target) {}

Shadow::~Shadow() {
  for (const GLuint framebuffer : {framebuffer_, layer_read_, layer_draw_}) {
    if (framebuffer != 0) gl().DeleteFramebuffers(1, &framebuffer);
  }
}

guard::Refusal Shadow::fill(const guard::FramebufferGuard& clip, const std::vector<CaptureBuffer>& captures,
                            Start start) {
  if (!built_ && !build()) return refusal_;
  clip.unclip();
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  if (start == Start::copied && facts_.es && target_.samples > 0) {
    return guard::unsupported(
        "OpenGL ES does not copy multisampled framebuffers; have replays start from the clear values "
        "(--buffers clear)");
  }
  if (start == Start::copied) copyProgramContents();
  attachCaptures(captures);
  selectDrawBuffers(captures);
  if (gl().CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return guard::limit(
        "the driver takes no framebuffer with the program's buffers and " + std::to_string(captures.size()) +
        " more of " + std::to_string(target_.width) + " x " + std::to_string(target_.height) +
        " pixels and 16 bytes a pixel; capture less at once, or have the program draw to a smaller target");
  }
  if (start == Start::cleared) clearBuffers();
  if (!captures.empty()) clearMarks(captures.front());
  clip.clipAsProgram();
  if (guard::clearErrors()) return guard::internal("the driver refused to copy the program's framebuffer");
  return {};
}

// ---- building
// ------------------------------------------------------------------------------------------------

bool Shadow::build() {
  gl().GenFramebuffers(1, &framebuffer_);
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  if (target_.framebuffer == 0) reader_.storedUpsideDown(storeAsWindow(facts_));
  if (facts_.framebufferDefaults()) takeDefaults();
  for (const ColorBuffer& color : target_.colors) {
    colors_.emplace_back(facts_, target_, color.format.internal_format);
    colors_.back().attach(colorAttachment(color.draw_buffer));
    if (!(attachmentFormat(GL_DRAW_FRAMEBUFFER, colorAttachment(color.draw_buffer)) == color.format)) {
      refusal_ = guard::unsupported("the driver has no framebuffer object with the format of draw buffer " +
                                    std::to_string(color.draw_buffer));
      return false;
    }
  }
  const DepthStencil& wanted = target_.depth_stencil;
  if (wanted.internal_format != 0) {
    depth_stencil_ = std::make_unique<Image>(facts_, target_, wanted.internal_format);
    if (wanted.depth_bits > 0) depth_stencil_->attach(GL_DEPTH_ATTACHMENT);
    if (wanted.stencil_bits > 0) depth_stencil_->attach(GL_STENCIL_ATTACHMENT);
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

// What the framebuffer is like while nothing is attached.
void Shadow::takeDefaults() const {
  const auto set = [](GLenum name, GLint value) {
    gl().FramebufferParameteri(GL_DRAW_FRAMEBUFFER, name, value);
  };
  set(GL_FRAMEBUFFER_DEFAULT_WIDTH, target_.width);
  set(GL_FRAMEBUFFER_DEFAULT_HEIGHT, target_.height);
  set(GL_FRAMEBUFFER_DEFAULT_LAYERS, target_.layers);
  set(GL_FRAMEBUFFER_DEFAULT_SAMPLES, target_.samples);
  set(GL_FRAMEBUFFER_DEFAULT_FIXED_SAMPLE_LOCATIONS, target_.fixed_sample_locations ? GL_TRUE : GL_FALSE);
}

void Shadow::attachCaptures(const std::vector<CaptureBuffer>& captures) {
  const auto wanted = [&](const Attached& attached) {
    return std::find(captures.begin(), captures.end(), attached.buffer) != captures.end();
  };
  for (const Attached& attached : captures_) {
    if (!wanted(attached)) detach(colorAttachment(attached.buffer.location));
  }
  std::erase_if(captures_, [&](const Attached& attached) { return !wanted(attached); });
  for (const CaptureBuffer& capture : captures) {
    const auto have = [&](const Attached& attached) { return attached.buffer == capture; };
    if (std::any_of(captures_.begin(), captures_.end(), have)) continue;
    const GLenum format = capture.format == wire::CaptureFormat::Uint4 ? GL_RGBA32UI : GL_RGBA32F;
    captures_.push_back({capture, std::make_unique<Image>(facts_, target_, format)});
    captures_.back().image->attach(colorAttachment(capture.location));
  }
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

// ---- contents
// ------------------------------------------------------------------------------------------------

void Shadow::copyProgramContents() {
  for (int layer = 0; layer < target_.layers; ++layer) copyLayer(layer);
  if (target_.layers > 0) {
    gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    return;
  }
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer);
  GLint read_buffer = 0;
  gl().GetIntegerv(GL_READ_BUFFER, &read_buffer);
  blitBuffers();
  gl().ReadBuffer(static_cast<GLenum>(read_buffer));
}

// Blits copy the first layer only: each has a pair of framebuffers to itself.
void Shadow::copyLayer(int layer) {
  if (layer_read_ == 0) gl().GenFramebuffers(1, &layer_read_);
  if (layer_draw_ == 0) gl().GenFramebuffers(1, &layer_draw_);
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, layer_read_);
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, layer_draw_);
  const auto pair = [&](GLenum theirs, const AttachedTexture& from, GLenum ours, const Image& to) {
    attachLayer(GL_READ_FRAMEBUFFER, theirs, from, layer);
    attachLayer(GL_DRAW_FRAMEBUFFER, ours, to.texture(), layer);
  };
  for (std::size_t i = 0; i < colors_.size(); ++i) {
    const ColorBuffer& color = target_.colors[i];
    pair(color.source, color.texture, colorAttachment(color.draw_buffer), colors_[i]);
  }
  if (target_.depth_stencil.depth_bits > 0)
    pair(GL_DEPTH_ATTACHMENT, target_.depth_texture, GL_DEPTH_ATTACHMENT, *depth_stencil_);
  if (target_.depth_stencil.stencil_bits > 0)
    pair(GL_STENCIL_ATTACHMENT, target_.stencil_texture, GL_STENCIL_ATTACHMENT, *depth_stencil_);
  blitBuffers();
}

// From the framebuffer bound for reading to that bound for drawing. Blits copy bit for bit between equal
// formats, and every sample, once nothing clips or converts them.
void Shadow::blitBuffers() const {
  const auto blit = [&](GLbitfield buffers) {
    gl().BlitFramebuffer(0, 0, target_.width, target_.height, 0, 0, target_.width, target_.height, buffers,
                         GL_NEAREST);
  };
  for (const ColorBuffer& color : target_.colors) {
    std::vector<GLenum> only(static_cast<std::size_t>(color.draw_buffer) + 1, GL_NONE);
    only.back() = colorAttachment(color.draw_buffer);
    gl().DrawBuffers(static_cast<GLsizei>(only.size()), only.data());
    gl().ReadBuffer(color.source);
    blit(GL_COLOR_BUFFER_BIT);
  }
  GLbitfield rest = 0;
  if (target_.depth_stencil.depth_bits > 0) rest |= GL_DEPTH_BUFFER_BIT;
  if (target_.depth_stencil.stencil_bits > 0) rest |= GL_STENCIL_BUFFER_BIT;
  if (rest != 0) blit(rest);
}

// The first capture says which pixels show a thread; what lies beside no thread in the others means nothing.
void Shadow::clearMarks(const CaptureBuffer& capture) {
  constexpr GLuint kZero[4] = {};
  constexpr GLfloat kZeroFloat[4] = {};
  if (capture.format == wire::CaptureFormat::Uint4) {
    gl().ClearBufferuiv(GL_COLOR, capture.location, kZero);
  } else {
    gl().ClearBufferfv(GL_COLOR, capture.location, kZeroFloat);
  }
}

void Shadow::clearBuffers() const {
  const guard::WriteMaskGuard masks(facts_);
  GLfloat color[4] = {};
  GLfloat depth = 1;
  GLint stencil = 0;
  gl().GetFloatv(GL_COLOR_CLEAR_VALUE, color);
  gl().GetFloatv(GL_DEPTH_CLEAR_VALUE, &depth);
  gl().GetIntegerv(GL_STENCIL_CLEAR_VALUE, &stencil);
  for (const ColorBuffer& buffer : target_.colors) {
    constexpr GLint kZero[4] = {};
    constexpr GLuint kZeroUnsigned[4] = {};
    if (buffer.format.type == GL_INT) {
      gl().ClearBufferiv(GL_COLOR, buffer.draw_buffer, kZero);
    } else if (buffer.format.type == GL_UNSIGNED_INT) {
      gl().ClearBufferuiv(GL_COLOR, buffer.draw_buffer, kZeroUnsigned);
    } else {
      gl().ClearBufferfv(GL_COLOR, buffer.draw_buffer, color);
    }
  }
  if (target_.depth_stencil.depth_bits > 0) gl().ClearBufferfv(GL_DEPTH, 0, &depth);
  if (target_.depth_stencil.stencil_bits > 0) gl().ClearBufferiv(GL_STENCIL, 0, &stencil);
}

std::size_t Shadow::pixels() const {
  return static_cast<std::size_t>(target_.width) * static_cast<std::size_t>(target_.height);
}

// ---- reading
// -------------------------------------------------------------------------------------------------

void Shadow::bindColor(int location, const Image& image, GLenum type, Plane plane) {
  if (image.isTexture())
    return reader_.bind(image, PlaneReader::Part::color, type, plane.layer, plane.sample);
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl().ReadBuffer(colorAttachment(location));
}

void Shadow::readCapture(const CaptureBuffer& capture, Plane plane, void* words) {
  const bool integer = capture.format == wire::CaptureFormat::Uint4;
  const auto attached = std::find_if(captures_.begin(), captures_.end(),
                                     [&](const Attached& one) { return one.buffer == capture; });
  if (attached == captures_.end()) return;
  bindColor(capture.location, *attached->image, integer ? GL_UNSIGNED_INT : GL_FLOAT, plane);
  readPixels(target_, integer ? GL_RGBA_INTEGER : GL_RGBA, integer ? GL_UNSIGNED_INT : GL_FLOAT, 16, words);
}

void Shadow::readOutput(const ColorBuffer& color, Plane plane, void* words) {
  const Format& format = color.format;
  const auto index = static_cast<std::size_t>(&color - target_.colors.data());
  bindColor(color.draw_buffer, colors_[index], format.type, plane);
  if (format.integer()) {
    readPixels(target_, GL_RGBA_INTEGER, format.type, 16, words);
    return;
  }
  if (!facts_.es || format.type == GL_FLOAT || target_.samples > 0) {
    readPixels(target_, GL_RGBA, GL_FLOAT, 16, words);
    return;
  }
  // OpenGL ES reads normalized formats as bytes only: widened in place, from the end.
  readPixels(target_, GL_RGBA, GL_UNSIGNED_BYTE, 4, words);
  const auto* bytes = static_cast<const std::uint8_t*>(words);
  auto* floats = static_cast<float*>(words);
  for (std::size_t i = pixels() * 4; i-- > 0;) floats[i] = static_cast<float>(bytes[i]) / 255.0F;
}

void Shadow::bindDepthStencil(PlaneReader::Part part, Plane plane) {
  if (depth_stencil_->isTexture()) {
    reader_.bind(*depth_stencil_, part, GL_FLOAT, plane.layer, plane.sample);
  } else {
    gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  }
}

void Shadow::readDepth(Plane plane, void* words) {
  bindDepthStencil(PlaneReader::Part::depth, plane);
  const bool fetched = target_.samples > 0;  // a sample's depth is a colour by now
  readPixels(target_, fetched ? GL_RED : GL_DEPTH_COMPONENT,
             fetched || target_.depth_stencil.depth_float ? GL_FLOAT : GL_UNSIGNED_INT, 4, words);
}

void Shadow::readStencil(Plane plane, void* bytes) {
  bindDepthStencil(PlaneReader::Part::stencil, plane);
  readPixels(target_, target_.samples > 0 ? GL_RED_INTEGER : GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, 1, bytes);
}

bool Shadow::readsDepth() const {
  return target_.depth_stencil.depth_bits > 0 && !facts_.es;
}

bool Shadow::readsStencil() const {
  return target_.depth_stencil.stencil_bits > 0 && !facts_.es &&
         (target_.samples == 0 || facts_.stencilTextures());
}

std::vector<Plane> Shadow::planes() const {
  std::vector<Plane> result;
  for (int layer = 0; layer < std::max(target_.layers, 1); ++layer) {
    for (int sample = 0; sample < std::max(target_.samples, 1); ++sample) result.push_back({layer, sample});
  }
  return result;
}

std::vector<guard::Section> Shadow::sections() const {
  const std::size_t texels = pixels() * static_cast<std::size_t>(target_.planes());
  std::vector<guard::Section> result;
  for (const ColorBuffer& color : target_.colors) {
    // Components that the format lacks read as constants: they never differ, and are not counted.
    result.push_back({"draw buffer " + std::to_string(color.draw_buffer),
                      texels * 16,
                      4,
                      texels * static_cast<std::size_t>(color.format.components()),
                      true,
                      {numberOf(color.format)}});
  }
  if (readsDepth()) {
    const bool real = target_.samples > 0 || target_.depth_stencil.depth_float;
    result.push_back({"the depth buffer",
                      texels * 4,
                      4,
                      texels,
                      false,
                      {real ? guard::Number::real : guard::Number::fraction}});
  }
  if (readsStencil()) result.push_back({"the stencil buffer", texels, 1, texels});
  return result;
}

void Shadow::readOriginals(std::byte* destination) {
  const std::vector<Plane> all = planes();
  for (const ColorBuffer& color : target_.colors) {
    for (const Plane plane : all) {
      readOutput(color, plane, destination);
      destination += pixels() * 16;
    }
  }
  for (std::size_t i = 0; readsDepth() && i < all.size(); ++i) {
    readDepth(all[i], destination);
    destination += pixels() * 4;
  }
  for (std::size_t i = 0; readsStencil() && i < all.size(); ++i) {
    readStencil(all[i], destination);
    destination += pixels();
  }
}

}  // namespace shadestep::capture
