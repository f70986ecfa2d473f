#include "cli/doctor/probe_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glx.h>
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <cstdlib>
#include <iterator>
#include <vector>

namespace shadestep::doctor {
namespace {

// The versions tried, highest first; drivers give at least what was asked for.
constexpr int kDesktopVersions[][2] = {{4, 6}, {4, 5}, {4, 3}, {4, 0}, {3, 3}, {3, 0}, {2, 1}};
constexpr int kEsVersions[][2] = {{3, 2}, {3, 1}, {3, 0}, {2, 0}};

template <class Try>
void eachVersion(Profile profile, const Try& attempt) {
  if (profile == Profile::es) {
    for (const auto& v : kEsVersions)
      if (attempt(v[0], v[1])) return;
  } else {
    for (const auto& v : kDesktopVersions)
      if ((profile == Profile::compatibility || v[0] > 3 || (v[0] == 3 && v[1] == 3)) && attempt(v[0], v[1]))
        return;
  }
}

// A library that stays loaded; drivers do not like to be unloaded.
void* load(const char* name, std::string& error) {
  void* library = dlopen(name, RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) error = dlerror();
  return library;
}

template <class Function>
Function* symbol(void* library, const char* name, std::string& error) {
  void* address = dlsym(library, name);
  if (address == nullptr) error = std::string(name) + " is missing from the library";
  return reinterpret_cast<Function*>(address);
}

// ---- OSMesa ---------------------------------------------------------------------------------------------

class OsMesaContext : public ProbeContext {
 public:
  using GetProcAddress = OSMESAproc(const char*);
  explicit OsMesaContext(GetProcAddress* get) : get_(get), pixels_(64 * 64 * 4) {}
  void* function(const char* name) const override { return reinterpret_cast<void*>(get_(name)); }
  void* pixels() { return pixels_.data(); }

 private:
  GetProcAddress* get_;
  std::vector<unsigned char> pixels_;  // the context draws here as long as it is current
};

std::unique_ptr<ProbeContext> createOsMesa(Profile profile, std::string& error) {
  if (profile == Profile::es) {
    error = "OSMesa has no OpenGL ES";
    return nullptr;
  }
  void* library = load("libOSMesa.so.8", error);
  if (library == nullptr) return nullptr;
  auto* create =
      symbol<OSMesaContext(const int*, OSMesaContext)>(library, "OSMesaCreateContextAttribs", error);
  auto* make_current =
      symbol<GLboolean(OSMesaContext, void*, GLenum, GLsizei, GLsizei)>(library, "OSMesaMakeCurrent", error);
  auto* get = symbol<OSMESAproc(const char*)>(library, "OSMesaGetProcAddress", error);
  if (create == nullptr || make_current == nullptr || get == nullptr) return nullptr;
  OSMesaContext made = nullptr;
  eachVersion(profile, [&](int major, int minor) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              profile == Profile::core ? OSMESA_CORE_PROFILE : OSMESA_COMPAT_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              major,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              minor,
                              0};
    made = create(attributes, nullptr);
    return made != nullptr;
  });
  auto context = std::make_unique<OsMesaContext>(get);
  if (made != nullptr && make_current(made, context->pixels(), GL_UNSIGNED_BYTE, 64, 64) == GL_TRUE)
    return context;
  error = "OSMesa makes no context of this profile";
  return nullptr;
}

// ---- EGL ------------------------------------------------------------------------------------------------

class LibraryContext : public ProbeContext {
 public:
  using GetProcAddress = void (*(const char*))();
  explicit LibraryContext(GetProcAddress* get) : get_(get) {}
  void* function(const char* name) const override { return reinterpret_cast<void*>(get_(name)); }

 private:
  GetProcAddress* get_;
};

std::unique_ptr<ProbeContext> createEgl(Profile profile, std::string& error) {
  void* library = load("libEGL.so.1", error);
  if (library == nullptr) return nullptr;
  auto* get = symbol<LibraryContext::GetProcAddress>(library, "eglGetProcAddress", error);
  auto* initialize = symbol<EGLBoolean(EGLDisplay, EGLint*, EGLint*)>(library, "eglInitialize", error);
  auto* bind = symbol<EGLBoolean(EGLenum)>(library, "eglBindAPI", error);
  auto* create = symbol<EGLContext(EGLDisplay, EGLConfig, EGLContext, const EGLint*)>(
      library, "eglCreateContext", error);
  auto* make_current =
      symbol<EGLBoolean(EGLDisplay, EGLSurface, EGLSurface, EGLContext)>(library, "eglMakeCurrent", error);
  if (get == nullptr || initialize == nullptr || bind == nullptr || create == nullptr ||
      make_current == nullptr)
    return nullptr;
  auto* get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) {
    error = "EGL has no platform displays (EGL_EXT_platform_base)";
    return nullptr;
  }
  EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || initialize(display, nullptr, nullptr) == EGL_FALSE) {
    error = "EGL gives no display without a surface (EGL_MESA_platform_surfaceless)";
    return nullptr;
  }
  bind(profile == Profile::es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
  EGLContext made = EGL_NO_CONTEXT;
  eachVersion(profile, [&](int major, int minor) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor};
    if (profile != Profile::es && (major > 3 || (major == 3 && minor >= 2)))
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_PROFILE_MASK,
                         profile == Profile::core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                                                  : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT});
    attributes.push_back(EGL_NONE);
    made = create(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    return made != EGL_NO_CONTEXT;
  });
  if (made != EGL_NO_CONTEXT && make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, made) == EGL_TRUE)
    return std::make_unique<LibraryContext>(get);
  error = "EGL makes no context of this profile without a surface";
  return nullptr;
}

