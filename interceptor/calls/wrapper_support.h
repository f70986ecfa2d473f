// What the generated wrappers are made of. Runs inside the program under debug.
#pragma once

#include <cstdint>

#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/calls/watch.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/dispatch/driver_scope.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

// Stands in for a function that the driver lacks.
template <class Result, class... Parameters>
Result missing(Parameters...) {
  if constexpr (!__is_same(Result, void)) return Result{};
}

template <class Table, class Result, class... Parameters>
auto resolved(Result (*Table::*)(Parameters...), Function (*resolve)(unsigned, Function), unsigned index) {
  using Real = Result (*)(Parameters...);
  return reinterpret_cast<Real>(resolve(index, reinterpret_cast<Function>(&missing<Result, Parameters...>)));
}

}  // namespace shadestep::dispatch

namespace shadestep::calls {

// Vertices of all parts of a glMultiDraw*.
inline std::int64_t sum(const int* counts, int parts) {
  std::int64_t total = 0;
  for (int part = 0; counts && part < parts; ++part) total += counts[part];
  return total;
}

}  // namespace shadestep::calls
