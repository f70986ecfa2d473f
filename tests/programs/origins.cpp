// OpenGL 4.5 core: triangles given in every way, so that a fragment's three vertices are not where they seem:
// a list (draw 0), an indexed strip with a base vertex (1), a fan (2), with restarts (3), two instances (4),
// patches (5).
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
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
