// Between the exported libc functions (libc_*) and their meaning. Runs inside the program under debug.
#pragma once

#include <cstdint>

extern "C" {

// Two words: returned in registers.
struct LibcAnswer {
  void* result;  // if answered, what the function returns; else libc's own function, which must answer
  std::uintptr_t answered;  // 0 or 1
};

// `caller`: where the call will return to.
[[gnu::visibility("hidden")]] LibcAnswer shadestepDlsym(void* handle, const char* name, const void* caller);
[[gnu::visibility("hidden")]] LibcAnswer shadestepDlopen(const char* file, int flags, const void* caller);
}
