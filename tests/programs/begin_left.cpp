// A thread ends between glBegin and glEnd; the first thread makes another context current there, draws in it,
// comes back and calls glEnd. Ends with status 1 if what it draws is not there.
#include <thread>

#include "osmesa_program.h"

namespace {

void use(float red) {
  const GLuint program = linkProgram(kPlainVertex, R"glsl(#version 120
uniform float brightness;
void main()
{
    float red = brightness;
    gl_FragColor = vec4(red, 0.0, 0.0, 1.0);
}
)glsl");
  glUseProgram(program);
  glUniform1f(glGetUniformLocation(program, "brightness"), red);
}

void beginAndEnd() {
  static OsmesaContext* const left = new OsmesaContext;  // Mesa crashes when it is destroyed there
  static_cast<void>(left);
  use(1);
  glBegin(GL_TRIANGLES);
  glVertex2f(-1, -1);
}

}  // namespace

int main(int argc, char** argv) {
  std::thread(beginAndEnd).join();

  OsmesaContext left;
  use(0.5F);
  glBegin(GL_TRIANGLES);
  glVertex2f(-1, -1);
  {
    OsmesaContext other;
    use(0.25F);
    drawEverywhere();
    if (other.pixel(32, 20)[0] != 64) fail("the other context draws something else");
  }
  left.makeCurrent();
  glVertex2f(3, -1);
  glVertex2f(-1, 3);
  glEnd();
  if (left.pixel(32, 20)[0] != 128) fail("the context that was left draws something else");
  drawEverywhere();
  if (glGetError() != GL_NO_ERROR) fail("an error is left");
  left.save(argc, argv);
}
