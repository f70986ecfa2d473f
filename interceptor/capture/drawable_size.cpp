// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/drawable_size.h"

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/egl_table.h"
#include "interceptor/registry/glx_table.h"

namespace shadestep::capture {
namespace {

using dispatch::Context;

// libX11 reports errors to a handler that ends the program; a drawable that was current a moment ago raises
// none.
DrawableSize glxSize(const Context& context) {
  unsigned int width = 0;
  unsigned int height = 0;
  auto* display = static_cast<Display*>(context.display);
  dispatch::glxTable.QueryDrawable(display, context.draw_drawable, GLX_WIDTH, &width);
  dispatch::glxTable.QueryDrawable(display, context.draw_drawable, GLX_HEIGHT, &height);
  return {static_cast<int>(width), static_cast<int>(height)};
}

DrawableSize eglSize(const Context& context) {
  DrawableSize size;
  auto* surface = reinterpret_cast<EGLSurface>(context.draw_drawable);
  dispatch::eglTable.QuerySurface(context.display, surface, EGL_WIDTH, &size.width);
  dispatch::eglTable.QuerySurface(context.display, surface, EGL_HEIGHT, &size.height);
  return size;
}

}  // namespace

std::optional<DrawableSize> drawableSize() {
  const Context* context = dispatch::currentContext();
  if (context == nullptr) return std::nullopt;
  DrawableSize size{context->width, context->height};
  if (context->provider == dispatch::Provider::glx && context->draw_drawable != 0) size = glxSize(*context);
  if (context->provider == dispatch::Provider::egl && context->draw_drawable != 0) size = eglSize(*context);
  if (size.width <= 0 || size.height <= 0) return std::nullopt;
  return size;
}

}  // namespace shadestep::capture
