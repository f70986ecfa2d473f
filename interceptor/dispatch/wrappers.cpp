// Runs inside the program under debug.
#include "interceptor/dispatch/wrappers.h"

#include <algorithm>
#include <cstring>

namespace shadestep::dispatch {

const Wrapper* findWrapper(const char* name) {
  const Wrapper* end = kWrappers + kWrapperCount;
  const Wrapper* found = std::lower_bound(
      kWrappers, end, name,
      [](const Wrapper& wrapper, const char* wanted) { return std::strcmp(wrapper.name, wanted) < 0; });
  return found != end && std::strcmp(found->name, name) == 0 ? found : nullptr;
}

}  // namespace shadestep::dispatch
