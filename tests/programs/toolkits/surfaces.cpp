// Contexts and surfaces of every kind, without a toolkit:
//   toolkit-surfaces glx-window      a context of glXCreateContextAttribsARB on a GLX window
//   toolkit-surfaces glx-old-window  one of glXCreateContext on an X window
//   toolkit-surfaces glx-pbuffer | glx-pixmap
//   toolkit-surfaces egl-window | egl-device | egl-gbm | egl-wayland   on X11, on the first device, on GBM,
//   on Wayland
// Ends with 77 where the driver or the machine has no such thing.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <GL/glxext.h>
#include <fcntl.h>
#include <gbm.h>
#include <wayland-client.h>
#include <wayland-egl.h>

#include <cstring>
#include <functional>
#include <string_view>

#include "scene.h"

namespace {

using toolkits::kHeight;
using toolkits::kWidth;
using toolkits::require;

// What a frame ends with, behind a surface that is current.
using Present = std::function<void()>;

template <class Function>
Function glxFunction(const char* name) {
  auto function = reinterpret_cast<Function>(glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)));
  require(function != nullptr, name);
  return function;
}

Window windowFor(Display* display, const XVisualInfo& visual) {
  const Window root = RootWindow(display, visual.screen);
  XSetWindowAttributes attributes{};
  attributes.colormap = XCreateColormap(display, root, visual.visual, AllocNone);
  const Window window = XCreateWindow(display, root, 0, 0, kWidth, kHeight, 0, visual.depth, InputOutput,
                                      visual.visual, CWColormap, &attributes);
  XMapWindow(display, window);
  return window;
}

Present glxOldWindow(Display* display) {
  int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, None};
  XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), wanted);
  require(visual != nullptr, "a visual");
  const Window window = windowFor(display, *visual);
  GLXContext context = glXCreateContext(display, visual, nullptr, True);
  require(context != nullptr && glXMakeCurrent(display, window, context), "an old context");
  return [=] { glXSwapBuffers(display, window); };
}

Present glx(Display* display, std::string_view way) {
  const int kind = way == "glx-pbuffer"  ? GLX_PBUFFER_BIT
                   : way == "glx-pixmap" ? GLX_PIXMAP_BIT
                                         : GLX_WINDOW_BIT;
  const int wanted[] = {GLX_DRAWABLE_TYPE,
                        kind,
                        GLX_RENDER_TYPE,
                        GLX_RGBA_BIT,
                        GLX_RED_SIZE,
                        8,
                        GLX_DOUBLEBUFFER,
                        kind == GLX_WINDOW_BIT ? True : static_cast<int>(GLX_DONT_CARE),
                        None};
  int count = 0;
  GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), wanted, &count);
  require(configs != nullptr && count > 0, "a framebuffer configuration");
  GLXFBConfig config = configs[0];
  GLXDrawable drawable = 0;
  if (kind == GLX_PBUFFER_BIT) {
    const int size[] = {GLX_PBUFFER_WIDTH, kWidth, GLX_PBUFFER_HEIGHT, kHeight, None};
    drawable = glXCreatePbuffer(display, config, size);
  } else {
    XVisualInfo* visual = nullptr;
    for (int i = 0; i < count && visual == nullptr; ++i) {
      config = configs[i];
      visual = glXGetVisualFromFBConfig(display, config);
    }
    require(visual != nullptr, "a visual");
    if (kind == GLX_WINDOW_BIT) {
      drawable = glXCreateWindow(display, config, windowFor(display, *visual), nullptr);
    } else {
      const Pixmap pixmap = XCreatePixmap(display, RootWindow(display, visual->screen), kWidth, kHeight,
                                          static_cast<unsigned>(visual->depth));
      drawable = glXCreatePixmap(display, config, pixmap, nullptr);
    }
  }
  const int version[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 3, GLX_CONTEXT_MINOR_VERSION_ARB, 0, None};
  GLXContext context = glxFunction<PFNGLXCREATECONTEXTATTRIBSARBPROC>("glXCreateContextAttribsARB")(
      display, config, nullptr, True, version);
  require(context != nullptr && glXMakeContextCurrent(display, drawable, drawable, context), "a context");
  return [=] { glXSwapBuffers(display, drawable); };
}

EGLConfig eglConfig(EGLDisplay display, EGLint kind) {
  require(display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr), "an EGL display");
  require(eglBindAPI(EGL_OPENGL_API), "OpenGL on EGL");
  const EGLint wanted[] = {EGL_SURFACE_TYPE, kind, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_RED_SIZE, 8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  require(eglChooseConfig(display, wanted, &config, 1, &count) && count > 0, "an EGL configuration");
  return config;
}

