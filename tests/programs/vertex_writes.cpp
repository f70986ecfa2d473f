// OpenGL 4.3: a vertex shader that counts its runs in a storage buffer. Ends with 1 if there were not three.
#include "osmesa_program.h"

int main() {
  const OsmesaContext context;
  GLuint buffer = 0;
  int runs = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof runs, &runs, GL_DYNAMIC_COPY);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, buffer);
  glUseProgram(linkProgram(R"glsl(#version 430
layout(std430, binding = 2) buffer Runs { int runs; };
void main()
{
    atomicAdd(runs, 1);
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)glsl",
                           R"glsl(#version 430
out vec4 colour;
void main()
{
    colour = vec4(1.0);
}
)glsl"));
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof runs, &runs);
  return runs == 3 ? 0 : 1;
}
