// agent_situation NAME: one draw in a situation that a debugger must tell from an ordinary one, or must leave
// as it was. Exits with 0 if afterwards all is as it should be without a debugger. Nothing here knows of the
// debugger.
#include "agent_situation.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <map>

namespace {

using namespace situation;

int ordinary() {
  glUseProgram(linked(kVertex, {kFragment}));
  draw();
  return drawnEverywhere() ? 0 : 1;
}

int deletedProgram() {
  const GLuint program = linked(kVertex, {kFragment});
  glUseProgram(program);
  glDeleteProgram(program);
  draw();
  return drawnEverywhere() && glIsProgram(program) ? 0 : 1;
}

int fixedFunction() {
  glColor4f(0.5F, 0.5F, 0.5F, 0.5F);
  draw();
  return drawnEverywhere() ? 0 : 1;
}

int immediateMode() {
  glUseProgram(linked(kVertex, {kFragment}));
  glBegin(GL_TRIANGLES);
  for (int i = 0; i < 3; ++i) glVertex2fv(kCorners + 2 * i);
  glEnd();
  return drawnEverywhere() ? 0 : 1;
}

int displayList() {
  glUseProgram(linked(kVertex, {kFragment}));
  const GLuint list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  draw();
  glEndList();
  if (drawnEverywhere()) return 1;
  glCallList(list);
  return drawnEverywhere() ? 0 : 1;
}

int noRasterizer() {
  glUseProgram(linked(kVertex, {kFragment}));
  glEnable(GL_RASTERIZER_DISCARD);
  draw();
  return drawnEverywhere() ? 1 : 0;
}

int pipeline() {
  const GLuint fragment = glCreateShaderProgramv(GL_FRAGMENT_SHADER, 1, &kFragment);
  GLuint name = 0;
  glGenProgramPipelines(1, &name);
  glUseProgramStages(name, GL_FRAGMENT_SHADER_BIT, fragment);
  glBindProgramPipeline(name);
  draw();
  return drawnEverywhere() ? 0 : 1;
}

// Both stages have a uniform of the same name, with another value; the vertex stage writes memory.
int separateStages() {
  const char* vertex_text =
      "#version 430 compatibility\nout gl_PerVertex { vec4 gl_Position; };\n"
      "layout(location = 0) out float half_of_it;\nuniform float value;\n"
      "layout(std430, binding = 3) buffer Count { uint drawn[3]; };\n"
      "void main() { atomicAdd(drawn[gl_VertexID], 1u); half_of_it = value * 2.0; gl_Position = gl_Vertex; "
      "}\n";
  const char* fragment_text =
      "#version 430 compatibility\nlayout(location = 0) in float half_of_it;\nuniform float value;\n"
      "out vec4 color;\nvoid main() { color = vec4(half_of_it + value - 7.0); }\n";
  const GLuint vertex = glCreateShaderProgramv(GL_VERTEX_SHADER, 1, &vertex_text);
  const GLuint fragment = glCreateShaderProgramv(GL_FRAGMENT_SHADER, 1, &fragment_text);
  const auto set = opened<PFNGLPROGRAMUNIFORM1FPROC>("glProgramUniform1f");
  set(vertex, glGetUniformLocation(vertex, "value"), 0.25F);
  set(fragment, glGetUniformLocation(fragment, "value"), 7.0F);
  const GLuint zeros[3] = {};
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof zeros, zeros, GL_STATIC_READ);
  GLuint name = 0;
  glGenProgramPipelines(1, &name);
  glUseProgramStages(name, GL_VERTEX_SHADER_BIT, vertex);
  glUseProgramStages(name, GL_FRAGMENT_SHADER_BIT, fragment);
  glBindProgramPipeline(name);
  draw();
  GLint bound = 0;
  GLint program = 77;
  glGetIntegerv(GL_PROGRAM_PIPELINE_BINDING, &bound);
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  GLuint drawn[3] = {};
  glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof drawn, drawn);
  const bool once = drawn[0] == 1 && drawn[1] == 1 && drawn[2] == 1;
  return drawnEverywhere() && once && bound == static_cast<GLint>(name) && program == 0 ? 0 : 1;
}

