// OpenGL ES 3.2 on EGL: lines that a geometry shader moves (draw 0), and a tessellated patch (draw 1).
#include "es_program.h"

static const char* const kVertex = R"glsl(#version 320 es
flat out highp int key;
void main()
{
    key = 7 * gl_VertexID + 3;
    gl_Position = vec4(0.25 * float(gl_VertexID) - 1.0, 0.5, 0.0, 1.0);
}
)glsl";

static const char* const kGeometry = R"glsl(#version 320 es
layout(lines) in;
layout(line_strip, max_vertices = 4) out;
flat in highp int key[];
flat out highp int sum;
void main()
{
    highp int both = key[0] + 10 * key[1];
    for (highp int i = 0; i < gl_PrimitiveIDIn + 1; ++i) {
        sum = both + i;
        gl_Position = gl_in[i % 2].gl_Position;
        EmitVertex();
    }
}
)glsl";

static const char* const kControl = R"glsl(#version 320 es
layout(vertices = 3) out;
void main()
{
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = float(gl_PrimitiveID + 1);
    gl_TessLevelInner[0] = 1.0;
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 320 es
layout(triangles) in;
flat out highp int sum;
void main()
{
    highp int along = int(4.0 * gl_TessCoord.x);
    sum = 100 * gl_PrimitiveID + along;
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position;
}
)glsl";

static const char* const kFragment = R"glsl(#version 320 es
precision highp float;
flat in highp int sum;
out vec4 colour;
void main()
{
    colour = vec4(float(sum) / 255.0);
}
)glsl";

int main() {
  const EsContext context(2, 16);
  useEsProgram(
      {{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, kGeometry}, {GL_FRAGMENT_SHADER, kFragment}});
  glDrawArrays(GL_LINE_STRIP, 0, 4);
  useEsProgram({{GL_VERTEX_SHADER, kVertex},
                {GL_TESS_CONTROL_SHADER, kControl},
                {GL_TESS_EVALUATION_SHADER, kEvaluation},
                {GL_FRAGMENT_SHADER, kFragment}});
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawArrays(GL_PATCHES, 0, 6);
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
