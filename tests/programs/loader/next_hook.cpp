// A library that hooks glClear and getpid like others do: defines them and asks for the next.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>

extern "C" {
void glClear(unsigned mask) {
  static const auto real = reinterpret_cast<void (*)(unsigned)>(dlsym(RTLD_NEXT, "glClear"));
  std::puts("another hook's glClear");
  real(mask);
}

pid_t getpid() noexcept {
  static const auto real = reinterpret_cast<pid_t (*)()>(dlsym(RTLD_NEXT, "getpid"));
  std::puts("another hook's getpid");
  return real();
}

// Defines no such name: just looks for GL in this way.
void* next_glFinish() {
  return dlsym(RTLD_NEXT, "glFinish");
}
}
