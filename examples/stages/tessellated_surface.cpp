// A tessellated surface (OpenGL 4.5): 4 x 4 patches of a height field, divided the finer the more they are
// curved. The control shader shares what its runs find; the evaluation shader raises each generated vertex.
#include "osmesa_program.h"

static constexpr int kPatches = 4;  // along an edge

static const char* const kVertex = R"glsl(#version 450
uniform int patches;
out vec2 place;
void main()
{
    int number = gl_VertexID / 4;
    ivec2 corner = ivec2(gl_VertexID & 1, gl_VertexID >> 1 & 1);
    place = 2.0 * vec2(ivec2(number % patches, number / patches) + corner) / float(patches) - 1.0;
}
)glsl";

static const char* const kControl = R"glsl(#version 450
layout(vertices = 4) out;
in vec2 place[];
out vec2 corner[];
out float bend[];  // how much the surface bends there
float curvature(vec2 at)
{
    float r = 6.0 * dot(at, at);
    return abs(cos(r)) * r;
}
void main()
{
    corner[gl_InvocationID] = place[gl_InvocationID];
    bend[gl_InvocationID] = curvature(place[gl_InvocationID]);
    barrier();
    if (gl_InvocationID > 0)
        return;
    float most = max(max(bend[0], bend[1]), max(bend[2], bend[3]));
    float level = 2.0 + 2.0 * floor(most);
    for (int side = 0; side < 4; ++side)
        gl_TessLevelOuter[side] = level;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = level;
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 450
layout(quads, equal_spacing) in;
in vec2 corner[];
out float height;
void main()
{
    vec2 low = mix(corner[0], corner[1], gl_TessCoord.x);
    vec2 high = mix(corner[2], corner[3], gl_TessCoord.x);
    vec2 at = mix(low, high, gl_TessCoord.y);
    height = 0.0;
    float frequency = 6.0;
    for (int octave = 0; octave < 3; ++octave) {
        height += sin(frequency * dot(at, at)) / frequency;
        frequency *= 2.0;
    }
    gl_Position = vec4(0.9 * at.x, 0.6 * at.y + height, 0.5 * at.y, 1.0);
}
)glsl";

static const char* const kFragment = R"glsl(#version 450
in float height;
out vec4 colour;
void main()
{
    colour = vec4(0.5 + 2.0 * height, 0.5, 0.5 - 2.0 * height, 1.0);
}
)glsl";

int main(int argc, char** argv) {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  const GLuint program = linkStages({{GL_VERTEX_SHADER, kVertex},
                                     {GL_TESS_CONTROL_SHADER, kControl},
                                     {GL_TESS_EVALUATION_SHADER, kEvaluation},
                                     {GL_FRAGMENT_SHADER, kFragment}});
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "patches"), kPatches);
  glPatchParameteri(GL_PATCH_VERTICES, 4);
  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDrawArrays(GL_PATCHES, 0, 4 * kPatches * kPatches);
  context.save(argc, argv);
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
