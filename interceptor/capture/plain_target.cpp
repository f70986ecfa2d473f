// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/plain_target.h"

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::capture {

using dispatch::gl;

PlainTarget::~PlainTarget() {
  if (framebuffer_ != 0) gl().DeleteFramebuffers(1, &framebuffer_);
  if (pixel_ != 0) gl().DeleteRenderbuffers(1, &pixel_);
}

void PlainTarget::bind() {
  if (framebuffer_ != 0) return gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl().GenFramebuffers(1, &framebuffer_);
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl().GenRenderbuffers(1, &pixel_);
  gl().BindRenderbuffer(GL_RENDERBUFFER, pixel_);
  gl().RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 1, 1);
  gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixel_);
}

}  // namespace shadestep::capture
