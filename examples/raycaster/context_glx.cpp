#include "context.h"
// After context.h: glx.h would include GL/gl.h without the prototypes.
#include <GL/glx.h>
#include <X11/Xutil.h>

#include <stdexcept>
#include <vector>

#include "library.h"

namespace raycaster {
namespace {

class GlxContext : public Context {
 public:
  GlxContext(Profile profile, int width, int height)
      : x11_("libX11.so.6", "libx11-6"), glx_("libGL.so.1", "libgl1") {
    x11_.load(openDisplay_, "XOpenDisplay");
    x11_.load(closeDisplay_, "XCloseDisplay");
    x11_.load(createColormap_, "XCreateColormap");
    x11_.load(createWindow_, "XCreateWindow");
    x11_.load(mapWindow_, "XMapWindow");
    x11_.load(storeName_, "XStoreName");
    x11_.load(free_, "XFree");
    x11_.load(selectInput_, "XSelectInput");
    x11_.load(pending_, "XPending");
    x11_.load(nextEvent_, "XNextEvent");
    x11_.load(lookupString_, "XLookupString");
    x11_.load(internAtom_, "XInternAtom");
    x11_.load(setProtocols_, "XSetWMProtocols");
    glx_.load(chooseFBConfig_, "glXChooseFBConfig");
    glx_.load(getVisual_, "glXGetVisualFromFBConfig");
    glx_.load(makeCurrent_, "glXMakeCurrent");
    glx_.load(destroyContext_, "glXDestroyContext");
    glx_.load(swapBuffers_, "glXSwapBuffers");
    glx_.load(getProcAddress_, "glXGetProcAddressARB");

    display_ = openDisplay_(nullptr);
    if (!display_)
      throw std::runtime_error(
          "no X server answers at $DISPLAY; run under `xvfb-run -a`, or use --context osmesa");
    try {
      create(profile, width, height);
    } catch (...) {
      closeDisplay_(display_);
      throw;
    }
  }
  ~GlxContext() override {
    makeCurrent_(display_, None, nullptr);
    destroyContext_(display_, context_);
    closeDisplay_(display_);  // and the window with it
  }

  AnyFunction address(const char* function) const override {
    return getProcAddress_(reinterpret_cast<const GLubyte*>(function));
  }
  void present() override { swapBuffers_(display_, window_); }

  Input input(bool wait) override {
    Input input;
    while (pending_(display_) > 0 || (wait && !input.any())) {
      XEvent event;
      nextEvent_(display_, &event);
      switch (event.type) {
        case ButtonPress:
          if (event.xbutton.button == Button4) ++input.zoom;
          if (event.xbutton.button == Button5) --input.zoom;
          x_ = event.xbutton.x;
          y_ = event.xbutton.y;
          break;
        case MotionNotify:
          input.turnX += event.xmotion.x - x_;
          input.turnY += event.xmotion.y - y_;
          x_ = event.xmotion.x;
          y_ = event.xmotion.y;
          break;
        case KeyPress: {
          char text[8] = {};
          if (lookupString_(&event.xkey, text, sizeof text - 1, nullptr, nullptr) > 0) input.keys += text;
          break;
        }
        case Expose:
          return input;  // what was there is gone: draw again
        case ClientMessage:
          input.closed = true;
          break;
        default:
          break;
      }
    }
    return input;
  }
  void setTitle(const std::string& title) override { storeName_(display_, window_, title.c_str()); }

 private:
  void create(Profile profile, int width, int height) {
    const int wanted[] = {GLX_DOUBLEBUFFER, True, GLX_RED_SIZE, 8, GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8, None};
    const int screen = DefaultScreen(display_);
    int count = 0;
    GLXFBConfig* const configs = chooseFBConfig_(display_, screen, wanted, &count);
    XVisualInfo* const visual = configs && count > 0 ? getVisual_(display_, configs[0]) : nullptr;
    if (!visual) throw std::runtime_error("the X server offers no double-buffered RGB visual with OpenGL");

    XSetWindowAttributes window{};
    window.colormap = createColormap_(display_, RootWindow(display_, screen), visual->visual, AllocNone);
    window_ = createWindow_(display_, RootWindow(display_, screen), 0, 0, static_cast<unsigned>(width),
                            static_cast<unsigned>(height), 0, visual->depth, InputOutput, visual->visual,
                            CWColormap | CWBorderPixel, &window);
    storeName_(display_, window_, "raycaster");
    selectInput_(display_, window_, ExposureMask | KeyPressMask | ButtonPressMask | Button1MotionMask);
    Atom closing = internAtom_(display_, "WM_DELETE_WINDOW", False);
    setProtocols_(display_, window_, &closing, 1);
    mapWindow_(display_, window_);

    PFNGLXCREATECONTEXTATTRIBSARBPROC createContext;
    createContext = reinterpret_cast<decltype(createContext)>(address("glXCreateContextAttribsARB"));
    std::vector<int> attributes;
    if (profile == Profile::core)
      attributes = {GLX_CONTEXT_MAJOR_VERSION_ARB, 3,
                    GLX_CONTEXT_MINOR_VERSION_ARB, 3,
                    GLX_CONTEXT_PROFILE_MASK_ARB,  GLX_CONTEXT_CORE_PROFILE_BIT_ARB};
    attributes.push_back(None);
    context_ =
        createContext ? createContext(display_, configs[0], nullptr, True, attributes.data()) : nullptr;
    free_(visual);
    free_(configs);
    if (!context_ || !makeCurrent_(display_, window_, context_))
      throw std::runtime_error(
          "GLX gives no OpenGL 3.3 context on this X server; use --context egl or osmesa");
  }

  Library x11_, glx_;
  decltype(&::XOpenDisplay) openDisplay_;
  decltype(&::XCloseDisplay) closeDisplay_;
  decltype(&::XCreateColormap) createColormap_;
  decltype(&::XCreateWindow) createWindow_;
  decltype(&::XMapWindow) mapWindow_;
  decltype(&::XStoreName) storeName_;
  decltype(&::XFree) free_;
  decltype(&::XSelectInput) selectInput_;
  decltype(&::XPending) pending_;
  decltype(&::XNextEvent) nextEvent_;
  decltype(&::XLookupString) lookupString_;
  decltype(&::XInternAtom) internAtom_;
  decltype(&::XSetWMProtocols) setProtocols_;
  decltype(&::glXChooseFBConfig) chooseFBConfig_;
  decltype(&::glXGetVisualFromFBConfig) getVisual_;
  decltype(&::glXMakeCurrent) makeCurrent_;
  decltype(&::glXDestroyContext) destroyContext_;
  decltype(&::glXSwapBuffers) swapBuffers_;
  decltype(&::glXGetProcAddressARB) getProcAddress_;
  Display* display_ = nullptr;
  Window window_ = 0;
  int x_ = 0, y_ = 0;  // where the pointer was
  GLXContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> createGlxContext(Profile profile, int width, int height) {
  return std::make_unique<GlxContext>(profile, width, height);
}

}  // namespace raycaster