int severalShaders() {
  glUseProgram(linked(kVertex, {"#version 330 compatibility\nvec4 halves() { return vec4(0.5); }\n",
                                "#version 330 compatibility\nvec4 halves();\nout vec4 color;\n"
                                "void main() { color = halves(); }\n"}));
  draw();
  return drawnEverywhere() ? 0 : 1;
}

int feedback() {
  const GLuint program = glCreateProgram();
  glAttachShader(program, scene::compile(GL_VERTEX_SHADER, {kVertex}));
  glAttachShader(program, scene::compile(GL_FRAGMENT_SHADER, {kFragment}));
  const char* varying = "gl_Position";
  glTransformFeedbackVaryings(program, 1, &varying, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  glUseProgram(program);
  GLuint buffer = 0;
  GLuint query = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
  const std::vector<GLfloat> nothing(100, -7.0F);
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 400, nothing.data(), GL_STATIC_READ);
  glGenQueries(1, &query);
  glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
  glBeginTransformFeedback(GL_TRIANGLES);
  draw();
  draw();
  glEndTransformFeedback();
  glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
  GLuint written = 0;
  glGetQueryObjectuiv(query, GL_QUERY_RESULT, &written);
  GLfloat values[100] = {};
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, sizeof values, values);
  bool right = written == 2 && drawnEverywhere();
  for (int i = 0; i < 100; ++i) {
    const float expected[4] = {i < 24 ? kCorners[i / 4 % 3 * 2] : -7,
                               i < 24 ? kCorners[i / 4 % 3 * 2 + 1] : -7, i < 24 ? 0.0F : -7,
                               i < 24 ? 1.0F : -7};
    right = right && values[i] == expected[i % 4];
  }
  return right ? 0 : 1;
}

int emits() {
  const char* vertex_text = "#version 430 compatibility\nvoid main() { gl_Position = gl_Vertex; }\n";
  const char* geometry_text =
      "#version 430\nlayout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
      "void main() { for (int i = 0; i < 3; ++i) { gl_Position = gl_in[i].gl_Position; EmitVertex(); } }\n";
  const GLuint program = glCreateProgram();
  glAttachShader(program, scene::compile(GL_VERTEX_SHADER, {vertex_text}));
  glAttachShader(program, scene::compile(GL_GEOMETRY_SHADER, {geometry_text}));
  glAttachShader(program, scene::compile(GL_FRAGMENT_SHADER, {kFragment}));
  glLinkProgram(program);
  glUseProgram(program);
  draw();
  return drawnEverywhere() ? 0 : 1;
}

int subroutines() {
  const GLuint program =
      linked(kVertex,
             {"#version 400 compatibility\nsubroutine float Shade();\n"
              "subroutine(Shade) float quarter() { return 0.25; }\n"
              "subroutine(Shade) float half_of_it() { return 0.5; }\n"
              "subroutine uniform Shade shade;\nout vec4 color;\nvoid main() { color = vec4(shade()); }\n"});
  glUseProgram(program);
  const auto index = opened<PFNGLGETSUBROUTINEINDEXPROC>("glGetSubroutineIndex");
  const auto choose = opened<PFNGLUNIFORMSUBROUTINESUIVPROC>("glUniformSubroutinesuiv");
  const auto ask = opened<PFNGLGETUNIFORMSUBROUTINEUIVPROC>("glGetUniformSubroutineuiv");
  const GLuint chosen = index(program, GL_FRAGMENT_SHADER, "half_of_it");
  choose(GL_FRAGMENT_SHADER, 1, &chosen);
  draw();
  GLuint now = 77;
  ask(GL_FRAGMENT_SHADER, 0, &now);
  return drawnEverywhere() && now == chosen ? 0 : 1;
}

// A storage block where a debugger would like to put its own.
int storageBlock() {
  const GLuint program = linked(
      kVertex, {"#version 430 compatibility\nlayout(std430) readonly buffer Own { float half_of_it; };\n"
                "out vec4 color;\nvoid main() { color = vec4(half_of_it); }\n"});
  GLint bindings = 0;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
  const auto last = static_cast<GLuint>(bindings) - 1;
  opened<PFNGLSHADERSTORAGEBLOCKBINDINGPROC>("glShaderStorageBlockBinding")(program, 0, last);
  const GLfloat value = 0.5F;
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, last, buffer);
  glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof value, &value, GL_STATIC_READ);
  glUseProgram(program);
  draw();
  return drawnEverywhere() ? 0 : 1;
}

