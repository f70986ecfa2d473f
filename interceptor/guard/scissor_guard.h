// The scissor tests and boxes of all viewports, put back at the end of a scope. Runs inside the program under
// debug: throws nothing, starts no thread, calls GL only through dispatch::gl().
#pragma once

#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/guards.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::guard {

class ScissorGuard {
 public:
  explicit ScissorGuard(const ContextFacts&);
  ~ScissorGuard();
  ScissorGuard(const ScissorGuard&) = delete;
  ScissorGuard& operator=(const ScissorGuard&) = delete;

  // From here on fragments are drawn only where the program lets them, and inside of this box (pixels of the
  // window, lower left corner and size, 0 allowed).
  void restrictTo(int x, int y, int width, int height) const;

 private:
  struct Test {
    GLboolean enabled = 0;
    GLint box[4] = {};
  };
  void set(std::size_t viewport, const GLint (&box)[4]) const;

  bool indexed_;
  CapabilityGuard capability_;
  std::vector<Test> tests_;  // one per viewport; one where they are not indexed
};

}  // namespace shadestep::guard
