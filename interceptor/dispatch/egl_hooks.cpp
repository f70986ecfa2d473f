// What EGL calls mean to the dispatch. Runs inside the program under debug.
#include "interceptor/dispatch/contexts.h"
#include "interceptor/dispatch/lookup.h"
#include "interceptor/registry/egl_hook_declarations.h"

namespace shadestep::calls {

using dispatch::Provider;

void after_eglCreateContext(EGLContext result, EGLDisplay dpy, EGLConfig, EGLContext share_context,
                            const EGLint*) {
  dispatch::contextCreated(Provider::egl, dpy, result, share_context);
}

void after_eglDestroyContext(EGLBoolean result, EGLDisplay, EGLContext ctx) {
  if (result) dispatch::contextDestroyed(Provider::egl, ctx);
}

void after_eglMakeCurrent(EGLBoolean result, EGLDisplay dpy, EGLSurface draw, EGLSurface read,
                          EGLContext ctx) {
  if (!result) return;
  dispatch::contextMadeCurrent(Provider::egl, {.display = dpy,
                                               .handle = ctx,
                                               .draw_drawable = reinterpret_cast<std::uintptr_t>(draw),
                                               .read_drawable = reinterpret_cast<std::uintptr_t>(read)});
}

void after_eglReleaseThread(EGLBoolean result) {
  if (result) dispatch::contextMadeCurrent(Provider::egl, {});
}

__eglMustCastToProperFunctionPointerType replace_eglGetProcAddress(const char* procname) {
  return dispatch::ours(procname,
                        dispatch::inDriver([&] { return dispatch::eglTable.GetProcAddress(procname); }));
}

}  // namespace shadestep::calls
