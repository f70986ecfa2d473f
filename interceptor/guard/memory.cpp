// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/memory.h"

#include <algorithm>
#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/buffer_bytes.h"
#include "interceptor/guard/errors.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

GLuint binding(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return static_cast<GLuint>(value);
}

// An array texture of as many texels of the same number of bits: copies between the two keep every bit
// (OpenGL 4.6, 18.3.3), and it can be read back whatever the image is.
GLuint makeTexture(const TextureLevel& shape) {
  const GLenum format = shape.bits == 128  ? GL_RGBA32UI
                        : shape.bits == 64 ? GL_RG32UI
                        : shape.bits == 32 ? GL_R32UI
                        : shape.bits == 16 ? GL_R16UI
                                           : GL_R8UI;
  const GLuint before = binding(GL_TEXTURE_BINDING_2D_ARRAY);
  GLuint texture = 0;
  gl().GenTextures(1, &texture);
  gl().BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gl().TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, format, shape.width, shape.height, shape.depth);
  gl().BindTexture(GL_TEXTURE_2D_ARRAY, before);
  if (!clearErrors()) return texture;
  gl().DeleteTextures(1, &texture);
  return 0;
}

void copyTexels(const TextureLevel& shape, GLuint from, GLenum from_target, GLint from_level, GLuint to,
                GLenum to_target, GLint to_level) {
  gl().CopyImageSubData(from, from_target, from_level, 0, 0, 0, to, to_target, to_level, 0, 0, 0, shape.width,
                        shape.height, shape.depth);
}

Refusal noMemoryFor(const std::string& name) {
  return limit("the driver has no memory for a copy of " + name +
               ", which the shader can write and a replay must leave as it was");
}

Refusal cannotCopy(const std::string& name, const std::string& reason) {
  return unsupported("the shader can write to " + name +
                     ", which cannot be put back after a replay: " + reason);
}

}  // namespace

WritableMemory::~WritableMemory() {
  for (const BufferRange& range : ranges_) gl().DeleteBuffers(1, &range.copy);
  for (const Image& image : images_) gl().DeleteTextures(1, &image.copy);
}

// ---- saving
// --------------------------------------------------------------------------------------------------

Refusal WritableMemory::save(const WritableBindings& bindings) {
  if (bindings.storage.empty() && bindings.counters.empty() && bindings.images.empty()) return {};
  gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  const CopyBindingGuard guard;
  for (const GLuint index : bindings.storage) {
    Refusal refusal = saveBinding(GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                  GL_SHADER_STORAGE_BUFFER_SIZE, index,
                                  "the storage buffer at binding " + std::to_string(index));
    if (!refusal.text.empty()) return refusal;
  }
  for (const GLuint index : bindings.counters) {
    Refusal refusal = saveBinding(GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START,
                                  GL_ATOMIC_COUNTER_BUFFER_SIZE, index,
                                  "the atomic counter buffer at binding " + std::to_string(index));
    if (!refusal.text.empty()) return refusal;
  }
  for (const GLuint unit : bindings.images) {
    if (Refusal refusal = saveImage(unit); !refusal.text.empty()) return refusal;
  }
  return {};
}

// `target`, `start`, `size`: the questions about the binding point.
Refusal WritableMemory::saveBinding(GLenum target, GLenum start, GLenum size, GLuint index,
                                    const std::string& name) {
  GLint buffer = 0;
  BufferRange range{name, 0, 0, 0, 0};
  gl().GetIntegeri_v(target, index, &buffer);
  gl().GetInteger64i_v(start, index, &range.offset);
  gl().GetInteger64i_v(size, index, &range.bytes);
  range.buffer = static_cast<GLuint>(buffer);
  return saveRange(std::move(range));
}

// A range of 0 bytes is the whole buffer.
Refusal WritableMemory::saveRange(BufferRange range) {
  if (range.buffer == 0) return {};
  GLint64 size = 0;
  gl().BindBuffer(GL_COPY_READ_BUFFER, range.buffer);
  gl().GetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &size);
  if (range.bytes == 0) range.bytes = size;
  range.bytes = std::min(range.bytes, size - range.offset);
  if (range.bytes <= 0) return {};
  const bool saved = std::any_of(ranges_.begin(), ranges_.end(), [&](const BufferRange& other) {
    return other.buffer == range.buffer && other.offset <= range.offset &&
           other.offset + other.bytes >= range.offset + range.bytes;
  });
  if (saved) return {};
  clearErrors();
  range.copy = makeBuffer(range.bytes);
  if (range.copy == 0) return noMemoryFor(range.name);
  ranges_.push_back(std::move(range));
  const BufferRange& kept = ranges_.back();
  copyBytes(kept.buffer, kept.offset, kept.copy, 0, kept.bytes);
  if (!clearErrors()) return {};
  const Refusal refusal = cannotCopy(kept.name, "the driver does not copy the buffer; is it mapped?");
  gl().DeleteBuffers(1, &kept.copy);
  ranges_.pop_back();
  return refusal;
}

