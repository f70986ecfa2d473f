// The exported functions by name. Runs inside the program under debug.
#pragma once

namespace shadestep::dispatch {

using Function = void (*)();

enum class Api : unsigned char { gl, glx, egl, osmesa };

struct Wrapper {
  const char* name;
  Function function;  // ours
  Api api;
  unsigned short index;  // in the API's table
};

extern const Wrapper kWrappers[];  // sorted by name
extern const unsigned kWrapperCount;

// Null if we export no such function.
const Wrapper* findWrapper(const char* name);

}  // namespace shadestep::dispatch
