// OpenGL 4.5 core: triangles given in every way, so that a fragment's three vertices are not where they seem:
// a list (draw 0), an indexed strip with a base vertex (1), a fan (2), with restarts (3), two instances (4),
// patches (5), through a geometry shader with two invocations from lines with adjacency (6), the same where
// the first vertex provokes (7), quads made by patches of four (8), isolines (9), a list of triangles that
// overlap (10), and the same with a depth test (11).
#include "osmesa_program.h"

static const char* const kVertex = R"glsl(#version 450
uniform int kind;
out float number;
void main()
{
    int at = kind == 0 ? gl_VertexID / 3 + gl_VertexID % 3 : gl_VertexID;
    vec2 place = vec2(-1.0 + 0.25 * float(at / 2), at % 2 == 0 ? -1.0 : 1.0);
    if (kind == 2)
        place = gl_VertexID == 0 ? vec2(0.0, -1.0) : vec2(-1.0 + 0.25 * float(gl_VertexID - 1), 1.0);
    if (kind == 3)
        place = vec2(-1.0 + 0.1 * float(gl_VertexID / 3) + float(gl_VertexID % 3 == 1), gl_VertexID % 3 == 2 ? 1.0 : -1.0);
    number = float(at);
    gl_Position = vec4(place, 0.0, 1.0);
}
)glsl";

static const char* const kControl = R"glsl(#version 450
layout(vertices = 3) out;
void main()
{
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0;
    gl_TessLevelInner[0] = 2.0;
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 450
layout(triangles) in;
out float number;
void main()
{
    number = gl_TessCoord.x;
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                  gl_TessCoord.z * gl_in[2].gl_Position;
}
)glsl";

// From points a, b, c, d invocation i makes a strip of three triangles, i rows up, which two vertices begin
// that make none.
static const char* const kGeometry = R"glsl(#version 450
layout(lines_adjacency, invocations = 2) in;
layout(triangle_strip, max_vertices = 7) out;
in float number[];
flat out float number_out;
void emit(float x, float y)
{
    gl_Position = vec4(x, y, 0.0, 1.0);
    number_out = number[2];
    EmitVertex();
}
void main()
{
    float left = -1.0 + 0.5 * float(gl_PrimitiveIDIn), low = float(gl_InvocationID) - 1.0;
    emit(left, low);
    emit(left, low);
    EndPrimitive();
    emit(left, low);
    emit(left, low + 0.7);
    emit(left + 0.25, low);
    emit(left + 0.25, low + 0.7);
    emit(left + 0.5, low);
}
)glsl";

static const char* const kFlatFragment = R"glsl(#version 450
flat in float number_out;
out vec4 colour;
void main()
{
    if (number_out < -1.0)
        discard;
    colour = vec4(number_out);
}
)glsl";

static const char* const kQuads = R"glsl(#version 450
layout(quads, equal_spacing) in;
flat out float number_out;
void main()
{
    number_out = 0.0;
    gl_Position = vec4(-1.0 + 0.5 * float(gl_PrimitiveID) + 0.5 * gl_TessCoord.x, 2.0 * gl_TessCoord.y - 1.0, 0.0, 1.0);
}
)glsl";

static const char* const kIsolines = R"glsl(#version 450
layout(isolines) in;
flat out float number_out;
void main()
{
    number_out = 0.0;
    gl_Position = vec4(2.0 * gl_TessCoord.x - 1.0, -0.99 + 0.5 * gl_TessCoord.y, 0.0, 1.0);
}
)glsl";

static const char* const kLevels = R"glsl(#version 450
layout(vertices = 4) out;
void main()
{
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelOuter[3] = 2.0;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = 2.0;
}
)glsl";

static const char* const kFragment = R"glsl(#version 450
in float number;
out vec4 colour;
void main()
{
    colour = vec4(number);
}
)glsl";

int main() {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  const GLuint program = linkStages({{GL_VERTEX_SHADER, kVertex}, {GL_FRAGMENT_SHADER, kFragment}});
  glUseProgram(program);
  const GLint kind = glGetUniformLocation(program, "kind");

  glUniform1i(kind, 0);
  glDrawArrays(GL_TRIANGLES, 6, 30);
  glUniform1i(kind, 1);
  const GLushort indices[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
  glDrawElementsBaseVertex(GL_TRIANGLE_STRIP, 10, GL_UNSIGNED_SHORT, nullptr, 4);
  glUniform1i(kind, 2);
  glDrawArrays(GL_TRIANGLE_FAN, 0, 8);
  glUniform1i(kind, 1);
  glEnable(GL_PRIMITIVE_RESTART);
  glDrawElements(GL_TRIANGLE_STRIP, 10, GL_UNSIGNED_SHORT, nullptr);
  glDisable(GL_PRIMITIVE_RESTART);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 8, 2);

  const GLuint patches = linkStages({{GL_VERTEX_SHADER, kVertex},
                                     {GL_TESS_CONTROL_SHADER, kControl},
                                     {GL_TESS_EVALUATION_SHADER, kEvaluation},
                                     {GL_FRAGMENT_SHADER, kFragment}});
  glUseProgram(patches);
  glUniform1i(glGetUniformLocation(patches, "kind"), 0);
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawArrays(GL_PATCHES, 0, 30);

  glUseProgram(linkStages(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kFlatFragment}}));
  glDrawArrays(GL_LINES_ADJACENCY, 8, 16);
  glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
  glDrawArrays(GL_LINES_ADJACENCY, 8, 16);
  glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
  glPatchParameteri(GL_PATCH_VERTICES, 4);
  for (const char* const evaluation : {kQuads, kIsolines}) {
    glUseProgram(linkStages({{GL_VERTEX_SHADER, kVertex},
                             {GL_TESS_CONTROL_SHADER, kLevels},
                             {GL_TESS_EVALUATION_SHADER, evaluation},
                             {GL_FRAGMENT_SHADER, kFlatFragment}}));
    glDrawArrays(GL_PATCHES, 0, evaluation == kQuads ? 16 : 4);
  }

  glUseProgram(program);
  glUniform1i(kind, 3);
  glDrawArrays(GL_TRIANGLES, 0, 30);
  glEnable(GL_DEPTH_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDrawArrays(GL_TRIANGLES, 0, 30);
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
