// Linked with another hook library, then with libOSMesa: RTLD_NEXT counts from whoever asks.
#include <GL/osmesa.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "loader.h"

extern "C" void* next_glFinish();

int main() {
  static unsigned char buffer[16 * 16 * 4];
  OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  loader::require(context && OSMesaMakeCurrent(context, buffer, GL_UNSIGNED_BYTE, 16, 16),
                  "no OSMesa context");
  loader::drawAndPrint(glClearColor, reinterpret_cast<void (*)(unsigned)>(dlsym(RTLD_DEFAULT, "glClear")),
                       glReadPixels, glGetString);
  std::printf("getpid: %s\n", getpid() == syscall(SYS_getpid) ? "right" : "wrong");
  loader::tellWhose("glFinish", next_glFinish());
  OSMesaDestroyContext(context);
}
