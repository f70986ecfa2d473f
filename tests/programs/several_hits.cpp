// One draw with five fragments on each pixel: covered, visible, hidden, discarded, taken away by the alpha
// test. The stencil test lets none through on the left. Blending adds to what was there before.
#include "osmesa_program.h"

#include <cmath>

int main() {
  const OsmesaContext context;
  const GLuint program = linkProgram(R"glsl(#version 330 compatibility
flat out int which;
void main()
{
    float depths[5] = float[](0.5, 0.2, 0.4, 0.1, 0.15);
    which = gl_InstanceID;
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, depths[gl_InstanceID], 1.0);
}
)glsl",
                                     R"glsl(#version 330 compatibility
flat in int which;
out vec4 colour;
void main()
{
    float value = float(which) * 100.0 + floor(gl_FragCoord.x);
    float alpha = 1.0;
    if (which == 3) {
        value = -1.0;
        discard;
    }
    if (which == 4) alpha = 0.0;
    colour = vec4(0.0, 0.2, 0.1 * float(which), alpha);
}
)glsl");
  glUseProgram(program);
  GLuint buffers[2];
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenRenderbuffers(2, buffers);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kSize, kSize);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, kSize, kSize);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  glClearColor(0.4F, 0, 0, 0);
  glClearStencil(0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_SCISSOR_TEST);
  glScissor(16, 0, kSize - 16, kSize);
  glClearStencil(1);
  glClear(GL_STENCIL_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.8F, 0, 0, 0);  // of a clear that does not come

  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 1, 0xff);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_GREATER, 0.5F);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 5);

  GLubyte left[4] = {};
  GLubyte right[4] = {};
  glReadPixels(5, 20, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, left);
  glReadPixels(40, 20, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, right);
  if (left[0] != 102 || left[1] != 0) fail("the stencil test let something through");
  if (right[0] != 102 || right[1] != 102 || std::abs(right[2] - 26) > 1) fail("not two fragments were drawn");
}