// ---- memory that shaders write
// ------------------------------------------------------------------------------------

constexpr GLuint kPixels = scene::kWidth * scene::kHeight;

// Every fragment adds 1 to its place in a storage buffer, a counter, a texture and a buffer texture; every
// vertex to its own in another storage buffer. What is there before counts: 7, 5, 3, 1 and 9.
constexpr const char* kCountingVertex =
    "#version 430 compatibility\n"
    "layout(std430, binding = 2) buffer Vertices { uint drawn[3]; };\n"
    "void main() { atomicAdd(drawn[gl_VertexID], 1u); gl_Position = gl_Vertex; }\n";
constexpr const char* kCountingFragment =
    "#version 430 compatibility\n"
    "layout(std430, binding = 1) buffer Cells { uint cells[]; };\n"
    "layout(binding = 0, offset = 4) uniform atomic_uint fragments;\n"
    "layout(r32f, binding = 3) uniform image2DArray picture;\n"
    "layout(r32ui, binding = 5) uniform uimageBuffer row;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "  ivec2 place = ivec2(gl_FragCoord.xy);\n"
    "  uint cell = cells[place.y * 48 + place.x];\n"
    "  cells[place.y * 48 + place.x] = cell + 1u;\n"
    "  atomicCounterIncrement(fragments);\n"
    "  float before = imageLoad(picture, ivec3(place, 1)).x;\n"
    "  imageStore(picture, ivec3(place, 1), vec4(before + 1.0));\n"
    "  imageAtomicAdd(row, place.x, 1u);\n"
    "  color = vec4(0.5);\n"
    "}\n";

GLuint filledBuffer(GLenum target, std::size_t words, GLuint value) {
  const std::vector<GLuint> content(words, value);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(words * 4), content.data(), GL_DYNAMIC_COPY);
  return buffer;
}

bool allEqual(GLuint buffer, std::size_t words, GLuint value) {
  std::vector<GLuint> content(words);
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(words * 4), content.data());
  for (const GLuint word : content) {
    if (word != value) return false;
  }
  return true;
}

int memory() {
  const auto bind_image = opened<PFNGLBINDIMAGETEXTUREPROC>("glBindImageTexture");
  const auto barrier = opened<PFNGLMEMORYBARRIERPROC>("glMemoryBarrier");
  glUseProgram(linked(kCountingVertex, {kCountingFragment}));

  const GLuint cells = filledBuffer(GL_SHADER_STORAGE_BUFFER, kPixels, 7);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, cells);
  GLint alignment = 256;
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const std::size_t front = static_cast<std::size_t>(alignment) / 4;
  const GLuint vertices = filledBuffer(GL_SHADER_STORAGE_BUFFER, front + 3, 9);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 2, vertices, alignment, 12);
  const GLuint counter = filledBuffer(GL_ATOMIC_COUNTER_BUFFER, 2, 5);
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counter);

  GLuint textures[2];
  glGenTextures(2, textures);
  glBindTexture(GL_TEXTURE_2D_ARRAY, textures[0]);
  const std::vector<GLfloat> threes(2 * kPixels, 3);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, scene::kWidth, scene::kHeight, 2, 0, GL_RED, GL_FLOAT,
               threes.data());
  bind_image(3, textures[0], 0, GL_TRUE, 0, GL_READ_WRITE, GL_R32F);
  const GLuint row = filledBuffer(GL_TEXTURE_BUFFER, scene::kWidth, 1);
  glBindTexture(GL_TEXTURE_BUFFER, textures[1]);
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32UI, row);
  bind_image(5, textures[1], 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);

  draw();
  barrier(GL_ALL_BARRIER_BITS);
  draw();
  barrier(GL_ALL_BARRIER_BITS);

  std::vector<GLfloat> picture(2 * kPixels);
  glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED, GL_FLOAT, picture.data());
  bool right = drawnEverywhere();
  for (GLuint i = 0; i < 2 * kPixels; ++i) right = right && picture[i] == (i < kPixels ? 3.0F : 5.0F);
  GLuint counted[2] = {};
  glBindBuffer(GL_COPY_READ_BUFFER, counter);
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof counted, counted);
  right = right && counted[0] == 5 && counted[1] == 5 + 2 * kPixels;
  GLuint drawn[3] = {};
  glBindBuffer(GL_COPY_READ_BUFFER, vertices);
  glGetBufferSubData(GL_COPY_READ_BUFFER, alignment, sizeof drawn, drawn);
  for (const GLuint times : drawn) right = right && times == 9 + 2;
  return right && allEqual(vertices, front, 9) && allEqual(cells, kPixels, 7 + 2) &&
                 allEqual(row, scene::kWidth, 1 + 2 * scene::kHeight)
             ? 0
             : 1;
}

