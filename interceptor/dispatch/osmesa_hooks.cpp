// What OSMesa calls mean to the dispatch. Runs inside the program under debug.
#include "interceptor/dispatch/contexts.h"
#include "interceptor/dispatch/lookup.h"
#include "interceptor/registry/osmesa_hook_declarations.h"

namespace shadestep::calls {

using dispatch::Provider;

void after_OSMesaCreateContext(OSMesaContext result, GLenum, OSMesaContext sharelist) {
  dispatch::contextCreated(Provider::osmesa, nullptr, result, sharelist);
}

void after_OSMesaCreateContextExt(OSMesaContext result, GLenum, GLint, GLint, GLint,
                                  OSMesaContext sharelist) {
  dispatch::contextCreated(Provider::osmesa, nullptr, result, sharelist);
}

void after_OSMesaCreateContextAttribs(OSMesaContext result, const int*, OSMesaContext sharelist) {
  dispatch::contextCreated(Provider::osmesa, nullptr, result, sharelist);
}

// Before: its address may be another context's as soon as it is gone. A current one is released thereby.
void before_OSMesaDestroyContext(OSMesaContext ctx) {
  if (ctx && dispatch::isBound(Provider::osmesa, ctx)) dispatch::contextMadeCurrent(Provider::osmesa, {});
  dispatch::contextDestroyed(Provider::osmesa, ctx);
}

void after_OSMesaMakeCurrent(GLboolean result, OSMesaContext ctx, void*, GLenum, GLsizei width,
                             GLsizei height) {
  if (!result) return;
  dispatch::contextMadeCurrent(Provider::osmesa, {.handle = ctx, .width = width, .height = height});
}

OSMESAproc replace_OSMesaGetProcAddress(const char* funcName) {
  return dispatch::ours(funcName,
                        dispatch::inDriver([&] { return dispatch::osmesaTable.GetProcAddress(funcName); }));
}

}  // namespace shadestep::calls
