// The exported dlsym where there is no trampoline for the processor: RTLD_NEXT of another library counts from
// ours then, not from the caller; dlopen is not hooked. Runs inside the program under debug.
#include "interceptor/dispatch/libc_hooks.h"

extern "C" [[gnu::visibility("default")]] void* dlsym(void* handle, const char* name) {
  const LibcAnswer answer = shadestepDlsym(handle, name, __builtin_return_address(0));
  if (answer.answered) return answer.result;
  return reinterpret_cast<void* (*)(void*, const char*)>(answer.result)(handle, name);
}
