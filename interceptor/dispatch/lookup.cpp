// dlsym, as the program sees it. Runs inside the program under debug.
#include "interceptor/dispatch/lookup.h"

#include <dlfcn.h>
#include <link.h>

#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/dispatch/libc_hooks.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

namespace {

// Looks `name` up in the library around `address` and what that was loaded with, as by a handle of its own.
void* inLibraryAround(const void* address, const char* name) {
  Dl_info info;
  link_map* library = nullptr;
  if (!dladdr1(address, &info, reinterpret_cast<void**>(&library), RTLD_DL_LINKMAP)) return nullptr;
  const bool program = library->l_name[0] == '\0';
  void* handle = dlopen(program ? nullptr : library->l_name, RTLD_LAZY | RTLD_NOLOAD);
  void* found = handle ? realDlsym(handle, name) : nullptr;
  if (handle) dlclose(handle);
  return found;
}

bool inSameLibrary(const void* one, const void* other) {
  Dl_info first;
  Dl_info second;
  return dladdr(one, &first) && dladdr(other, &second) && first.dli_fbase == second.dli_fbase;
}

// A library that defines the name itself and asks for the next one is a hook like us, further down the chain.
bool isHook(const void* caller, const char* name) {
  const void* own = inLibraryAround(caller, name);
  return own && inSameLibrary(own, caller);
}

// What the look-up would have found if our library were not there. If nothing, dlerror says so.
void* withoutUs(void* handle, const char* name, const void* caller, Function wrapper) {
  const void* us = reinterpret_cast<const void*>(wrapper);
  if (handle != RTLD_NEXT) {
    void* found = realDlsym(handle, name);
    if (found != us) return found;
  }
  if (handle == RTLD_DEFAULT) {
    // A plug-in sees the libraries that were loaded for it alone.
    void* found = inLibraryAround(caller, name);
    if (found && found != us) return found;
  }
  return realDlsym(RTLD_NEXT, name);
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

LibcAnswer shadestepDlsym(void* handle, const char* name, const void* caller) {
  using namespace shadestep::dispatch;
  const LibcAnswer pass_on{addressOfReal("dlsym"), 0};
  if (!name || !canBeGl(name) || insideDriver()) return pass_on;
  const Wrapper* wrapper = findWrapper(name);
  if (!wrapper || (handle == RTLD_NEXT && isHook(caller, name))) return pass_on;
  void* real = withoutUs(handle, name, caller, wrapper->function);
  if (!real) return {nullptr, 1};
  dlerror();  // of a look-up that did not matter
  adopt(*wrapper, reinterpret_cast<Function>(real));
  return {reinterpret_cast<void*>(wrapper->function), 1};
}
