// Not run: the compiler compares our signatures with those of the headers that programs are built with.
// (Those of GLX, EGL and OSMesa it compares where the wrappers are compiled.)
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GLES3/gl32.h>

#include "interceptor/registry/gl_declarations.h"
