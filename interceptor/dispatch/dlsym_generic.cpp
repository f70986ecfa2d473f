// The exported dlsym where there is no trampoline for the processor: RTLD_NEXT of another library counts from
// ours then, not from the caller. Runs inside the program under debug.
#include <cstdint>

extern "C" {
struct ShadestepLookup {
  void* result;
  std::uintptr_t answered;
};
ShadestepLookup shadestepLookup(void* handle, const char* name, const void* caller);

[[gnu::visibility("default")]] void* dlsym(void* handle, const char* name) {
  const ShadestepLookup lookup = shadestepLookup(handle, name, __builtin_return_address(0));
  if (lookup.answered) return lookup.result;
  return reinterpret_cast<void* (*)(void*, const char*)>(lookup.result)(handle, name);
}
}
