// Runs inside the program under debug.
#include "interceptor/dispatch/resolve.h"

#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <span>
#include <string_view>

#include "interceptor/dispatch/driver_scope.h"
#include "interceptor/registry/egl_table.h"
#include "interceptor/registry/glx_table.h"
#include "interceptor/registry/osmesa_table.h"

namespace shadestep::dispatch {

constinit thread_local unsigned driverDepth = 0;

namespace {

using Names = std::span<const char* const>;

constexpr const char* kGlxLibraries[] = {"libGL.so.1", "libGLX.so.0"};
constexpr const char* kEglLibraries[] = {"libEGL.so.1"};
constexpr const char* kOsmesaLibraries[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
constexpr const char* kGlLibraries[] = {"libGL.so.1", "libOpenGL.so.0", "libGLESv2.so.2",
                                        "libGLESv1_CM.so.1"};

Function asFunction(void* address) {
  return reinterpret_cast<Function>(address);
}

// Looked up in libraries that the program has loaded; none is loaded for it. The handle is kept, so that the
// library stays where the tables say it is.
Function inLoadedLibraries(Names libraries, const char* name) {
  for (const char* library : libraries) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    if (!handle) continue;
    if (void* found = realDlsym(handle, name)) return asFunction(found);
    dlclose(handle);
  }
  return nullptr;
}

Function nextInOrder(const char* name) {
  return asFunction(realDlsym(RTLD_NEXT, name));
}

Function byGlx(const char* name) {
  return asFunction(reinterpret_cast<void*>(
      inDriver([&] { return glxTable.GetProcAddressARB(reinterpret_cast<const GLubyte*>(name)); })));
}
Function byEgl(const char* name) {
  return inDriver([&] { return eglTable.GetProcAddress(name); });
}
Function byOsmesa(const char* name) {
  return inDriver([&] { return osmesaTable.GetProcAddress(name); });
}

// Without a context: as the program's own linkage would have it, then wherever there is a GL.
Function anyGl(const char* name) {
  if (Function found = nextInOrder(name)) return found;
  if (Function found = inLoadedLibraries(kGlLibraries, name)) return found;
  if (Function found = inLoadedLibraries(kOsmesaLibraries, name)) return found;
  if (Function found = byEgl(name)) return found;
  if (Function found = byGlx(name)) return found;
  return byOsmesa(name);
}

// Whether the function lies in one of the usual GL libraries, by the name of its file.
bool inGlLibrary(Function function) {
  Dl_info info{};
  if (!dladdr(reinterpret_cast<void*>(function), &info) || !info.dli_fname) return false;
  const std::string_view path = info.dli_fname;
  const std::string_view file = path.substr(path.rfind('/') + 1);
  const auto isFile = [&](std::string_view library) {
    return file.starts_with(library.substr(0, library.find(".so") + 3));
  };
  return std::ranges::any_of(kGlLibraries, isFile) || std::ranges::any_of(kOsmesaLibraries, isFile);
}

// Another library that hooks the same function, after us in the program's search order.
Function anotherHook(const char* name) {
  Function next = nextInOrder(name);
  return next && !inGlLibrary(next) ? next : nullptr;
}

// Another hook keeps its turn; then the provider's own answer: it knows which of several loaded libraries is
// its.
Function realGl(Provider provider, const char* name) {
  if (provider == Provider::none) return anyGl(name);
  if (Function found = anotherHook(name)) return found;
  switch (provider) {
    case Provider::none:
      break;
    case Provider::glx:
      if (Function found = byGlx(name)) return found;
      return inLoadedLibraries(kGlLibraries, name);
    case Provider::egl:
      if (Function found = byEgl(name)) return found;
      return inLoadedLibraries(kGlLibraries, name);
    case Provider::osmesa:
      if (Function found = byOsmesa(name)) return found;
      return inLoadedLibraries(kOsmesaLibraries, name);
  }
  return nullptr;
}

// The next in the program's search order may be another library that hooks the same function: it keeps its
// turn.
Function realWindowSystem(const char* name, Names libraries, Function (*byName)(const char*)) {
  if (Function found = nextInOrder(name)) return found;
  if (Function found = inLoadedLibraries(libraries, name)) return found;
  return std::strstr(name, "GetProcAddress") ? nullptr : byName(name);
}

GlTable providerTables[4];
std::once_flag providerTablesFilled;

Provider providerOf(const GlTable* table) {
  for (Provider provider : {Provider::glx, Provider::egl, Provider::osmesa})
    if (table == &providerTables[static_cast<int>(provider)]) return provider;
  return Provider::none;
}

// Other threads read the entry meanwhile: a whole word, old or new, both right.
template <class Table>
void put(Table& table, unsigned index, Function function) {
  std::atomic_ref(reinterpret_cast<Function*>(&table)[index]).store(function, std::memory_order_release);
}

template <class Table>
Function resolveInto(Table& table, unsigned index, Function real, Function missing) {
  dlerror();  // failed lookups of ours are nothing to the program
  if (real) put(table, index, real);
  return real ? real : missing;
}

// Of window-system functions that were found by the program only.
struct Adopted {
  std::atomic<Function> glx[kGlxTableSize];
  std::atomic<Function> egl[kEglTableSize];
  std::atomic<Function> osmesa[kOsmesaTableSize];
};
constinit Adopted adopted{};

Function orElse(Function found, const std::atomic<Function>& known) {
  return found ? found : known.load();
}

}  // namespace

// The versions: since it is in libc proper, and of the former libdl.
void* addressOfReal(const char* libc_function) {
  for (const char* version : {"GLIBC_2.34", "GLIBC_2.2.5", "GLIBC_2.17"})
    if (void* found = dlvsym(RTLD_NEXT, libc_function, version)) return found;
  return nullptr;
}

void* realDlsym(void* handle, const char* name) {
  using Dlsym = void* (*)(void*, const char*);
  static std::atomic<Dlsym> known;
  Dlsym function = known.load(std::memory_order_relaxed);
  if (!function) {
    function = reinterpret_cast<Dlsym>(addressOfReal("dlsym"));
    known.store(function, std::memory_order_relaxed);
  }
  return function(handle, name);
}

GlTable* tableOf(Provider provider) {
  if (provider == Provider::none) return &tableWithoutContext;
  std::call_once(providerTablesFilled, [] { std::ranges::fill(providerTables, kUnresolvedGlTable); });
  return &providerTables[static_cast<int>(provider)];
}

Function resolveGl(unsigned index, Function missing) {
  GlTable& table = *currentTable;
  return resolveInto(table, index, realGl(providerOf(&table), kGlTableNames[index]), missing);
}

Function resolveGlx(unsigned index, Function missing) {
  const Function found = realWindowSystem(kGlxTableNames[index], kGlxLibraries, byGlx);
  return resolveInto(glxTable, index, orElse(found, adopted.glx[index]), missing);
}

Function resolveEgl(unsigned index, Function missing) {
  const Function found = realWindowSystem(kEglTableNames[index], kEglLibraries, byEgl);
  return resolveInto(eglTable, index, orElse(found, adopted.egl[index]), missing);
}

Function resolveOsmesa(unsigned index, Function missing) {
  const Function found = realWindowSystem(kOsmesaTableNames[index], kOsmesaLibraries, byOsmesa);
  return resolveInto(osmesaTable, index, orElse(found, adopted.osmesa[index]), missing);
}

void adopt(const Wrapper& wrapper, Function function) {
  switch (wrapper.api) {
    case Api::gl:
      return;  // found through the provider
    case Api::glx:
      adopted.glx[wrapper.index] = function;
      return;
    case Api::egl:
      adopted.egl[wrapper.index] = function;
      return;
    case Api::osmesa:
      adopted.osmesa[wrapper.index] = function;
      return;
  }
}

bool available(const char* name) {
  const bool found = realGl(currentProvider(), name) != nullptr;
  dlerror();
  return found;
}

}  // namespace shadestep::dispatch
