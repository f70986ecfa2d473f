// Five draws of the old kind with one program: between glBegin and glEnd, and by display lists, each of which
// leaves state behind that the next one starts from. Red says which colour was current when a polygon began.
#include "osmesa_program.h"

namespace {

void polygon(float left, float right) {
  glBegin(GL_POLYGON);  // flat: the first vertex gives the colour
  glVertex2f(left, -1);
  glColor3f(0.75F, 0, 0);
  glVertex2f(right, -1);
  glVertex2f(right, 1);
  glVertex2f(left, 1);
  glEnd();
}

void polygonOfArrayElements() {
  float corners[] = {-1, -1, 1, -1, 1, 1, -1, 1};
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, corners);
  glColor3f(0.5F, 0, 0);
  glBegin(GL_POLYGON);
  for (int i = 0; i < 4; ++i) {
    glArrayElement(i);
    corners[2 * i] = 7;  // its value was taken already
  }
  glEnd();
  glDisableClientState(GL_VERTEX_ARRAY);
}

// Moves what comes after it half a window to the right.
GLuint movingList() {
  const GLuint list = glGenLists(2);
  glNewList(list, GL_COMPILE);
  glTranslatef(1, 0, 0);
  polygon(-1, 0);
  glEndList();
  glNewList(list + 1, GL_COMPILE);
  glPushMatrix();
  glEnable(GL_SCISSOR_TEST);
  polygon(-2, -1);
  glEndList();
  return list;
}

void check(OsmesaContext& context, int x, int red) {
  const auto pixel = context.pixel(x, 32);
  if (std::abs(pixel[0] - red) > 1) fail("a pixel has the wrong colour");
}

}  // namespace

int main(int argc, char** argv) {
  OsmesaContext context;
  glUseProgram(linkProgram(R"glsl(#version 120
void main()
{
    gl_FrontColor = gl_Color;
    gl_Position = gl_ModelViewMatrix * gl_Vertex;
}
)glsl",
                           R"glsl(#version 120
void main()
{
    float red = gl_Color.r;
    gl_FragColor = vec4(red, 0.0, 0.0, 1.0);
}
)glsl"));
  glShadeModel(GL_FLAT);
  glScissor(0, 0, kSize, kSize);
  const GLuint list = movingList();

  glColor3f(0.25F, 0, 0);
  polygon(-1, 1);  // draw 0
  check(context, 5, 64);
  polygon(-1, 1);  // draw 1
  check(context, 5, 191);
  polygonOfArrayElements();  // draw 2
  check(context, 5, 127);
  glColor3f(0.25F, 0, 0);
  glCallList(list);  // draw 3: the right half
  check(context, 5, 127);
  check(context, 40, 64);
  const GLuint next = list + 1;
  glCallLists(1, GL_UNSIGNED_INT, &next);  // draw 4: the left half
  check(context, 5, 191);
  check(context, 40, 64);
  GLint depth = 0;
  glGetIntegerv(GL_MODELVIEW_STACK_DEPTH, &depth);
  if (depth != 2 || !glIsEnabled(GL_SCISSOR_TEST)) fail("a list did not leave its state");
  GLint attributes = 0;
  glGetIntegerv(GL_ATTRIB_STACK_DEPTH, &attributes);
  if (attributes != 0 || glGetError() != GL_NO_ERROR) fail("something is left over");
  context.save(argc, argv);
}
