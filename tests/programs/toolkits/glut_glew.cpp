// FreeGLUT and GLEW: linked with libGL, newer functions by GLEW's pointers.
#include <GL/glew.h>

#include <GL/freeglut.h>  // after GLEW, which wants to be first

#include "scene.h"

namespace {
int frame = 0;
bool right = true;
const toolkits::Scene* scene = nullptr;

void display() {
  scene->draw(frame);
  if (++frame == toolkits::kFrames) {
    right = scene->right();
    glutSwapBuffers();
    std::exit(right ? 0 : 1);
  }
  glutSwapBuffers();
  glutPostRedisplay();
}
}  // namespace

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitWindowSize(toolkits::kWidth, toolkits::kHeight);
  glutInitDisplayMode(GLUT_RGBA | GLUT_DOUBLE);
  glutCreateWindow("glut");
  toolkits::require(glewInit() == GLEW_OK, "GLEW");
  const toolkits::Scene here(TOOLKITS_NAMED_GL);
  scene = &here;
  glutDisplayFunc(display);
  glutMainLoop();
}
