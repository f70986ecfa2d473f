// A plug-in linked with libOSMesa, with a function of a common name for itself.
#include <GL/osmesa.h>

#include "loader.h"

extern "C" const char* plugin_name() {
  return "the plug-in's";
}

extern "C" const char* plugin_run() {
  static unsigned char buffer[16 * 16 * 4];
  OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  loader::require(context && OSMesaMakeCurrent(context, buffer, GL_UNSIGNED_BYTE, 16, 16),
                  "no OSMesa context");
  loader::drawAndPrint(glClearColor, glClear, glReadPixels, glGetString);
  loader::tellWhose("glClear", &glClear);
  loader::tellWhose("OSMesaMakeCurrent", &OSMesaMakeCurrent);
  loader::tellWhose("glFinish by name", dlsym(RTLD_DEFAULT, "glFinish"));
  OSMesaDestroyContext(context);
  return plugin_name();
}
