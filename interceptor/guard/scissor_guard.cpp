// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/scissor_guard.h"

#include <algorithm>

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::guard {

using dispatch::gl;

ScissorGuard::ScissorGuard(const ContextFacts& facts)
    : indexed_(viewportCount(facts) > 0), capability_(GL_SCISSOR_TEST, viewportCount(facts)) {
  tests_.resize(static_cast<std::size_t>(std::max(viewportCount(facts), 1)));
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const auto index = static_cast<GLuint>(i);
    if (indexed_) {
      tests_[i].enabled = gl().IsEnabledi(GL_SCISSOR_TEST, index);
      gl().GetIntegeri_v(GL_SCISSOR_BOX, index, tests_[i].box);
    } else {
      tests_[i].enabled = gl().IsEnabled(GL_SCISSOR_TEST);
      gl().GetIntegerv(GL_SCISSOR_BOX, tests_[i].box);
    }
  }
}

ScissorGuard::~ScissorGuard() {
  for (std::size_t i = 0; i < tests_.size(); ++i) set(i, tests_[i].box);
}

void ScissorGuard::set(std::size_t viewport, const GLint (&box)[4]) const {
  if (indexed_)
    gl().ScissorIndexedv(static_cast<GLuint>(viewport), box);
  else
    gl().Scissor(box[0], box[1], box[2], box[3]);
}

void ScissorGuard::restrictTo(int x, int y, int width, int height) const {
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    GLint left = x, bottom = y, right = x + width, top = y + height;
    if (tests_[i].enabled == GL_TRUE) {
      const GLint(&own)[4] = tests_[i].box;
      left = std::max(left, own[0]);
      bottom = std::max(bottom, own[1]);
      right = std::min(right, own[0] + own[2]);
      top = std::min(top, own[1] + own[3]);
    }
    set(i, {left, bottom, std::max(right - left, 0), std::max(top - bottom, 0)});
  }
  capability_.enable();
}

}  // namespace shadestep::guard
