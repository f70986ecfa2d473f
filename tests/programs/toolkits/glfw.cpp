// GLFW, its functions by glfwGetProcAddress: `glfw` by GLX, `glfw egl` by EGL.
#include <cstring>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "scene.h"

int main(int argc, char** argv) {
  toolkits::require(glfwInit(), "GLFW");
  if (argc > 1 && std::strcmp(argv[1], "egl") == 0)
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
  GLFWwindow* window = glfwCreateWindow(toolkits::kWidth, toolkits::kHeight, "glfw", nullptr, nullptr);
  toolkits::require(window != nullptr, "a window");
  glfwMakeContextCurrent(window);
  const toolkits::Scene scene(toolkits::load(glfwGetProcAddress));
  bool right = true;
  for (int frame = 0; frame < toolkits::kFrames; ++frame) {
    scene.draw(frame);
    if (frame == toolkits::kFrames - 1) right = scene.right();
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
  glfwDestroyWindow(window);
  glfwTerminate();
  return right ? 0 : 1;
}
