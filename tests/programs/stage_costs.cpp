// OpenGL 4.5 core: a dispatch (draw 0), points through a vertex shader (1), and through a geometry shader,
// too (2), in which groups of threads do known work: 300 dependent steps times the group's number. The
// dispatch has 64 groups of 8 threads; vertices and primitives count by 32 as a group, of 16.
#include "osmesa_program.h"

static const char* const kCompute = R"glsl(#version 430
layout(local_size_x = 8) in;
layout(std430, binding = 0) buffer Results { float results[]; };
void main()
{
    float x = 0.3;
    int steps = 300 * int(gl_WorkGroupID.x);
    for (int i = 0; i < steps; ++i)
        x = 3.7 * x * (1.0 - x);
    results[gl_GlobalInvocationID.x] = x;
}
)glsl";

static const char* const kVertex = R"glsl(#version 430
in float along;
out float result;
void main()
{
    float x = 0.3;
    int steps = 300 * int(along);
    for (int i = 0; i < steps; ++i)
        x = 3.7 * x * (1.0 - x);
    result = x;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
)glsl";

static const char* const kPassingVertex = R"glsl(#version 430
in float along;
out float work;
void main()
{
    work = along;
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
)glsl";

static const char* const kGeometry = R"glsl(#version 430
layout(points) in;
layout(points, max_vertices = 1) out;
in float work[];
out float result;
void main()
{
    float x = 0.3;
    int steps = 300 * int(work[0]);
    for (int i = 0; i < steps; ++i)
        x = 3.7 * x * (1.0 - x);
    result = x;
    gl_Position = gl_in[0].gl_Position;
    EmitVertex();
}
)glsl";

static const char* const kFragment = R"glsl(#version 430
in float result;
out vec4 colour;
void main()
{
    colour = vec4(result);
}
)glsl";

static void drawPoints(GLuint program) {
  glUseProgram(program);
  const GLint along = glGetAttribLocation(program, "along");
  glVertexAttribPointer(static_cast<GLuint>(along), 1, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(static_cast<GLuint>(along));
  glDrawArrays(GL_POINTS, 0, 512);
}

int main() {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint buffers[2];
  glGenBuffers(2, buffers);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
  glBufferData(GL_SHADER_STORAGE_BUFFER, 512 * sizeof(float), nullptr, GL_DYNAMIC_COPY);
  glUseProgram(linkStages({{GL_COMPUTE_SHADER, kCompute}}));
  glDispatchCompute(64, 1, 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);

  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  std::vector<float> groups;
  for (int i = 0; i < 512; ++i) groups.push_back(static_cast<float>(i / 32));
  glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(groups.size() * sizeof(float)), groups.data(),
               GL_STATIC_DRAW);
  drawPoints(linkStages({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}}));
  drawPoints(linkStages({{GL_VERTEX_SHADER, kPassingVertex},
                         {GL_GEOMETRY_SHADER, kGeometry},
                         {GL_FRAGMENT_SHADER, kFragment}}));
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