// ---- GLX ------------------------------------------------------------------------------------------------

// Xlib ends the process on an error that no handler takes; a refused version is nothing of the kind.
int ignoreErrors(Display*, XErrorEvent*) {
  return 0;
}

std::unique_ptr<ProbeContext> createGlx(Profile profile, std::string& error) {
  if (std::getenv("DISPLAY") == nullptr) {
    error = "there is no X display (DISPLAY is not set); run under xvfb-run to try GLX";
    return nullptr;
  }
  void* x11 = load("libX11.so.6", error);
  void* library = x11 != nullptr ? load("libGL.so.1", error) : nullptr;
  if (library == nullptr) return nullptr;
  auto* open = symbol<Display*(const char*)>(x11, "XOpenDisplay", error);
  auto* set_handler = symbol<XErrorHandler(XErrorHandler)>(x11, "XSetErrorHandler", error);
  auto* default_screen = symbol<int(Display*)>(x11, "XDefaultScreen", error);
  auto* get = symbol<__GLXextFuncPtr(const GLubyte*)>(library, "glXGetProcAddressARB", error);
  auto* choose = symbol<GLXFBConfig*(Display*, int, const int*, int*)>(library, "glXChooseFBConfig", error);
  auto* make_pbuffer =
      symbol<GLXPbuffer(Display*, GLXFBConfig, const int*)>(library, "glXCreatePbuffer", error);
  auto* make_current =
      symbol<Bool(Display*, GLXDrawable, GLXDrawable, GLXContext)>(library, "glXMakeContextCurrent", error);
  if (open == nullptr || set_handler == nullptr || default_screen == nullptr || get == nullptr ||
      choose == nullptr || make_pbuffer == nullptr || make_current == nullptr)
    return nullptr;
  Display* display = open(nullptr);
  if (display == nullptr) {
    error = std::string("the X display ") + std::getenv("DISPLAY") + " cannot be opened";
    return nullptr;
  }
  set_handler(&ignoreErrors);
  auto* create = reinterpret_cast<PFNGLXCREATECONTEXTATTRIBSARBPROC>(
      get(reinterpret_cast<const GLubyte*>("glXCreateContextAttribsARB")));
  const int wanted[] = {GLX_DRAWABLE_TYPE, GLX_PBUFFER_BIT, GLX_RENDER_TYPE, GLX_RGBA_BIT, None};
  int count = 0;
  GLXFBConfig* configs = choose(display, default_screen(display), wanted, &count);
  if (create == nullptr || configs == nullptr || count == 0) {
    error = "the X server offers no configuration to draw off-screen (GLX pbuffer)";
    return nullptr;
  }
  const int size[] = {GLX_PBUFFER_WIDTH, 64, GLX_PBUFFER_HEIGHT, 64, None};
  const GLXPbuffer pbuffer = make_pbuffer(display, configs[0], size);
  GLXContext made = nullptr;
  eachVersion(profile, [&](int major, int minor) {
    const int mask = profile == Profile::core            ? GLX_CONTEXT_CORE_PROFILE_BIT_ARB
                     : profile == Profile::compatibility ? GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB
                                                         : GLX_CONTEXT_ES2_PROFILE_BIT_EXT;
    const int attributes[] = {GLX_CONTEXT_MAJOR_VERSION_ARB,
                              major,
                              GLX_CONTEXT_MINOR_VERSION_ARB,
                              minor,
                              GLX_CONTEXT_PROFILE_MASK_ARB,
                              mask,
                              None};
    made = create(display, configs[0], nullptr, True, attributes);
    return made != nullptr;
  });
  if (made == nullptr || make_current(display, pbuffer, pbuffer, made) == False) {
    error = "GLX makes no context of this profile";
    return nullptr;
  }
  // glXGetProcAddress takes unsigned characters; everything else is as with EGL.
  static __GLXextFuncPtr (*glx_get)(const GLubyte*) = nullptr;
  glx_get = get;
  return std::make_unique<LibraryContext>(
      +[](const char* name) { return glx_get(reinterpret_cast<const GLubyte*>(name)); });
}

}  // namespace

Provider providerByName(const std::string& name) {
  if (name == "osmesa") return {name, createOsMesa};
  if (name == "egl") return {name, createEgl};
  if (name == "glx") return {name, createGlx};
  return {name, nullptr};
}

}  // namespace shadestep::doctor
