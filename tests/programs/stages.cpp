// OpenGL 4.5 core: a compute dispatch (draw 0), an indirect one (1), a geometry shader (2) and a tessellated
// patch (3). Ends with 1 if the dispatches did not leave what they should: each must have run once.
#include "osmesa_program.h"

// Each group of 4 x 2 threads sums up what its threads bring, after a barrier.
static const char* const kCompute = R"glsl(#version 430
layout(local_size_x = 4, local_size_y = 2) in;
layout(std430, binding = 1) buffer Sums { int total; int sums[]; };
shared int brought[8]; uniform int lost;  // by the driver: nothing depends on it
int bring(uvec3 at)
{
    int value = int(at.x) + 10 * int(at.y) + 100 * int(at.z);
    for (int i = 0; i < int(at.x) % 3; ++i)
        value += 1000;
    return value;
}
void main()
{
    uint index = gl_LocalInvocationIndex, idle = uint(lost);
    brought[index] = bring(gl_GlobalInvocationID);
    barrier();
    int sum = 0;
    for (int i = 0; i < 8; ++i)
        sum += brought[i];
    uint group = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
    if (index == 0u)
        sums[group] += sum;
    atomicAdd(total, 1);
}
)glsl";

static const char* const kVertex = R"glsl(#version 430
out float height;
void main()
{
    height = float(gl_VertexID * gl_VertexID);
    gl_Position = vec4(0.25 * float(gl_VertexID) - 1.0, 0.0, 0.0, 1.0);
}
)glsl";

// Primitive p of the strip of lines gives p % 3 points.
static const char* const kGeometry = R"glsl(#version 430
layout(lines) in;
layout(points, max_vertices = 4) out;
in float height[];
out float middle;
void main()
{
    float mean = 0.5 * (height[0] + height[1]);
    int points = gl_PrimitiveIDIn % 3;
    for (int i = 0; i < points; ++i) {
        middle = mean + float(i);
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
)glsl";

static const char* const kFragment = R"glsl(#version 430
in float middle;
out vec4 colour;
void main()
{
    colour = vec4(middle);
}
)glsl";

static const char* const kControl = R"glsl(#version 430
layout(vertices = 3) out;
in float height[];
out float raised[];
void main()
{
    float own = height[gl_InvocationID] + 1.0;
    raised[gl_InvocationID] = own;
    barrier();
    float next = raised[(gl_InvocationID + 1) % 3];
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position + vec4(next);
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 2.0;
    gl_TessLevelInner[0] = 1.0;
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 430
layout(triangles, equal_spacing) in;
in float raised[];
out float middle;
void main()
{
    vec3 weight = gl_TessCoord;
    middle = dot(weight, vec3(raised[0], raised[1], raised[2]));
    gl_Position = weight.x * gl_in[0].gl_Position + weight.y * gl_in[1].gl_Position + weight.z * gl_in[2].gl_Position;
}
)glsl";

int main() {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint buffers[3];
  glGenBuffers(3, buffers);
  const std::array<int, 7> zeros{};
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[0]);
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof zeros, zeros.data(), GL_DYNAMIC_COPY);
  glUseProgram(linkStages({{GL_COMPUTE_SHADER, kCompute}}));
  glDispatchCompute(2, 3, 1);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  const GLuint groups[] = {1, 2, 1};
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffers[1]);
  glBufferData(GL_DISPATCH_INDIRECT_BUFFER, sizeof groups, groups, GL_STATIC_DRAW);
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  std::array<int, 7> left{};
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof left, left.data());

  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  glUseProgram(linkStages(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kFragment}}));
  glDrawArrays(GL_LINE_STRIP, 0, 8);
  glUseProgram(linkStages({{GL_VERTEX_SHADER, kVertex},
                           {GL_TESS_CONTROL_SHADER, kControl},
                           {GL_TESS_EVALUATION_SHADER, kEvaluation},
                           {GL_FRAGMENT_SHADER, kFragment}}));
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawArrays(GL_PATCHES, 0, 6);
  glFinish();
  std::fprintf(stderr, "%d threads\n", left[0]);
  return left[0] == 48 + 16 && glGetError() == GL_NO_ERROR ? 0 : 1;
}
