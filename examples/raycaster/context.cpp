#include "context.h"

namespace raycaster {

std::unique_ptr<Context> createContext(ContextKind kind, Profile profile, int width, int height) {
  switch (kind) {
    case ContextKind::osmesa:
      return createOsmesaContext(profile, width, height);
    case ContextKind::glx:
      return createGlxContext(profile, width, height);
    case ContextKind::egl:
      return createEglContext(profile, width, height);
  }
  return nullptr;
}

}  // namespace raycaster
