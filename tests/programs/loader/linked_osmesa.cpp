// Linked with libOSMesa.
#include <GL/osmesa.h>

#include "loader.h"

int main() {
  static unsigned char buffer[16 * 16 * 4];
  OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  loader::require(context && OSMesaMakeCurrent(context, buffer, GL_UNSIGNED_BYTE, 16, 16),
                  "no OSMesa context");
  loader::drawAndPrint(glClearColor, glClear, glReadPixels, glGetString);
  loader::tellWhose("glClear", &glClear);
  loader::tellWhose("OSMesaMakeCurrent", &OSMesaMakeCurrent);
  loader::tellWhose("glDrawArrays", OSMesaGetProcAddress("glDrawArrays"));
  std::printf("unknown: %s\n", OSMesaGetProcAddress("glNoSuchFunction") ? "found" : "null");
  OSMesaDestroyContext(context);
}
