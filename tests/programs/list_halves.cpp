// Display lists that begin a primitive or end one, called through other lists and by glCallLists, and made
// anew under names that other lists call. Nine triangles, side by side; ends with status 1 if one of them is
// not there, or with an error.
#include <cstdlib>
#include <string>

#include "osmesa_program.h"

namespace {

constexpr int kTriangles = 9;
constexpr int kWidth = kSize / kTriangles;

template <class Commands>
void define(GLuint list, Commands commands) {
  glNewList(list, GL_COMPILE);
  commands();
  glEndList();
}

void corners() {
  glVertex2f(-1, -1);
  glVertex2f(3, -1);
  glVertex2f(-1, 3);
}

}  // namespace

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(kPlainVertex, R"glsl(#version 120
uniform float brightness;
void main()
{
    float red = brightness;
    gl_FragColor = vec4(red, 0.0, 0.0, 1.0);
}
)glsl"));
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const GLint brightness = glGetUniformLocation(static_cast<GLuint>(program), "brightness");
  glEnable(GL_SCISSOR_TEST);

  int drawn = 0;
  const auto next = [&] {
    glScissor(drawn * kWidth, 0, kWidth, kSize);
    glUniform1f(brightness, static_cast<float>(drawn + 1) / kTriangles);
  };
  const auto expectDrawn = [&](const char* how) {
    const int red = context.pixel(drawn * kWidth + 1, 20)[0];
    if (std::abs(red - 255 * (drawn + 1) / kTriangles) > 1) fail("not drawn:", how);
    if (glGetError() != GL_NO_ERROR) fail("an error is left by:", how);
    ++drawn;
    next();
  };
  next();

  const GLuint first = glGenLists(8);
  const GLuint begin = first, points = first + 1, end = first + 2, calls_begin = first + 3,
               calls_end = first + 4, calls_all = first + 5, whole = first + 6, based = first + 7;
  // What they call is made later.
  define(calls_begin, [&] { glCallList(begin); });
  define(calls_end, [&] { glCallList(end); });
  define(begin, [] { glBegin(GL_TRIANGLES); });
  define(end, [] { glEnd(); });
  define(points, corners);
  define(whole, [] {
    glBegin(GL_TRIANGLES);
    corners();
    glEnd();
  });

  glCallList(calls_begin);
  glCallList(points);
  glCallList(calls_end);
  expectDrawn("a list that calls one with glBegin");

  glBegin(GL_TRIANGLES);
  corners();
  glCallList(calls_end);
  expectDrawn("a list that calls one with glEnd");

  const GLuint names[] = {begin, points, end};
  glCallLists(3, GL_UNSIGNED_INT, names);
  expectDrawn("glCallLists of all parts");

  const GLubyte numbers[] = {1, 2};
  glListBase(first);
  glBegin(GL_TRIANGLES);
  glCallLists(2, GL_UNSIGNED_BYTE, numbers);
  expectDrawn("glCallLists that ends a primitive");

  const GLbyte less[] = {-7, -6};
  glListBase(first + 7);
  glCallLists(2, GL_BYTE, less);
  glCallList(end);
  glListBase(0);
  expectDrawn("glCallLists that begins a primitive");

  define(based, [&] {
    const GLshort numbers_there[] = {0, 1, 2};
    glListBase(first);
    glCallLists(3, GL_SHORT, numbers_there);
    glListBase(0);
  });
  define(calls_all, [&] { glCallList(based); });
  glCallList(calls_all);
  expectDrawn("a list that calls all parts by glCallLists");

  // What began one is a whole one now, and the other way round.
  define(begin, [] {
    glBegin(GL_TRIANGLES);
    corners();
    glEnd();
  });
  glCallList(calls_begin);
  expectDrawn("a list whose part is made anew");
  glCallList(whole);
  expectDrawn("the list after it");
  define(whole, [] { glEnd(); });
  glDeleteLists(end, 1);
  glCallList(calls_end);  // calls nothing
  glBegin(GL_TRIANGLES);
  corners();
  glCallList(whole);
  expectDrawn("a list that became one of glEnd");
  context.save(argc, argv);
}
