// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/describe_textures.h"

#include <algorithm>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/texture_level.h"

namespace shadestep::agent {
namespace {

using dispatch::gl;

GLint integer(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return guard::clearErrors() ? 0 : value;
}

// The active unit is another one only while this lives.
class UnitGuard {
 public:
  UnitGuard() : before_(integer(GL_ACTIVE_TEXTURE)) {}
  ~UnitGuard() { gl().ActiveTexture(static_cast<GLenum>(before_)); }
  UnitGuard(const UnitGuard&) = delete;
  UnitGuard& operator=(const UnitGuard&) = delete;

 private:
  GLint before_;
};

// Parameters of a sampler: those of the sampler object at the unit, else of the texture that is bound there.
class Parameters {
 public:
  Parameters(GLenum target, GLuint sampler) : target_(target), sampler_(sampler) {}
  GLint texture(GLenum name, GLint otherwise) const {
    GLint value = otherwise;
    gl().GetTexParameteriv(target_, name, &value);
    return guard::clearErrors() ? otherwise : value;
  }
  GLuint sampled(GLenum name) const {
    GLint value = 0;
    if (sampler_ != 0)
      gl().GetSamplerParameteriv(sampler_, name, &value);
    else
      gl().GetTexParameteriv(target_, name, &value);
    return guard::clearErrors() ? 0 : static_cast<GLuint>(value);
  }
  GLfloat number(GLenum name, GLfloat otherwise) const {
    GLfloat value = otherwise;
    if (sampler_ != 0)
      gl().GetSamplerParameterfv(sampler_, name, &value);
    else
      gl().GetTexParameterfv(target_, name, &value);
    return guard::clearErrors() ? otherwise : value;
  }

 private:
  GLenum target_;
  GLuint sampler_;
};

bool isMipmapped(GLenum min_filter) {
  return min_filter != GL_NEAREST && min_filter != GL_LINEAR;
}

// Texels that are fetched by their coordinates only.
bool isUnfiltered(GLenum target) {
  return target == GL_TEXTURE_BUFFER || target == GL_TEXTURE_2D_MULTISAMPLE ||
         target == GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
}

std::unique_ptr<wire::TextureSizeT> sizeOf(const guard::TextureLevel& level) {
  auto size = std::make_unique<wire::TextureSizeT>();
  size->width = level.width;
  size->height = std::max(level.height, 1);
  size->depth = std::max(level.depth, 1);
  return size;
}

// The levels from the base up, as long as each has half of the one before.
void describeLevels(GLenum target, const Parameters& parameters, wire::SampledTextureT& texture) {
  const bool single = isUnfiltered(target) || target == GL_TEXTURE_RECTANGLE;
  GLint last = single ? 0 : parameters.texture(GL_TEXTURE_MAX_LEVEL, 1000);
  texture.base_level = single ? 0 : parameters.texture(GL_TEXTURE_BASE_LEVEL, 0);
  if (!single && parameters.texture(GL_TEXTURE_IMMUTABLE_FORMAT, GL_FALSE) != GL_FALSE) {
    const GLint highest = std::max(parameters.texture(GL_TEXTURE_IMMUTABLE_LEVELS, 1), 1) - 1;
    texture.base_level = std::min(texture.base_level, highest);
    last = std::clamp(last, texture.base_level, highest);
  }
  const bool volume = target == GL_TEXTURE_3D;
  for (GLint level = texture.base_level; level <= std::max(last, texture.base_level); ++level) {
    const guard::TextureLevel now = guard::boundLevel(target, level);
    if (now.width <= 0) break;
    texture.samples = now.samples;
    texture.levels.push_back(sizeOf(now));
    if (now.width <= 1 && now.height <= 1 && (!volume || now.depth <= 1)) return;  // the smallest there is
    if (level == last) return;
  }
  if (texture.levels.empty()) {
    texture.reason = texture.texture == 0 ? "no texture is bound to its unit" : "its texture has no texels";
  } else if (isMipmapped(texture.min_filter)) {
    texture.reason = "its texture is incomplete: the minification filter wants mipmap levels that it lacks";
  }
}

void describeTexture(const guard::ContextFacts& context, GLuint program, GLenum target,
                     wire::SampledTextureT& texture) {
  const GLenum binding = guard::textureBinding(target);
  if (binding == 0) {
    texture.reason = "it reads something else than a texture";
    return;
  }
  const GLint location = gl().GetUniformLocation(program, texture.name.c_str());
  if (guard::clearErrors() || location < 0) {
    texture.reason = "the driver found it unused";
    return;
  }
  gl().GetUniformiv(program, location, &texture.unit);
  gl().ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(texture.unit));
  if (guard::clearErrors()) {
    texture.reason = "its unit does not exist";
    return;
  }
  texture.texture = static_cast<GLuint>(integer(binding));
  const bool objects = context.atLeast(33, 30) || context.has("GL_ARB_sampler_objects");
  const auto sampler = static_cast<GLuint>(objects ? integer(GL_SAMPLER_BINDING) : 0);
  const Parameters parameters(target, sampler);
  texture.min_filter = texture.mag_filter = GL_NEAREST;
  texture.wrap.assign(3, GL_CLAMP_TO_EDGE);
  if (!isUnfiltered(target)) {
    texture.min_filter = parameters.sampled(GL_TEXTURE_MIN_FILTER);
    texture.mag_filter = parameters.sampled(GL_TEXTURE_MAG_FILTER);
    texture.wrap = {parameters.sampled(GL_TEXTURE_WRAP_S), parameters.sampled(GL_TEXTURE_WRAP_T),
                    parameters.sampled(GL_TEXTURE_WRAP_R)};
    texture.min_lod = parameters.number(GL_TEXTURE_MIN_LOD, -1000);
    texture.max_lod = parameters.number(GL_TEXTURE_MAX_LOD, 1000);
    texture.lod_bias = context.es ? 0 : parameters.number(GL_TEXTURE_LOD_BIAS, 0);
    texture.anisotropy = parameters.number(GL_TEXTURE_MAX_ANISOTROPY, 1);
  }
  describeLevels(target, parameters, texture);
}

}  // namespace

wire::TexturesT describeTextures(const DrawFacts& facts, const wire::DescribeTexturesT& request) {
  wire::TexturesT answer;
  const bool readable = dispatch::available("glGetTexLevelParameteriv") && facts.program_reason.empty();
  const GLuint program = readable ? originalOf(facts, request.stage).program : 0;
  const UnitGuard unit;
  for (const auto& asked : request.samplers) {
    auto texture = std::make_unique<wire::SampledTextureT>();
    texture->name = asked->name;
    if (readable)
      describeTexture(facts.context, program, asked->target, *texture);
    else
      texture->reason = "this driver does not tell the sizes of textures";
    answer.textures.push_back(std::move(texture));
  }
  return answer;
}

}  // namespace shadestep::agent
