// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/plain_samplers.h"

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/gl_enums.h"

namespace shadestep::guard {

using dispatch::gl;

PlainSamplersGuard::PlainSamplersGuard(const std::vector<int>& units, bool levels) {
  if (units.empty()) return;
  gl().GenSamplers(1, &sampler_);
  gl().SamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, levels ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
  gl().SamplerParameteri(sampler_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl().SamplerParameteri(sampler_, axis, GL_CLAMP_TO_EDGE);
  GLint active = 0;
  gl().GetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (const int unit : units) {
    GLint sampler = 0;
    gl().ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl().GetIntegerv(GL_SAMPLER_BINDING, &sampler);
    before_.emplace_back(static_cast<GLuint>(unit), static_cast<GLuint>(sampler));
    gl().BindSampler(static_cast<GLuint>(unit), sampler_);
  }
  gl().ActiveTexture(static_cast<GLenum>(active));
}

PlainSamplersGuard::~PlainSamplersGuard() {
  for (const auto& [unit, sampler] : before_) gl().BindSampler(unit, sampler);
  if (sampler_ != 0) gl().DeleteSamplers(1, &sampler_);
}

}  // namespace shadestep::guard
