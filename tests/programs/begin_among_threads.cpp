// Two threads draw by turns, twice: the second's draw is made between glBegin and glEnd of the first's, which
// waits for it there. In the order in which they begin the draws are red 0.25, 0.5, 0.75 and 1.
#include <semaphore>
#include <thread>

#include "osmesa_program.h"

static const char* const kFragment = R"glsl(#version 120
uniform float brightness;
void main()
{
    float red = brightness;
    gl_FragColor = vec4(red, 0.0, 0.0, 1.0);
}
)glsl";

static std::binary_semaphore may_draw{0};
static std::binary_semaphore has_drawn{0};

static GLint useBrightness() {
  const GLuint program = linkProgram(kPlainVertex, kFragment);
  glUseProgram(program);
  return glGetUniformLocation(program, "brightness");
}

static void drawWhenTold() {
  OsmesaContext context;
  const GLint brightness = useBrightness();
  for (const float red : {0.5F, 1.0F}) {
    glUniform1f(brightness, red);
    may_draw.acquire();
    drawEverywhere();
    glFinish();
    has_drawn.release();
  }
}

int main() {
  std::thread other(drawWhenTold);
  OsmesaContext context;
  const GLint brightness = useBrightness();
  for (const float red : {0.25F, 0.75F}) {
    glUniform1f(brightness, red);
    glBegin(GL_TRIANGLES);
    glVertex2f(-1, -1);
    may_draw.release();
    has_drawn.acquire();
    glVertex2f(3, -1);
    glVertex2f(-1, 3);
    glEnd();
    glFinish();
  }
  other.join();
}
