// Linked with no GL: libOSMesa by dlopen (for itself alone), everything by dlsym.
#include "loader.h"

namespace {

template <class Function>
Function* byName(void* library, const char* name) {
  auto* function = reinterpret_cast<Function*>(dlsym(library, name));
  loader::require(function, name);
  loader::tellWhose(name, function);
  return function;
}

}  // namespace

int main() {
  void* library = dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_LOCAL);
  loader::require(library, "no libOSMesa.so.8");
  static unsigned char buffer[16 * 16 * 4];
  void* context = byName<void*(unsigned, int, int, int, void*)>(library, "OSMesaCreateContextExt")(
      0x1908, 24, 8, 0, nullptr);
  auto* makeCurrent = byName<unsigned char(void*, void*, unsigned, int, int)>(library, "OSMesaMakeCurrent");
  loader::require(context && makeCurrent(context, buffer, 0x1401, 16, 16), "no OSMesa context");
  loader::drawAndPrint(byName<void(float, float, float, float)>(library, "glClearColor"),
                       byName<void(unsigned)>(library, "glClear"),
                       byName<void(int, int, int, int, unsigned, unsigned, void*)>(library, "glReadPixels"),
                       byName<const unsigned char*(unsigned)>(library, "glGetString"));
  std::printf("unknown: %s\n", dlsym(library, "glNoSuchFunction") ? "found" : "null");
}
