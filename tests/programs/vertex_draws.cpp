// OpenGL 4.5 compatibility: eight draws, each giving its vertices to a vertex shader in another way. The
// attributes of vertex i are position (i - 3, 2 i), as floats, and key 10 i + 1, as an integer. Ends with 1
// if what the program's own transform feedback (draw 3) captured is not what it drew.
#include "osmesa_program.h"

static const char* const kVertex = R"glsl(#version 330 compatibility
layout(location = 0) in vec2 position;
layout(location = 1) in int key;
uniform float scale;
out vec2 moved;
flat out ivec2 tag;
int steps(int n)
{
    int sum = 0;
    for (int i = 0; i < n; ++i)
        sum += i * key;
    return sum;
}
void main()
{
    int sum = steps(int(position.y) % 5);
    if (sum > 100)
        sum = -sum;
    tag = ivec2(sum, gl_InstanceID);
    moved = position * scale;
    gl_Position = vec4(moved, 0.0, 1.0);
}
)glsl";

static const char* const kFragment = R"glsl(#version 330 compatibility
in vec2 moved;
flat in ivec2 tag;
out vec4 colour;
void main()
{
    colour = vec4(moved, vec2(tag));
}
)glsl";

static const char* const kOldVertex = R"glsl(#version 120
varying vec4 colour;
void main()
{
    float sum = gl_Vertex.x * 3.0;
    int whole = int(gl_Vertex.y) - 70000;
    colour = gl_Color + vec4(sum);
    gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;
}
)glsl";

static const char* const kOldFragment = R"glsl(#version 120
varying vec4 colour;
void main()
{
    gl_FragColor = colour;
}
)glsl";

static constexpr int kVertices = 16;

static float positions[2 * kVertices];
static int keys[kVertices];

static void vertices(GLenum mode, int first, int count) {
  glBegin(mode);
  for (int i = first; i < first + count; ++i) {
    glColor3f(0.25F, 0.5F, 0.75F);
    glVertex2f(positions[2 * i], positions[2 * i + 1]);
  }
  glEnd();
}

static bool feedbackIsRight() {
  const auto* const captured =
      static_cast<const float*>(glMapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, GL_READ_ONLY));
  bool right = captured != nullptr;
  for (int i = 0; right && i < 3; ++i)
    right = captured[2 * i] == positions[2 * i] * 0.5F && captured[2 * i + 1] == positions[2 * i + 1] * 0.5F;
  for (int i = 6; right && i < 12; ++i) right = captured[i] == -1.0F;  // nothing was captured twice
  return glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER) && right;
}

int main() {
  OsmesaContext context;
  for (int i = 0; i < kVertices; ++i) {
    positions[2 * i] = static_cast<float>(i - 3);
    positions[2 * i + 1] = static_cast<float>(2 * i);
    keys[i] = 10 * i + 1;
  }
  const GLuint program = linkProgram(kVertex, kFragment);
  glUseProgram(program);
  glUniform1f(glGetUniformLocation(program, "scale"), 0.5F);
  GLuint buffers[4];
  glGenBuffers(4, buffers);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ARRAY_BUFFER, sizeof positions, positions, GL_STATIC_DRAW);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ARRAY_BUFFER, sizeof keys, keys, GL_STATIC_DRAW);
  glVertexAttribIPointer(1, 1, GL_INT, 0, nullptr);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);

  // 0: indices with restarts and a base vertex, two instances
  const unsigned short indices[] = {0, 1, 2, 2, 1, 3, 0xffff, 5, 3, 1, 0xffff};
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
  glEnable(GL_PRIMITIVE_RESTART);
  glPrimitiveRestartIndex(0xffff);
  glDrawElementsInstancedBaseVertex(GL_TRIANGLES, 11, GL_UNSIGNED_SHORT, nullptr, 2, 4);
  glDisable(GL_PRIMITIVE_RESTART);

  // 1: several strips
  const GLint firsts[] = {2, 8};
  const GLsizei counts[] = {4, 3};
  glMultiDrawArrays(GL_TRIANGLE_STRIP, firsts, counts, 2);

  // 2: the same from the program's own memory
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, positions);
  glVertexAttribIPointer(1, 1, GL_INT, 0, keys);
  glDrawElements(GL_LINE_STRIP, 6, GL_UNSIGNED_SHORT, indices);

  // 3: a vertex shader alone, without rasterization, with transform feedback and a query of the program's own
  const GLuint alone = glCreateProgram();
  glAttachShader(alone, compile(GL_VERTEX_SHADER, kVertex));
  const char* const varying = "moved";
  glTransformFeedbackVaryings(alone, 1, &varying, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(alone);
  glUseProgram(alone);
  glUniform1f(glGetUniformLocation(alone, "scale"), 0.5F);
  const float unwritten[12] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffers[3]);
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, sizeof unwritten, unwritten, GL_STATIC_DRAW);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_TRIANGLES);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEndTransformFeedback();
  const bool right = feedbackIsRight();

  // 4: as many vertices as a buffer says
  const GLuint indirect[] = {3, 2, 5, 0};
  GLuint commands = 0;
  glGenBuffers(1, &commands);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands);
  glBufferData(GL_DRAW_INDIRECT_BUFFER, sizeof indirect, indirect, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
  glVertexAttribIPointer(1, 1, GL_INT, 0, nullptr);
  glDrawArraysIndirect(GL_TRIANGLES, nullptr);
  glDisable(GL_RASTERIZER_DISCARD);
  glDisableVertexAttribArray(0);
  glDisableVertexAttribArray(1);

  // 5: an array and an old shader; 6: immediate mode; 7: a display list
  glUseProgram(linkProgram(kOldVertex, kOldFragment));
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, positions);
  glDrawArrays(GL_QUADS, 4, 4);
  glDisableClientState(GL_VERTEX_ARRAY);
  vertices(GL_TRIANGLE_STRIP, 5, 4);
  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  vertices(GL_TRIANGLE_STRIP, 5, 4);
  vertices(GL_LINES, 1, 2);
  glEndList();
  glCallList(list);
  glFinish();
  return right && glGetError() == GL_NO_ERROR ? 0 : 1;
}
