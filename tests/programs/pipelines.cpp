// OpenGL 4.5 core: a pipeline whose four stages come from programs of their own (draw 0), and one whose
// tessellation stages share one (1). All have a uniform `scale`, each with a value of its own.
#include <string>

#include "osmesa_program.h"

static const char* const kVertex = R"glsl(#version 450
out gl_PerVertex { vec4 gl_Position; };
uniform int scale;
layout(location = 0) out int key;
void main()
{
    int sum = gl_VertexID * scale;
    key = sum + 1;
    gl_Position = vec4(float(gl_VertexID) - 1.0, float(gl_VertexID & 1), 0.0, 1.0);
}
)glsl";

static const char* const kGeometry = R"glsl(#version 450
in gl_PerVertex { vec4 gl_Position; } gl_in[];
out gl_PerVertex { vec4 gl_Position; };
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
uniform int scale;
layout(location = 0) in int key[];
layout(location = 0) flat out int total;
void main()
{
    int sum = (key[0] + key[1] + key[2]) * scale;
    for (int i = 0; i < 3; ++i) {
        total = sum + i;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
)glsl";

static const char* const kControl = R"glsl(#version 450
in gl_PerVertex { vec4 gl_Position; } gl_in[gl_MaxPatchVertices];
out gl_PerVertex { vec4 gl_Position; } gl_out[];
layout(vertices = 3) out;
uniform int scale;
layout(location = 0) in int key[];
layout(location = 0) out int own[];
void main()
{
    int mine = key[gl_InvocationID] * scale;
    own[gl_InvocationID] = mine;
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 1.0;
    gl_TessLevelInner[0] = 1.0;
}
)glsl";

static const char* const kEvaluation = R"glsl(#version 450
in gl_PerVertex { vec4 gl_Position; } gl_in[gl_MaxPatchVertices];
out gl_PerVertex { vec4 gl_Position; };
layout(triangles) in;
uniform int scale;
layout(location = 0) in int own[];
layout(location = 0) flat out int total;
void main()
{
    int sum = own[0] + own[1] + own[2] + scale;
    total = sum;
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position +
                  gl_TessCoord.z * gl_in[2].gl_Position;
}
)glsl";

static const char* const kFragment = R"glsl(#version 450
uniform int scale;
layout(location = 0) flat in int total;
out vec4 colour;
void main()
{
    int shown = total * scale;
    colour = vec4(float(shown));
}
)glsl";

static GLuint separable(std::initializer_list<std::pair<GLenum, const char*>> shaders, int scale) {
  const GLuint program = glCreateProgram();
  glProgramParameteri(program, GL_PROGRAM_SEPARABLE, GL_TRUE);
  for (const auto& [stage, text] : shaders) glAttachShader(program, compile(stage, text));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("a program does not link");
  glProgramUniform1i(program, glGetUniformLocation(program, "scale"), scale);
  return program;
}

int main() {
  OsmesaContext context(OsmesaContext::Profile::core, 4, 5);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  const GLuint vertex = separable({{GL_VERTEX_SHADER, kVertex}}, 10);
  const GLuint geometry = separable({{GL_GEOMETRY_SHADER, kGeometry}}, 100);
  const GLuint tessellation =
      separable({{GL_TESS_CONTROL_SHADER, kControl}, {GL_TESS_EVALUATION_SHADER, kEvaluation}}, 7);
  const GLuint fragment = separable({{GL_FRAGMENT_SHADER, kFragment}}, 2);
  GLuint pipelines[2];
  glGenProgramPipelines(2, pipelines);
  for (const GLuint pipeline : pipelines) {
    glUseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, vertex);
    glUseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, fragment);
  }
  glUseProgramStages(pipelines[0], GL_GEOMETRY_SHADER_BIT, geometry);
  glUseProgramStages(pipelines[1], GL_TESS_CONTROL_SHADER_BIT | GL_TESS_EVALUATION_SHADER_BIT, tessellation);
  glBindProgramPipeline(pipelines[0]);
  glDrawArrays(GL_TRIANGLES, 0, 6);
  glBindProgramPipeline(pipelines[1]);
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glDrawArrays(GL_PATCHES, 0, 6);
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
