// Texture units that are read without filter and comparison, by a sampler object of the agent's own; the
// program's are bound again when it goes. The caller has made sure of sampler objects (OpenGL 3.3, OpenGL
// ES 3.0). Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <utility>
#include <vector>

#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

class PlainSamplersGuard {
 public:
  // `levels`: of textures whose levels are all there; of others the base level alone can be read.
  PlainSamplersGuard(const std::vector<int>& units, bool levels);
  ~PlainSamplersGuard();
  PlainSamplersGuard(const PlainSamplersGuard&) = delete;
  PlainSamplersGuard& operator=(const PlainSamplersGuard&) = delete;

 private:
  GLuint sampler_ = 0;
  std::vector<std::pair<GLuint, GLuint>> before_;  // unit, its sampler
};

}  // namespace shadestep::guard
