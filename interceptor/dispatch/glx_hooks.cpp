// What GLX calls mean to the dispatch. Runs inside the program under debug.
#include "interceptor/dispatch/contexts.h"
#include "interceptor/dispatch/lookup.h"
#include "interceptor/registry/glx_hook_declarations.h"

namespace shadestep::calls {

using dispatch::Provider;

void after_glXCreateContext(GLXContext result, Display* dpy, XVisualInfo*, GLXContext shareList, Bool) {
  dispatch::contextCreated(Provider::glx, dpy, result, shareList);
}

void after_glXCreateNewContext(GLXContext result, Display* dpy, GLXFBConfig, int, GLXContext share_list,
                               Bool) {
  dispatch::contextCreated(Provider::glx, dpy, result, share_list);
}

void after_glXCreateContextAttribsARB(GLXContext result, Display* dpy, GLXFBConfig, GLXContext share_context,
                                      Bool, const int*) {
  dispatch::contextCreated(Provider::glx, dpy, result, share_context);
}

void after_glXCreateContextWithConfigSGIX(GLXContext result, Display* dpy, GLXFBConfigSGIX, int,
                                          GLXContext share_list, Bool) {
  dispatch::contextCreated(Provider::glx, dpy, result, share_list);
}

void after_glXDestroyContext(Display*, GLXContext ctx) {
  dispatch::contextDestroyed(Provider::glx, ctx);
}

void after_glXMakeCurrent(Bool result, Display* dpy, GLXDrawable drawable, GLXContext ctx) {
  after_glXMakeContextCurrent(result, dpy, drawable, drawable, ctx);
}

void after_glXMakeContextCurrent(Bool result, Display* dpy, GLXDrawable draw, GLXDrawable read,
                                 GLXContext ctx) {
  if (!result) return;
  dispatch::contextMadeCurrent(Provider::glx,
                               {.display = dpy, .handle = ctx, .draw_drawable = draw, .read_drawable = read});
}

void after_glXMakeCurrentReadSGI(Bool result, Display* dpy, GLXDrawable draw, GLXDrawable read,
                                 GLXContext ctx) {
  after_glXMakeContextCurrent(result, dpy, draw, read, ctx);
}

__GLXextFuncPtr replace_glXGetProcAddress(const GLubyte* procName) {
  const __GLXextFuncPtr real =
      dispatch::inDriver([&] { return dispatch::glxTable.GetProcAddress(procName); });
  return dispatch::ours(reinterpret_cast<const char*>(procName), real);
}

__GLXextFuncPtr replace_glXGetProcAddressARB(const GLubyte* procName) {
  const __GLXextFuncPtr real =
      dispatch::inDriver([&] { return dispatch::glxTable.GetProcAddressARB(procName); });
  return dispatch::ours(reinterpret_cast<const char*>(procName), real);
}

}  // namespace shadestep::calls
