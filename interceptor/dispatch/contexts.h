// Which contexts there are and which thread has which. Runs inside the program under debug.
#pragma once

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::dispatch {

// The program created `handle` (null: it failed), sharing objects with `share` (may be null).
void contextCreated(Provider provider, void* display, void* handle, void* share);

// The context is gone once no thread has it current.
void contextDestroyed(Provider provider, void* handle);

// Whether this thread holds the context, be it the one that calls go to or not.
bool isBound(Provider provider, void* handle);

struct Current {
  void* display = nullptr;
  void* handle = nullptr;  // null: this thread's context of the provider was released
  std::uintptr_t draw_drawable = 0;
  std::uintptr_t read_drawable = 0;
  int width = 0;
  int height = 0;
};
void contextMadeCurrent(Provider provider, const Current& current);

}  // namespace shadestep::dispatch
