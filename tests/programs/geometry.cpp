// OpenGL 4.5 core, or with the argument "4.1" that version: geometry shaders that make strips (draw 0), run
// three times on lines with adjacency (1), emit to two streams (2) and on two instances, once too much (3);
// patches of four with evaluated quads (4); the same on two instances (5).
#include <string>

#include "osmesa_program.h"

using Stages = std::initializer_list<std::pair<GLenum, const char*>>;

static const char* version = "#version 450";

static GLuint link(Stages stages) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : stages)
    glAttachShader(program, compile(stage, (version + std::string(text)).c_str()));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the program does not link");
  return program;
}

static const char* const kVertex = R"glsl(
out int key;
out float height;
void main()
{
    key = 7 * gl_VertexID + 3 + 1000 * gl_InstanceID;
    height = 0.5 * float(gl_VertexID * gl_VertexID);
    gl_Position = vec4(0.25 * float(gl_VertexID) - 1.0, 0.5 * float(gl_VertexID & 1), 0.0, 1.0);
}
)glsl";

static const char* const kStrips = R"glsl(
layout(triangles) in;
layout(triangle_strip, max_vertices = 12) out;
in int key[];
in float height[];
flat out ivec2 tag;
flat out uint bits;
flat out double exact;
out vec3 colour;
int countOf(int id)
{
    int count = 0;
    for (int i = 0; i < id; ++i)
        count += i % 2 + 1;
    return count % 7;
}
void main()
{
    int id = gl_PrimitiveIDIn;
    int count = countOf(id);
    bool odd = (id & 1) == 1;
    uint mixed = uint(key[0]) * 2654435761u + uint(key[2]);
    double third = double(key[1]) / 3.0lf;
    float sum = height[0] + height[1] + height[2];
    for (int i = 0; i < count; ++i) {
        tag = ivec2(id, i);
        bits = mixed ^ uint(i);
        exact = third + double(i);
        colour = vec3(sum, float(i), odd ? 1.0 : 0.0);
        gl_Position = gl_in[i % 3].gl_Position;
        EmitVertex();
        if (odd && i == 1)
            EndPrimitive();
    }
}
)glsl";

static const char* const kInvocations = R"glsl(
layout(lines_adjacency, invocations = 3) in;
layout(points, max_vertices = 2) out;
in int key[];
out Made { flat int sum; flat ivec2 who; } made;
void main()
{
    int sum = key[0] + 10 * key[1] + 100 * key[2] + 1000 * key[3];
    int points = (gl_PrimitiveIDIn + gl_InvocationID) % 3;
    while (points > 0) {
        made.sum = sum + points;
        made.who = ivec2(gl_PrimitiveIDIn, gl_InvocationID);
        gl_Position = gl_in[1].gl_Position;
        gl_Layer = gl_InvocationID;
        EmitVertex();
        --points;
    }
}
)glsl";

static const char* const kStreams = R"glsl(
layout(points) in;
layout(points, max_vertices = 6) out;
in int key[];
layout(stream = 0) flat out int number;
layout(stream = 1) flat out int other;
void main()
{
    number = 0;
    other = 0;
    for (int i = 0; i < gl_PrimitiveIDIn % 3; ++i) {
        number = key[0] + i;
        EmitStreamVertex(0);
    }
    other = -key[0];
    EmitStreamVertex(1);
    EndStreamPrimitive(1);
}
)glsl";

static const char* const kLines = R"glsl(
layout(points) in;
layout(line_strip, max_vertices = 4) out;
in int key[];
flat out int number;
void main()
{
    int count = gl_PrimitiveIDIn == 2 ? 6 : gl_PrimitiveIDIn + 1;
    for (int i = 0; i < count; ++i) {
        number = key[0] + 100 * i;
        gl_Position = gl_in[0].gl_Position;
        EmitVertex();
    }
}
)glsl";

static const char* const kControl = R"glsl(
layout(vertices = 4) out;
in int key[];
out int own[];
patch out float total;
int shift(int n)
{
    int s = 0;
    for (int i = 0; i < n; ++i)
        s += i;
    return s;
}
void main()
{
    int id = gl_InvocationID;
    own[gl_InvocationID] = key[id] + shift(id + gl_PrimitiveID);
    barrier();
    int next = own[(id + 1) % 4];
    gl_out[gl_InvocationID].gl_Position = gl_in[id].gl_Position + vec4(float(next), 0.0, 0.0, 0.0);
    if (id != 0)
        return;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelOuter[3] = 2.0;
    gl_TessLevelInner[0] = gl_TessLevelInner[1] = 2.0;
    total = float(own[0] + own[1] + own[2] + own[3]);
}
)glsl";

static const char* const kEvaluation = R"glsl(
layout(quads, equal_spacing) in;
in int own[];
patch in float total;
out float value;
void main()
{
    vec2 at = gl_TessCoord.xy;
    float low = mix(float(own[0]), float(own[1]), at.x);
    value = total;
    for (int i = 0; i < int(4.0 * at.y); ++i)
        value += low;
    gl_Position = mix(gl_in[0].gl_Position, gl_in[2].gl_Position, at.x);
}
)glsl";

static const char* const kFragment = R"glsl(
out vec4 colour;
void main()
{
    colour = vec4(1.0);
}
)glsl";

static void useGeometry(const char* text) {
  glUseProgram(
      link({{GL_VERTEX_SHADER, kVertex}, {GL_GEOMETRY_SHADER, text}, {GL_FRAGMENT_SHADER, kFragment}}));
}

int main(int argc, char** argv) {
  const bool old = argc > 1 && std::string(argv[1]) == "4.1";
  if (old) version = "#version 400";
  OsmesaContext context(OsmesaContext::Profile::core, 4, old ? 1 : 5);
  GLuint vertex_array = 0;
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  useGeometry(kStrips);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 9);
  useGeometry(kInvocations);
  glDrawArrays(GL_LINE_STRIP_ADJACENCY, 0, 8);
  useGeometry(kStreams);
  glDrawArrays(GL_POINTS, 0, 4);
  useGeometry(kLines);
  glDrawArraysInstanced(GL_POINTS, 0, 3, 2);
  glUseProgram(link({{GL_VERTEX_SHADER, kVertex},
                     {GL_TESS_CONTROL_SHADER, kControl},
                     {GL_TESS_EVALUATION_SHADER, kEvaluation},
                     {GL_FRAGMENT_SHADER, kFragment}}));
  glPatchParameteri(GL_PATCH_VERTICES, 4);
  glDrawArrays(GL_PATCHES, 0, 12);
  glDrawArraysInstanced(GL_PATCHES, 0, 12, 2);
  glFinish();
  return glGetError() == GL_NO_ERROR ? 0 : 1;
}