// Never twice the same.
int clockInMemory() {
  glUseProgram(linked(kVertex, {"#version 430 compatibility\n#extension GL_ARB_shader_clock : require\n"
                                "layout(std430, binding = 0) buffer Stamp { uint stamp; };\nout vec4 color;\n"
                                "void main() { stamp = clock2x32ARB().x; color = vec4(0.5); }\n"}));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, filledBuffer(GL_SHADER_STORAGE_BUFFER, 1, 0));
  draw();
  return drawnEverywhere() ? 0 : 1;
}

// What a debugger cannot copy it must not touch.
int multisampledImage() {
  glUseProgram(
      linked(kVertex, {"#version 430 compatibility\n"
                       "layout(rgba8, binding = 0) writeonly uniform image2DMS samples;\nout vec4 color;\n"
                       "void main() { imageStore(samples, ivec2(0), 1, vec4(1.0)); color = vec4(0.5); }\n"}));
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
  glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, 4, 4, GL_TRUE);
  opened<PFNGLBINDIMAGETEXTUREPROC>("glBindImageTexture")(0, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY,
                                                          GL_RGBA8);
  draw();
  return drawnEverywhere() ? 0 : 1;
}

int messages = 0;
void GLAPIENTRY onMessage(GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void*) {
  ++messages;
}

int debugMessages() {
  glUseProgram(linked(kVertex, {kFragment}));
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(onMessage, nullptr);
  draw();
  const int heard = messages;
  glEnable(0xdead);  // this one is the program's own
  return heard == 0 && messages == 1 ? 0 : 1;
}

// The child draws on with what it has of its parent; the parent's counts are its own.
int forked() {
  glUseProgram(linked(kVertex, {kFragment}));
  const pid_t child = fork();
  if (child == 0) {
    draw();
    draw();
    _exit(21);  // Mesa's exit handlers wait for threads that a fork leaves behind, and so does reading pixels
  }
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 21) return 1;
  draw();
  return drawnEverywhere() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, int (*)()> situations = {
      {"ordinary", ordinary},
      {"deleted-program", deletedProgram},
      {"fixed-function", fixedFunction},
      {"immediate-mode", immediateMode},
      {"display-list", displayList},
      {"queries", activeQueries},
      {"queried-condition", queriedCondition},
      {"condition-holds", [] { return condition(true); }},
      {"condition", [] { return condition(false); }},
      {"no-rasterizer", noRasterizer},
      {"pipeline", pipeline},
      {"separate-stages", separateStages},
      {"several-shaders", severalShaders},
      {"feedback", feedback},
      {"emits", emits},
      {"subroutines", subroutines},
      {"storage-block", storageBlock},
      {"memory", memory},
      {"clock-in-memory", clockInMemory},
      {"multisampled-image", multisampledImage},
      {"debug-messages", debugMessages},
      {"forked", forked},
  };
  const auto found = situations.find(argc > 1 ? argv[1] : "");
  if (found == situations.end()) return 2;
  alarm(120);  // a hang is a failure too
  const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  std::vector<unsigned char> buffer(static_cast<std::size_t>(scene::kWidth) * scene::kHeight * 4);
  if (!OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, scene::kWidth, scene::kHeight)) return 5;
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, kCorners);
  return found->second();
}
