#include "interceptor/calls/watch.h"

namespace shadestep::calls {

alignas(wire::kPageBytes) constinit wire::StatusPage status{};
constinit thread_local bool insideWatched = false;
constinit thread_local const CallDescription* lastCall = nullptr;

}  // namespace shadestep::calls
