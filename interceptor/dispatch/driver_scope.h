// Marks the time that a thread spends inside a GLX, EGL or OSMesa function of the driver.
// Runs inside the program under debug.
#pragma once

namespace shadestep::dispatch {

extern constinit thread_local unsigned driverDepth [[gnu::tls_model("initial-exec")]];

// Calls `function` as the driver's: functions that it looks up are the driver's own, calls that it makes
// through exported names are told to nobody.
template <class Function>
decltype(auto) inDriver(Function&& function) {
  struct Scope {
    Scope() { ++driverDepth; }
    ~Scope() { --driverDepth; }
  } scope;
  return function();
}

}  // namespace shadestep::dispatch