Refusal WritableMemory::saveImage(GLuint unit) {
  GLint texture = 0;
  GLint level = 0;
  gl().GetIntegeri_v(GL_IMAGE_BINDING_NAME, unit, &texture);
  gl().GetIntegeri_v(GL_IMAGE_BINDING_LEVEL, unit, &level);
  if (texture == 0) return {};
  Image image{"the image at unit " + std::to_string(unit), static_cast<GLuint>(texture), level, {}, 0};
  const bool saved = std::any_of(images_.begin(), images_.end(), [&](const Image& other) {
    return other.texture == image.texture && other.level == level;
  });
  if (saved) return {};
  image.shape = textureLevel(image.texture, level);
  const TextureLevel& shape = image.shape;
  if (shape.target == GL_TEXTURE_BUFFER) {
    return saveRange({image.name, shape.buffer, shape.offset, shape.bytes, 0});
  }
  if (shape.samples > 0) return cannotCopy(image.name, "it is multisampled");
  if (shape.bits == 0 || shape.width == 0) return {};  // nothing there to write to
  if (!facts_.copiesImages()) {
    return cannotCopy(image.name,
                      "the driver lacks glCopyImageSubData (OpenGL 4.3, ES 3.2 or GL_ARB_copy_image)");
  }
  image.copy = makeTexture(shape);
  if (image.copy == 0) return noMemoryFor(image.name);
  copyTexels(shape, image.texture, shape.target, level, image.copy, GL_TEXTURE_2D_ARRAY, 0);
  if (clearErrors()) {
    gl().DeleteTextures(1, &image.copy);
    return cannotCopy(image.name, "the driver does not copy its format");
  }
  images_.push_back(std::move(image));
  return {};
}

// ---- putting back
// --------------------------------------------------------------------------------------------

void WritableMemory::restore() const {
  if (ranges_.empty() && images_.empty()) return;
  gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  const CopyBindingGuard guard;
  for (const BufferRange& range : ranges_) copyBytes(range.copy, 0, range.buffer, range.offset, range.bytes);
  for (const Image& image : images_) {
    copyTexels(image.shape, image.copy, GL_TEXTURE_2D_ARRAY, 0, image.texture, image.shape.target,
               image.level);
  }
  // Mesa's llvmpipe copies texels later, in threads of its own, and stages before rasterization do not wait
  // for them: what they store would be lost to the copy.
  if (!images_.empty()) gl().Finish();
}

// ---- reading
// -------------------------------------------------------------------------------------------------

std::size_t WritableMemory::texelBytes(const Image& image) const {
  // OpenGL ES reads integers as four words only.
  return facts_.es ? 16 : static_cast<std::size_t>(image.shape.bits) / 8;
}

std::vector<Section> WritableMemory::sections() const {
  std::vector<Section> result;
  for (const BufferRange& range : ranges_) {
    const auto bytes = static_cast<std::size_t>(range.bytes);
    result.push_back({range.name, bytes, 4, (bytes + 3) / 4});
  }
  for (const Image& image : images_) {
    const TextureLevel& shape = image.shape;
    const std::size_t texels = static_cast<std::size_t>(shape.width) *
                               static_cast<std::size_t>(shape.height) * static_cast<std::size_t>(shape.depth);
    const std::size_t bytes = texelBytes(image);
    result.push_back({image.name, texels * bytes, std::min<std::size_t>(bytes, 4),
                      texels * static_cast<std::size_t>((shape.bits + 31) / 32)});
  }
  return result;
}

Refusal WritableMemory::read(std::byte* destination) const {
  if (ranges_.empty() && images_.empty()) return {};
  gl().MemoryBarrier(GL_ALL_BARRIER_BITS);
  const CopyBindingGuard guard;
  const std::vector<Section> all = sections();
  std::size_t next = 0;
  for (const BufferRange& range : ranges_) {
    if (!readBytes(range.buffer, range.offset, range.bytes, destination)) return noMemoryFor(range.name);
    destination += all[next++].bytes;
  }
  for (const Image& image : images_) {
    readImage(image, destination);
    destination += all[next++].bytes;
  }
  return {};
}

void WritableMemory::readImage(const Image& image, std::byte* destination) const {
  const TextureLevel& shape = image.shape;
  const GLuint texture = makeTexture(shape);
  copyTexels(shape, image.texture, shape.target, image.level, texture, GL_TEXTURE_2D_ARRAY, 0);
  GLenum format = GL_RED_INTEGER;
  GLenum type = GL_UNSIGNED_INT;
  if (facts_.es || shape.bits == 128) {
    format = GL_RGBA_INTEGER;
  } else if (shape.bits == 64) {
    format = GL_RG_INTEGER;
  } else if (shape.bits < 32) {
    type = shape.bits == 16 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE;
  }
  const std::size_t layer_bytes =
      static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height) * texelBytes(image);
  const GLuint before = binding(GL_READ_FRAMEBUFFER_BINDING);
  GLuint framebuffer = 0;
  gl().GenFramebuffers(1, &framebuffer);
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  for (GLint layer = 0; layer < shape.depth; ++layer) {
    gl().FramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0, layer);
    gl().ReadPixels(0, 0, shape.width, shape.height, format, type, destination);
    destination += layer_bytes;
  }
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, before);
  gl().DeleteFramebuffers(1, &framebuffer);
  gl().DeleteTextures(1, &texture);
}

}  // namespace shadestep::guard
