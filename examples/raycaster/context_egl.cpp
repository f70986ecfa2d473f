#include "context.h"
// No X types: the program needs no X for EGL.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdexcept>
#include <vector>

#include "library.h"

namespace raycaster {
namespace {

class EglPbufferContext : public Context {
 public:
  EglPbufferContext(Profile profile, int width, int height) : library_("libEGL.so.1", "libegl1") {
    library_.load(getPlatformDisplay_, "eglGetPlatformDisplay");
    library_.load(initialize_, "eglInitialize");
    library_.load(terminate_, "eglTerminate");
    library_.load(bindApi_, "eglBindAPI");
    library_.load(chooseConfig_, "eglChooseConfig");
    library_.load(createPbuffer_, "eglCreatePbufferSurface");
    library_.load(createContext_, "eglCreateContext");
    library_.load(makeCurrent_, "eglMakeCurrent");
    library_.load(swapBuffers_, "eglSwapBuffers");
    library_.load(getProcAddress_, "eglGetProcAddress");

    display_ = getPlatformDisplay_(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (display_ == EGL_NO_DISPLAY || !initialize_(display_, nullptr, nullptr))
      throw std::runtime_error("EGL cannot work without a window system here; use --context osmesa");
    create(profile, width, height);
  }
  ~EglPbufferContext() override {
    makeCurrent_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    terminate_(display_);
  }

  AnyFunction address(const char* function) const override { return getProcAddress_(function); }
  void present() override { swapBuffers_(display_, surface_); }

 private:
  void create(Profile profile, int width, int height) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    std::vector<EGLint> attributes;
    if (profile == Profile::core)
      attributes = {EGL_CONTEXT_MAJOR_VERSION,       3,
                    EGL_CONTEXT_MINOR_VERSION,       3,
                    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    attributes.push_back(EGL_NONE);

    EGLConfig config = nullptr;
    EGLint count = 0;
    EGLContext context = EGL_NO_CONTEXT;
    if (bindApi_(EGL_OPENGL_API) && chooseConfig_(display_, wanted, &config, 1, &count) && count == 1) {
      surface_ = createPbuffer_(display_, config, size);
      context = createContext_(display_, config, EGL_NO_CONTEXT, attributes.data());
    }
    if (context == EGL_NO_CONTEXT || !makeCurrent_(display_, surface_, surface_, context)) {
      terminate_(display_);
      throw std::runtime_error("EGL gives no OpenGL 3.3 context with a pbuffer; use --context osmesa or glx");
    }
  }

  Library library_;
  decltype(&::eglGetPlatformDisplay) getPlatformDisplay_;
  decltype(&::eglInitialize) initialize_;
  decltype(&::eglTerminate) terminate_;
  decltype(&::eglBindAPI) bindApi_;
  decltype(&::eglChooseConfig) chooseConfig_;
  decltype(&::eglCreatePbufferSurface) createPbuffer_;
  decltype(&::eglCreateContext) createContext_;
  decltype(&::eglMakeCurrent) makeCurrent_;
  decltype(&::eglSwapBuffers) swapBuffers_;
  decltype(&::eglGetProcAddress) getProcAddress_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
};

}  // namespace

std::unique_ptr<Context> createEglContext(Profile profile, int width, int height) {
  return std::make_unique<EglPbufferContext>(profile, width, height);
}

}  // namespace raycaster
