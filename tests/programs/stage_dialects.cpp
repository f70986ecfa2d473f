// OpenGL 4.5 core: a geometry shader of GLSL 1.50 with clip distances (draw 0), several indexed draws from
// one buffer (1), and as many instances of a point as the argument says, or 5 (2); a patch with a large array
// (3).
#include "osmesa_program.h"

static const char* const kVertex = R"glsl(#version 150
out vec2 given;
void main()
{
    given = vec2(gl_VertexID, gl_VertexID * gl_VertexID);
    gl_ClipDistance[0] = float(gl_VertexID) - 1.5;
    gl_ClipDistance[1] = 4.0 - 0.5 * float(gl_InstanceID);
    gl_Position = vec4(0.25 * given.x, 0.125 * given.y, 0.0, 1.0);
}
)glsl";

static const char* const kGeometry = R"glsl(#version 150
layout(lines) in;
layout(line_strip, max_vertices = 2) out;
in vec2 given[];
out vec2 middle;
void main()
{
    vec4 sum = gl_in[0].gl_Position + gl_in[1].gl_Position;
    middle = 0.5 * (given[0] + given[1]);
    gl_ClipDistance[0] = sum.x;
    gl_Position = sum;
    EmitVertex();
    middle = given[1];
    gl_ClipDistance[0] = gl_in[1].gl_ClipDistance[0];
    gl_Position = gl_in[1].gl_Position;
    EmitVertex();
}
)glsl";

static const char* const kPoint = R"glsl(#version 150
layout(points) in;
layout(points, max_vertices = 1) out;
in vec2 given[];
out vec2 middle;
void main()
{
    float clip = gl_in[0].gl_ClipDistance[1];
    middle = vec2(clip) + given[0];
    gl_Position = gl_in[0].gl_Position;
    EmitVertex();
}
)glsl";

static const char* const kControl = R"glsl(#version 450
layout(vertices = 3) out;
patch out Weights { float weight[8]; };
in vec2 given[];
out vec2 kept[];
void main()
{
    kept[gl_InvocationID] = given[gl_InvocationID];
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 1.0;
    gl_TessLevelInner[0] = 1.0;
    for (int i = 0; i < 8; ++i)
        weight[i] = 0.5 * float(i);
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 450
layout(triangles) in;
patch in Weights { float weight[8]; };
in vec2 kept[];
out vec2 middle;
void main()
{
    middle = kept[0] + vec2(weight[7], weight[3]);
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position;
}
)glsl";

static const char* const kFragment = R"glsl(#version 150
in vec2 middle;
out vec4 colour;
void main()
{
    colour = vec4(middle, 0.0, 1.0);
}
)glsl";

int main(int argc, char** argv) {
  const int instances = argc > 1 ? std::atoi(argv[1]) : 5;
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  glEnable(GL_CLIP_DISTANCE0);
  glUseProgram(linkStages(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kFragment}}));
  glDrawArrays(GL_LINE_LOOP, 0, 4);

  const GLushort indices[] = {0, 1, 2, 5};
  const GLuint commands[] = {3, 1, 0, 10, 0, 2, 2, 2, 20, 0};  // indices 0, 1, 2 and twice 2, 5
  GLuint buffers[2];
  glGenBuffers(2, buffers);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers[1]);
  glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof commands, commands, GL_STATIC_DRAW);
  glMultiDrawElementsIndirect(GL_LINE_STRIP, GL_UNSIGNED_SHORT, nullptr, 2, 0);

  glUseProgram(linkStages(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kPoint}, {GL_FRAGMENT_SHADER, kFragment}}));
  glDrawArraysInstanced(GL_POINTS, 0, 1, instances);

  glUseProgram(linkStages({{GL_VERTEX_SHADER, kVertex},
                           {GL_TESS_CONTROL_SHADER, kControl},
                           {GL_TESS_EVALUATION_SHADER, kEvaluation},
                           {GL_FRAGMENT_SHADER, kFragment}}));
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawArrays(GL_PATCHES, 0, 3);
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
