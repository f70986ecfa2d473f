// What the loader programs share: each gets at GL in one way, draws a colour, and prints what it sees.
// Standard output must be the same with and without the preload; standard error says whose functions it got.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace loader {

// "glClear hooked" or "glClear bare".
template <class Function>
void tellWhose(const char* name, Function* function) {
  Dl_info info{};
  const bool known = dladdr(reinterpret_cast<void*>(function), &info) && info.dli_fname;
  std::fprintf(stderr, "%s %s\n", name,
               known && std::strstr(info.dli_fname, "shadestep-gl") ? "hooked" : "bare");
}

[[noreturn]] inline void fail(const char* what) {
  std::fprintf(stderr, "cannot run here: %s\n", what);
  std::exit(77);
}

inline void require(bool ok, const char* what) {
  if (!ok) fail(what);
}

// The same colour in every byte order: (64, 128, 191, 255).
template <class ClearColor, class Clear, class ReadPixels, class GetString>
void drawAndPrint(ClearColor clearColor, Clear clear, ReadPixels readPixels, GetString getString) {
  unsigned char pixel[4] = {};
  clearColor(0.25f, 0.5f, 0.75f, 1.0f);
  clear(0x4000 /* GL_COLOR_BUFFER_BIT */);
  readPixels(1, 1, 1, 1, 0x1908 /* GL_RGBA */, 0x1401 /* GL_UNSIGNED_BYTE */, pixel);
  std::printf("%s: %d %d %d %d\n", reinterpret_cast<const char*>(getString(0x1F02 /* GL_VERSION */)),
              pixel[0], pixel[1], pixel[2], pixel[3]);
}

}  // namespace loader