Present eglCurrent(EGLDisplay display, EGLConfig config, EGLSurface surface) {
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  require(eglMakeCurrent(display, surface, surface, context), "a context");
  return [=] { eglSwapBuffers(display, surface); };
}

Present eglWindow(Display* x) {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x, nullptr);
  EGLConfig config = eglConfig(display, EGL_WINDOW_BIT);
  XVisualInfo sought{};
  EGLint id = 0;
  eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &id);
  sought.visualid = static_cast<VisualID>(id);
  int count = 0;
  XVisualInfo* visual = XGetVisualInfo(x, VisualIDMask, &sought, &count);
  require(visual != nullptr && count > 0, "a visual");
  Window window = windowFor(x, *visual);
  return eglCurrent(display, config, eglCreatePlatformWindowSurface(display, config, &window, nullptr));
}

Present eglDevice() {
  const auto devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  EGLDeviceEXT device = nullptr;
  EGLint count = 0;
  require(devices != nullptr && devices(1, &device, &count) && count > 0, "an EGL device");
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  EGLConfig config = eglConfig(display, EGL_PBUFFER_BIT);
  const EGLint size[] = {EGL_WIDTH, kWidth, EGL_HEIGHT, kHeight, EGL_NONE};
  return eglCurrent(display, config, eglCreatePbufferSurface(display, config, size));
}

Present eglGbm() {
  const int card = open("/dev/dri/renderD128", O_RDWR | O_CLOEXEC);
  require(card >= 0, "a render node");
  gbm_device* device = gbm_create_device(card);
  require(device != nullptr, "a GBM device");
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, device, nullptr);
  EGLConfig config = eglConfig(display, EGL_WINDOW_BIT);
  EGLint format = 0;
  eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &format);
  gbm_surface* surface =
      gbm_surface_create(device, kWidth, kHeight, static_cast<std::uint32_t>(format), GBM_BO_USE_RENDERING);
  require(surface != nullptr, "a GBM surface");
  return eglCurrent(display, config, eglCreatePlatformWindowSurface(display, config, surface, nullptr));
}

// The surface has no role, so no compositor shows it: four frames are as many as there are buffers.
Present eglWayland() {
  wl_display* server = wl_display_connect(nullptr);
  require(server != nullptr, "a Wayland server");
  wl_compositor* compositor = nullptr;
  const wl_registry_listener listener = {
      .global =
          [](void* found, wl_registry* registry, std::uint32_t name, const char* interface, std::uint32_t) {
            if (std::strcmp(interface, "wl_compositor") == 0)
              *static_cast<void**>(found) = wl_registry_bind(registry, name, &wl_compositor_interface, 1);
          },
      .global_remove = [](void*, wl_registry*, std::uint32_t) {}};
  wl_registry* registry = wl_display_get_registry(server);
  wl_registry_add_listener(registry, &listener, &compositor);
  wl_display_roundtrip(server);
  require(compositor != nullptr, "a Wayland compositor");
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_WAYLAND_KHR, server, nullptr);
  EGLConfig config = eglConfig(display, EGL_WINDOW_BIT);
  wl_egl_window* window = wl_egl_window_create(wl_compositor_create_surface(compositor), kWidth, kHeight);
  const Present present =
      eglCurrent(display, config, eglCreatePlatformWindowSurface(display, config, window, nullptr));
  eglSwapInterval(display, 0);
  return present;
}

Present made(std::string_view way) {
  if (way == "egl-wayland") return eglWayland();
  if (way == "egl-device") return eglDevice();
  if (way == "egl-gbm") return eglGbm();
  Display* display = XOpenDisplay(nullptr);
  require(display != nullptr, "a display");
  if (way == "egl-window") return eglWindow(display);
  return way == "glx-old-window" ? glxOldWindow(display) : glx(display, way);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view way = argc > 1 ? argv[1] : "glx-window";
  const Present present = made(way);
  const auto byName = [&](const char* name) {
    return way.starts_with("egl") ? eglGetProcAddress(name)
                                  : glXGetProcAddress(reinterpret_cast<const GLubyte*>(name));
  };
  const toolkits::Scene scene(toolkits::load(byName));
  bool right = true;
  for (int frame = 0; frame < toolkits::kFrames; ++frame) {
    scene.draw(frame);
    if (frame == toolkits::kFrames - 1) right = scene.right();
    present();
  }
  if (!right) std::fprintf(stderr, "%s: pixels are wrong\n", argv[0]);
  return right ? 0 : 1;
}
