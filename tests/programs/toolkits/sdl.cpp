// SDL 2, its functions by SDL_GL_GetProcAddress. SDL_VIDEO_X11_FORCE_EGL=1 makes it use EGL.
#include <SDL2/SDL.h>

#include "scene.h"

int main(int, char**) {
  toolkits::require(SDL_Init(SDL_INIT_VIDEO) == 0, SDL_GetError());
  SDL_Window* window = SDL_CreateWindow("sdl", 0, 0, toolkits::kWidth, toolkits::kHeight, SDL_WINDOW_OPENGL);
  toolkits::require(window != nullptr, SDL_GetError());
  SDL_GLContext context = SDL_GL_CreateContext(window);
  toolkits::require(context != nullptr, SDL_GetError());
  const toolkits::Scene scene(toolkits::load(SDL_GL_GetProcAddress));
  bool right = true;
  for (int frame = 0; frame < toolkits::kFrames; ++frame) {
    scene.draw(frame);
    if (frame == toolkits::kFrames - 1) right = scene.right();
    SDL_GL_SwapWindow(window);
    SDL_PumpEvents();
  }
  SDL_GL_DeleteContext(context);
  SDL_DestroyWindow(window);
  SDL_Quit();
  return right ? 0 : 1;
}
