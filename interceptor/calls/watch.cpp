#include "interceptor/calls/watch.h"

namespace shadestep::calls {

constinit std::atomic<bool> watching{false};
constinit thread_local bool insideWatched = false;

}  // namespace shadestep::calls
