// dlsym, as the program sees it. Runs inside the program under debug.
#include "interceptor/dispatch/lookup.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdint>
#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

namespace {

// The library around an address, as a handle for dlsym (in glibc the two are one).
void* libraryAround(const void* address) {
  Dl_info info;
  link_map* library = nullptr;
  return dladdr1(address, &info, reinterpret_cast<void**>(&library), RTLD_DL_LINKMAP) ? library : nullptr;
}

bool inSameLibrary(const void* one, const void* other) {
  Dl_info first;
  Dl_info second;
  return dladdr(one, &first) && dladdr(other, &second) && first.dli_fbase == second.dli_fbase;
}

// A library that defines the name itself and asks for the next one is a hook like us, further down the chain.
bool isHook(const void* caller, const char* name) {
  void* library = libraryAround(caller);
  const void* own = library ? realDlsym(library, name) : nullptr;
  return own && inSameLibrary(own, caller);
}

// What the look-up would have found if our library were not there.
void* withoutUs(void* handle, const char* name, const void* caller, Function wrapper) {
  const void* us = reinterpret_cast<const void*>(wrapper);
  if (handle != RTLD_NEXT) {
    void* found = realDlsym(handle, name);
    if (found != us) return found;
  }
  if (void* found = realDlsym(RTLD_NEXT, name)) return found;
  if (handle != RTLD_DEFAULT) return nullptr;
  // A plug-in sees the libraries that were loaded for it alone.
  void* library = libraryAround(caller);
  void* found = library ? realDlsym(library, name) : nullptr;
  return found == us ? nullptr : found;
}

bool canBeGl(const char* name) {
  return std::strncmp(name, "gl", 2) == 0 || std::strncmp(name, "egl", 3) == 0 ||
         std::strncmp(name, "OSMesa", 6) == 0;
}

}  // namespace

Function ours(const char* name, Function real) {
  const Wrapper* wrapper = real && name ? findWrapper(name) : nullptr;
  return wrapper ? wrapper->function : real;
}

}  // namespace shadestep::dispatch

namespace dispatch = shadestep::dispatch;

extern "C" {

// Two words: returned in registers.
struct ShadestepLookup {
  void* result;             // if answered, what dlsym returns; else libc's own dlsym, which must answer
  std::uintptr_t answered;  // 0 or 1
};

// Called by the exported dlsym (dlsym_*) with the address that it will return to.
[[gnu::visibility("hidden")]] ShadestepLookup shadestepLookup(void* handle, const char* name,
                                                              const void* caller) {
  const ShadestepLookup passOn{dispatch::addressOfRealDlsym(), 0};
  if (!name || !dispatch::canBeGl(name) || dispatch::insideDriver()) return passOn;
  const dispatch::Wrapper* wrapper = dispatch::findWrapper(name);
  if (!wrapper || (handle == RTLD_NEXT && dispatch::isHook(caller, name))) return passOn;
  void* real = dispatch::withoutUs(handle, name, caller, wrapper->function);
  if (!real) return {nullptr, 1};
  dlerror();  // of a look-up that did not matter
  dispatch::adopt(*wrapper, reinterpret_cast<dispatch::Function>(real));
  return {reinterpret_cast<void*>(wrapper->function), 1};
}
}
