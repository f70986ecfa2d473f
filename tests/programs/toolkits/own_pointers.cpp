// A program in the manner of a generated loader that exports pointers by GL's own names: glDrawArrays is data
// here, and the preloaded functions of that name must neither be found in its place nor be called through it.
// GLX by glXGetProcAddress.
#include <GL/glx.h>
#include <dlfcn.h>

#include "scene.h"

#define POINTER(result, name, ...)                                                                    \
  extern "C" __attribute__((visibility("default"))) result (*own_##name)(__VA_ARGS__) __asm__(#name); \
  result (*own_##name)(__VA_ARGS__)
POINTER(void, glDrawArrays, unsigned, int, int) = nullptr;
POINTER(unsigned, glCreateProgram, ) = nullptr;
POINTER(void, glUseProgram, unsigned) = nullptr;

int main() {
  Display* display = XOpenDisplay(nullptr);
  toolkits::require(display != nullptr, "a display");
  int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, None};
  XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), wanted);
  toolkits::require(visual != nullptr, "a visual");
  XSetWindowAttributes attributes{};
  attributes.colormap = XCreateColormap(display, DefaultRootWindow(display), visual->visual, AllocNone);
  Window window =
      XCreateWindow(display, DefaultRootWindow(display), 0, 0, toolkits::kWidth, toolkits::kHeight, 0,
                    visual->depth, InputOutput, visual->visual, CWColormap, &attributes);
  XMapWindow(display, window);
  GLXContext context = glXCreateContext(display, visual, nullptr, True);
  toolkits::require(glXMakeCurrent(display, window, context), "a context");

  const auto byName = [](const char* name) {
    return glXGetProcAddress(reinterpret_cast<const GLubyte*>(name));
  };
  toolkits::Loaded gl = toolkits::load(byName);
  own_glDrawArrays = gl.DrawArrays;
  own_glCreateProgram = gl.CreateProgram;
  own_glUseProgram = gl.UseProgram;
  const toolkits::Scene scene(gl);
  bool right = true;
  for (int frame = 0; frame < toolkits::kFrames; ++frame) {
    scene.draw(frame);
    if (frame == toolkits::kFrames - 1) right = scene.right();
    glXSwapBuffers(display, window);
  }
  glXMakeCurrent(display, None, nullptr);
  glXDestroyContext(display, context);
  XCloseDisplay(display);
  return right ? 0 : 1;
}
