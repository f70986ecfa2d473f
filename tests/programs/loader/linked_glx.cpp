// Linked with libGL, a window system's context through GLX, extensions by glXGetProcAddressARB.
#include <GL/glx.h>

#include "loader.h"

int main() {
  Display* display = XOpenDisplay(nullptr);
  loader::require(display, "no X server");
  const int wanted[] = {
      GLX_DRAWABLE_TYPE, GLX_WINDOW_BIT, GLX_DOUBLEBUFFER, True, GLX_RED_SIZE, 8, GLX_ALPHA_SIZE, 8, None};
  int count = 0;
  GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), wanted, &count);
  loader::require(count > 0, "no framebuffer configuration");
  XVisualInfo* visual = glXGetVisualFromFBConfig(display, configs[0]);
  const Window root = RootWindow(display, visual->screen);
  XSetWindowAttributes attributes{};
  attributes.colormap = XCreateColormap(display, root, visual->visual, AllocNone);
  const Window window = XCreateWindow(display, root, 0, 0, 16, 16, 0, visual->depth, InputOutput,
                                      visual->visual, CWColormap | CWBorderPixel, &attributes);
  XMapWindow(display, window);

  const auto byName = [](const char* name) {
    return glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name));
  };
  using CreateContext = GLXContext (*)(Display*, GLXFBConfig, GLXContext, Bool, const int*);
  const auto create = reinterpret_cast<CreateContext>(byName("glXCreateContextAttribsARB"));
  loader::require(create, "no glXCreateContextAttribsARB");
  const int version[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 3, GLX_CONTEXT_MINOR_VERSION_ARB, 3, None};
  GLXContext context = create(display, configs[0], nullptr, True, version);
  loader::require(context && glXMakeContextCurrent(display, window, window, context), "no context");

  loader::drawAndPrint(glClearColor, glClear, glReadPixels, glGetString);
  loader::tellWhose("glClear", &glClear);
  loader::tellWhose("glXMakeContextCurrent", &glXMakeContextCurrent);
  loader::tellWhose("glXCreateContextAttribsARB", create);
  loader::tellWhose("glCreateShader", byName("glCreateShader"));
  std::printf("unknown: %s\n", byName("glXNoSuchFunction") ? "found" : "null");
  std::printf("current: %s\n", glXGetCurrentContext() == context ? "yes" : "no");
  glXSwapBuffers(display, window);
  glXMakeCurrent(display, None, nullptr);
  glXDestroyContext(display, context);
  XCloseDisplay(display);
}
