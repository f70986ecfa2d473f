// Calls that OpenGL refuses between glBegin and glEnd, and those that it allows; ends with status 1 if one of
// the first has an effect or leaves no error, or one of the others leaves one.
#include <functional>
#include <string>

#include "osmesa_program.h"

namespace {

// The error after a triangle with `call` in it.
GLenum errorOf(const std::function<void()>& call) {
  glBegin(GL_TRIANGLES);
  glVertex2f(-1, -1);
  call();
  glVertex2f(1, -1);
  glVertex2f(0, 1);
  glEnd();
  const GLenum error = glGetError();
  while (glGetError() != GL_NO_ERROR) continue;
  return error;
}

void refused(const char* name, const std::function<void()>& call) {
  if (errorOf(call) != GL_INVALID_OPERATION) fail("not refused between glBegin and glEnd:", name);
}
void allowed(const char* name, const std::function<void()>& call) {
  if (errorOf(call) != GL_NO_ERROR) fail("not allowed between glBegin and glEnd:", name);
}

GLuint incompleteFramebuffer() {
  GLuint framebuffer = 0;
  GLuint texture = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);  // has no image
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  return framebuffer;
}

}  // namespace

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(R"glsl(#version 120
varying vec4 colour;
void main()
{
    colour = gl_Color;
    gl_Position = gl_Vertex;
}
)glsl",
                           R"glsl(#version 120
varying vec4 colour;
void main()
{
    gl_FragColor = colour;
}
)glsl"));
  GLuint name = 0;
  GLint index = 0;
  refused("glEnable", [] { glEnable(GL_BLEND); });
  if (glIsEnabled(GL_BLEND)) fail("glEnable between glBegin and glEnd had an effect");
  refused("glPrimitiveRestartIndex", [] { glPrimitiveRestartIndex(7); });
  glGetIntegerv(GL_PRIMITIVE_RESTART_INDEX, &index);
  if (index == 7) fail("glPrimitiveRestartIndex between glBegin and glEnd had an effect");
  refused("glGenBuffers", [&] { glGenBuffers(1, &name); });
  if (name != 0) fail("glGenBuffers between glBegin and glEnd had an effect");
  refused("glGenLists", [&] { name = glGenLists(1); });
  if (name != 0) fail("glGenLists between glBegin and glEnd had an effect");
  refused("glGetIntegerv", [&] { glGetIntegerv(GL_DEPTH_FUNC, &index); });
  refused("glFlush", [] { glFlush(); });
  refused("glRasterPos2f", [] { glRasterPos2f(0, 0); });
  refused("glColorMask", [] { glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE); });
  refused("glBegin", [] { glBegin(GL_LINES); });

  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  glColor3f(0.5F, 0.25F, 1);
  glEndList();
  allowed("glCallList", [&] { glCallList(list); });
  allowed("glColor3f", [] { glColor3f(1, 0, 0); });
  allowed("glColorP3ui", [] { glColorP3ui(GL_UNSIGNED_INT_2_10_10_10_REV, 77); });
  allowed("glMaterialf", [] { glMaterialf(GL_FRONT, GL_SHININESS, 2); });
  allowed("glNormal3f", [] { glNormal3f(0, 0, 1); });
  allowed("glEdgeFlag", [] { glEdgeFlag(GL_TRUE); });
  allowed("glFogCoordf", [] { glFogCoordf(1); });
  allowed("glIndexi", [] { glIndexi(1); });
  allowed("glMultiTexCoord2f", [] { glMultiTexCoord2f(GL_TEXTURE1, 0, 0); });
  allowed("glSecondaryColor3f", [] { glSecondaryColor3f(0, 0, 0); });
  allowed("glVertexAttrib4Nub", [] { glVertexAttrib4Nub(3, 1, 2, 3, 4); });
  allowed("glVertexAttribI1i", [] { glVertexAttribI1i(3, 1); });
  allowed("glEvalPoint1", [] { glEvalPoint1(0); });

  // glBegin and glEnd in lists of their own, and with a list for one of them.
  const GLuint begin = glGenLists(3);
  const GLuint corners = begin + 1;
  const GLuint end = begin + 2;
  glNewList(begin, GL_COMPILE);
  glBegin(GL_TRIANGLES);
  glEndList();
  glNewList(corners, GL_COMPILE);
  glVertex2f(-1, -1);
  glVertex2f(1, -1);
  glVertex2f(0, 1);
  glEndList();
  glNewList(end, GL_COMPILE);
  glEnd();
  glEndList();
  glColor3f(0, 1, 0);
  glCallList(begin);
  glCallList(corners);
  glCallList(end);
  if (context.pixel(32, 20) != std::array{0, 255, 0, 255})
    fail("lists for glBegin and glEnd draw something else");
  glColor3f(0, 0, 1);
  glBegin(GL_TRIANGLES);
  glCallList(corners);
  glCallList(end);
  if (context.pixel(32, 20) != std::array{0, 0, 255, 255}) fail("a list for glEnd draws something else");
  if (glGetString(GL_VERSION) == nullptr || glGetError() != GL_NO_ERROR)
    fail("lists for glBegin and glEnd leave an error");

  // What refuses to draw at all: its error comes with glBegin, whether there are vertices or not.
  glBindFramebuffer(GL_FRAMEBUFFER, incompleteFramebuffer());
  glBegin(GL_TRIANGLES);
  glEnd();
  if (glGetError() != GL_INVALID_FRAMEBUFFER_OPERATION) fail("an incomplete framebuffer is drawn to");
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  context.save(argc, argv);
}
