// Linked with no GL: what dlsym answers for names that are not there, not GL's, or of GL without a GL.
#include <unistd.h>

#include <initializer_list>

#include "loader.h"

namespace {

void tell(const char* how, const char* name, void* handle) {
  dlerror();
  const bool found = dlsym(handle, name) != nullptr;
  const bool error = dlerror() != nullptr;
  std::printf("%s %s: %s, %s\n", how, name, found ? "found" : "null", error ? "error" : "no error");
}

}  // namespace

int main() {
  void* self = dlopen(nullptr, RTLD_LAZY);
  for (const char* name : {"glClear", "glXSwapBuffers", "eglMakeCurrent", "OSMesaMakeCurrent",
                           "glNoSuchFunction", "glob", "egl", "getpid", "no_such_function", ""}) {
    tell("default", name, RTLD_DEFAULT);
    tell("self", name, self);
    tell("next", name, RTLD_NEXT);
  }
  std::printf("getpid: %s\n",
              reinterpret_cast<pid_t (*)()>(dlsym(RTLD_DEFAULT, "getpid"))() == getpid() ? "right" : "wrong");
  // A library loaded for someone else is not in the default order; asked by its handle it answers.
  void* osmesa = dlopen("libOSMesa.so.8", RTLD_LAZY | RTLD_LOCAL);
  loader::require(osmesa, "no libOSMesa.so.8");
  tell("default", "glClear", RTLD_DEFAULT);
  tell("handle", "glClear", osmesa);
  tell("handle", "glXSwapBuffers", osmesa);
  void* libc = dlopen("libc.so.6", RTLD_LAZY);
  tell("libc", "glClear", libc);
  tell("libc", "getpid", libc);
  loader::tellWhose("dlsym", &dlsym);
}
