// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/texture_level.h"

#include <array>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

struct Target {
  GLenum target, binding, image;  // image: what glGetTexLevelParameter wants
};
constexpr std::array kTargets = {
    Target{GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D, GL_TEXTURE_2D},
    Target{GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE, GL_TEXTURE_RECTANGLE},
    Target{GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D, GL_TEXTURE_3D},
    Target{GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_2D_ARRAY},
    Target{GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP, GL_TEXTURE_CUBE_MAP_POSITIVE_X},
    Target{GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D, GL_TEXTURE_1D},
    Target{GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY, GL_TEXTURE_1D_ARRAY},
    Target{GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, GL_TEXTURE_CUBE_MAP_ARRAY},
    Target{GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE, GL_TEXTURE_2D_MULTISAMPLE},
    Target{GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY,
           GL_TEXTURE_2D_MULTISAMPLE_ARRAY},
    Target{GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER, GL_TEXTURE_BUFFER},
};

// 0 if the context does not know the parameter.
GLint parameter(GLenum image, GLint level, GLenum name) {
  GLint value = 0;
  gl().GetTexLevelParameteriv(image, level, name, &value);
  return clearErrors() ? 0 : value;
}

// The texture is bound to `entry`'s target.
TextureLevel measure(const Target& entry, GLint level) {
  const auto ask = [&](GLenum name) { return parameter(entry.image, level, name); };
  TextureLevel result;
  result.target = entry.target;
  result.width = ask(GL_TEXTURE_WIDTH);
  result.height = ask(GL_TEXTURE_HEIGHT);
  result.depth = ask(GL_TEXTURE_DEPTH);
  for (const GLenum name :
       {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE}) {
    result.bits += ask(name);
  }
  result.luminance = ask(GL_TEXTURE_LUMINANCE_SIZE) + ask(GL_TEXTURE_INTENSITY_SIZE) > 0;
  result.samples = ask(GL_TEXTURE_SAMPLES);
  result.fixed_sample_locations = result.samples == 0 || ask(GL_TEXTURE_FIXED_SAMPLE_LOCATIONS) != 0;
  result.internal_format = static_cast<GLenum>(ask(GL_TEXTURE_INTERNAL_FORMAT));
  if (entry.target == GL_TEXTURE_CUBE_MAP) result.depth = 6;
  if (entry.target == GL_TEXTURE_1D_ARRAY) {
    result.depth = result.height;
    result.height = 1;
  }
  if (entry.target == GL_TEXTURE_BUFFER) {
    result.buffer = static_cast<GLuint>(ask(GL_TEXTURE_BUFFER_DATA_STORE_BINDING));
    result.offset = ask(GL_TEXTURE_BUFFER_OFFSET);
    result.bytes = ask(GL_TEXTURE_BUFFER_SIZE);
  }
  return result;
}

const Target* entryOf(GLenum target) {
  for (const Target& entry : kTargets)
    if (entry.target == target) return &entry;
  return nullptr;
}

}  // namespace

TextureLevel boundLevel(GLenum target, GLint level) {
  const Target* entry = entryOf(target);
  return entry != nullptr ? measure(*entry, level) : TextureLevel{};
}

GLenum textureBinding(GLenum target) {
  const Target* entry = entryOf(target);
  return entry != nullptr ? entry->binding : 0;
}

// A texture keeps the target that it was first bound to, and binding it to another is an error without
// effect: the target is found by trying.
TextureLevel textureLevel(GLuint texture, GLint level) {
  clearErrors();
  for (const Target& entry : kTargets) {
    GLint before = 0;
    gl().GetIntegerv(entry.binding, &before);
    if (clearErrors()) continue;  // this context has no such target
    gl().BindTexture(entry.target, texture);
    if (clearErrors()) continue;
    const TextureLevel result = measure(entry, level);
    gl().BindTexture(entry.target, static_cast<GLuint>(before));
    return result;
  }
  return {};
}

}  // namespace shadestep::guard
