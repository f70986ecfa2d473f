// A square target and one triangle that covers it: every fragment of the draw is the agent's own (Strengert
// 2010, 7.2.1). Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <vector>

#include "interceptor/guard/refusal.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

class Covering {
 public:
  Covering() = default;
  ~Covering();
  Covering(const Covering&) = delete;
  Covering& operator=(const Covering&) = delete;

  // Binds a target of `size` x `size` with `outputs` RGBA32F colour buffers, and a vertex array whose
  // attribute `position` (-1: none) holds the triangle. The caller holds the guards of framebuffers, vertex
  // arrays and raster.
  guard::Refusal bind(int size, int outputs, int position);
  void draw() const;
  void readOutput(int index, void* floats) const;
  int size() const { return size_; }

 private:
  void release();
  int size_ = 0;
  GLuint framebuffer_ = 0;
  std::vector<GLuint> colors_;
  GLuint vertex_array_ = 0, vertices_ = 0;
};

}  // namespace shadestep::capture
