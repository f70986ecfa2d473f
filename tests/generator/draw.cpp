// Runs the shaders in files over a small target, in a context and with inputs that a description names, and
// writes all that came of it to another file:
//
//   generator-draw SCENE SHADERS... [RESULT]
//
// Shaders are told apart by the ends of their names: .vert .tesc .tese .geom .frag .comp.
// SCENE, a line each:   call triangle (over all) | points (one on each pixel) | patches N (the same points, N
// a patch) | dispatch (an invocation for each pixel, in groups of 4 x 2)   context core|compatibility|es
//   size W H   target float|int|uint (a colour target each)   depth (a depth buffer)
//   out NAME LOCATION (before linking)   uniform NAME i|u|f COMPONENTS VALUE...   block NAME VALUE... (ints)
//   storage INTS   image   counter   texture NAME int|float (4 x 4, evaluate.py's texel())
//   subroutine UNIFORM FUNCTION
// RESULT: a line each for every target (`target I WORDS...`, RGBA rows bottom up, hexadecimal), `depth
// WORDS...`, `storage WORDS...`, `image WORDS...`, `counter WORD`.
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& sentence) {
  std::fprintf(stderr, "generator-draw: %s\n", sentence.c_str());
  std::exit(2);
}

std::string readFile(const char* name) {
  std::ifstream file(name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) fail(std::string("cannot read ") + name);
  return text.str();
}

struct Values {
  std::string name, kind;
  int components = 0;
  std::vector<double> values;
};

struct Scene {
  std::string call = "triangle", context = "core";
  int patch_vertices = 1;
  int width = 6, height = 5;
  std::vector<std::string> targets;
  bool depth = false, image = false, counter = false;
  std::size_t storage = 0;
  std::vector<std::pair<std::string, unsigned>> outputs;
  std::vector<Values> uniforms;
  Values block;
  std::vector<std::pair<std::string, std::string>> textures, subroutines;
};

Scene readScene(const char* name) {
  Scene scene;
  std::istringstream lines(readFile(name));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what, text;
    words >> what;
    Values values;
    if (what == "call") words >> scene.call >> scene.patch_vertices;
    if (what == "context") words >> scene.context;
    if (what == "size") words >> scene.width >> scene.height;
    if (what == "target") scene.targets.push_back((words >> text, text));
    if (what == "depth") scene.depth = true;
    if (what == "image") scene.image = true;
    if (what == "counter") scene.counter = true;
    if (what == "storage") words >> scene.storage;
    if (what == "out") {
      unsigned location = 0;
      words >> text >> location;
      scene.outputs.emplace_back(text, location);
    }
    if (what == "texture" || what == "subroutine") {
      std::pair<std::string, std::string> entry;
      words >> entry.first >> entry.second;
      (what == "texture" ? scene.textures : scene.subroutines).push_back(entry);
    }
    if (what == "uniform" || what == "block") {
      words >> values.name;
      if (what == "uniform") words >> values.kind >> values.components;
      for (double value = 0; words >> value;) values.values.push_back(value);
      if (what == "uniform") scene.uniforms.push_back(values);
      if (what == "block") scene.block = values;
    }
  }
  return scene;
}

void makeContext(const std::string& kind) {
  EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const bool es = kind == "es";
  std::vector<EGLint> version = {EGL_CONTEXT_MAJOR_VERSION, es ? 3 : 4, EGL_CONTEXT_MINOR_VERSION,
                                 es ? 2 : 5};
  if (!es) {
    version.insert(version.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   kind == "core" ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                                                  : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT});
  }
  version.push_back(EGL_NONE);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
    fail("no EGL without a surface");
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version.data());
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) fail("no such context: " + kind);
}

GLuint compile(GLenum stage, const char* name) {
  const std::string text = readFile(name);
  const char* pointer = text.c_str();
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  char log[2048] = "";
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  if (!compiled) fail(std::string(name) + ": " + log);
  return shader;
}

// The stages of the shaders in the files; ends at the first that is none.
std::vector<GLenum> stagesOf(char** files) {
  const std::pair<const char*, GLenum> ends[] = {
      {".vert", GL_VERTEX_SHADER},   {".tesc", GL_TESS_CONTROL_SHADER}, {".tese", GL_TESS_EVALUATION_SHADER},
      {".geom", GL_GEOMETRY_SHADER}, {".frag", GL_FRAGMENT_SHADER},     {".comp", GL_COMPUTE_SHADER}};
  std::vector<GLenum> stages;
  for (; *files != nullptr; ++files) {
    const std::string name = *files;
    const auto* const found = std::find_if(std::begin(ends), std::end(ends),
                                           [&](const auto& one) { return name.ends_with(one.first); });
    if (found == std::end(ends)) break;
    stages.push_back(found->second);
  }
  return stages;
}

GLuint link(const Scene& scene, const std::vector<GLenum>& stages, char** files) {
  const GLuint program = glCreateProgram();
  for (std::size_t i = 0; i < stages.size(); ++i) glAttachShader(program, compile(stages[i], files[i]));
  glBindAttribLocation(program, 0, "corner");
  glBindAttribLocation(program, 1, "place");
  for (const auto& [name, location] : scene.outputs) glBindFragDataLocation(program, location, name.c_str());
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  char log[2048] = "";
  glGetProgramInfoLog(program, sizeof log, nullptr, log);
  if (!linked) fail(std::string("the program does not link: ") + log);
  return program;
}

void setUniforms(const Scene& scene, GLuint program) {
  using Int = void (*)(GLint, GLsizei, const GLint*);
  using Uint = void (*)(GLint, GLsizei, const GLuint*);
  using Float = void (*)(GLint, GLsizei, const GLfloat*);
  const Int ints[] = {glUniform1iv, glUniform2iv, glUniform3iv, glUniform4iv};
  const Uint uints[] = {glUniform1uiv, glUniform2uiv, glUniform3uiv, glUniform4uiv};
  const Float floats[] = {glUniform1fv, glUniform2fv, glUniform3fv, glUniform4fv};
  for (const Values& uniform : scene.uniforms) {
    const GLint at = glGetUniformLocation(program, uniform.name.c_str());
    const auto n = static_cast<std::size_t>(uniform.components - 1);
    const std::vector<GLint> i(uniform.values.begin(), uniform.values.end());
    const std::vector<GLuint> u(uniform.values.begin(), uniform.values.end());
    const std::vector<GLfloat> f(uniform.values.begin(), uniform.values.end());
    if (uniform.kind == "i") ints[n](at, 1, i.data());
    if (uniform.kind == "u") uints[n](at, 1, u.data());
    if (uniform.kind == "f") floats[n](at, 1, f.data());
  }
  if (scene.block.values.empty()) return;
  const GLuint index = glGetUniformBlockIndex(program, scene.block.name.c_str());
  if (index == GL_INVALID_INDEX) return;
  const std::vector<GLint> words(scene.block.values.begin(), scene.block.values.end());
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
  glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(4 * words.size()), words.data(), GL_STATIC_DRAW);
  glUniformBlockBinding(program, index, 0);
}

void makeTextures(const Scene& scene, GLuint program) {
  constexpr int kSide = 4;
  GLint unit = 0;
  for (const auto& [name, kind] : scene.textures) {
    std::vector<GLint> ints;
    std::vector<GLfloat> floats;
    for (int i = 0; i < kSide * kSide * 4; ++i) {
      const int value = 7 * (i / 4 % kSide) + 13 * (i / 4 / kSide) + 3 * (i % 4) - 20;
      ints.push_back(value);
      floats.push_back(static_cast<GLfloat>(value) / 4);
    }
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
    const bool whole = kind == "int";
    glTexStorage2D(GL_TEXTURE_2D, 1, whole ? GL_RGBA32I : GL_RGBA32F, kSide, kSide);
    if (whole) {
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSide, kSide, GL_RGBA_INTEGER, GL_INT, ints.data());
    } else {
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, floats.data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glUniform1i(glGetUniformLocation(program, name.c_str()), unit++);
  }
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
}

// As many locations as the linker left alive.
void chooseSubroutines(const Scene& scene, GLuint program, GLenum stage) {
  GLint locations = 0;
  if (!scene.subroutines.empty())
    glGetProgramStageiv(program, stage, GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, &locations);
  if (locations <= 0) return;
  std::vector<GLuint> indices(static_cast<std::size_t>(locations));
  for (const auto& [uniform, function] : scene.subroutines) {
    const GLint at = glGetSubroutineUniformLocation(program, stage, uniform.c_str());
    if (at >= 0)
      indices[static_cast<std::size_t>(at)] = glGetSubroutineIndex(program, stage, function.c_str());
  }
  glUniformSubroutinesuiv(stage, locations, indices.data());
}

GLuint zeroedBuffer(GLenum target, std::size_t words) {
  const std::vector<std::uint32_t> zeros(words);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(target, 0, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(4 * words), zeros.data(), GL_DYNAMIC_COPY);
  return buffer;
}

GLuint makeImage(const Scene& scene) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32I, scene.width, scene.height);
  const std::vector<GLint> zeros(static_cast<std::size_t>(scene.width * scene.height));
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, scene.width, scene.height, GL_RED_INTEGER, GL_INT, zeros.data());
  glBindImageTexture(0, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32I);
  return texture;
}

void makeTargets(const Scene& scene) {
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<GLenum> buffers;
  for (const std::string& kind : scene.targets) {
    GLuint target = 0;
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexStorage2D(GL_TEXTURE_2D, 1,
                   kind == "float" ? GL_RGBA32F
                   : kind == "int" ? GL_RGBA32I
                                   : GL_RGBA32UI,
                   scene.width, scene.height);
    const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + buffers.size());
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, target, 0);
    buffers.push_back(attachment);
  }
  if (scene.depth) {
    GLuint depth = 0;
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, scene.width, scene.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    fail("the framebuffer is incomplete");
  for (std::size_t i = 0; i < scene.targets.size(); ++i) {
    const GLfloat floats[4] = {};
    const GLint ints[4] = {};
    const GLuint uints[4] = {};
    if (scene.targets[i] == "float") glClearBufferfv(GL_COLOR, static_cast<GLint>(i), floats);
    if (scene.targets[i] == "int") glClearBufferiv(GL_COLOR, static_cast<GLint>(i), ints);
    if (scene.targets[i] == "uint") glClearBufferuiv(GL_COLOR, static_cast<GLint>(i), uints);
  }
  glViewport(0, 0, scene.width, scene.height);
}

void attribute(GLuint index, GLint components, const std::vector<float>& values) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(float) * values.size()), values.data(),
               GL_STATIC_DRAW);
  glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(index);
}

void run(const Scene& scene) {
  if (scene.call == "dispatch")
    return glDispatchCompute(static_cast<GLuint>(scene.width / 4), static_cast<GLuint>(scene.height / 2), 1);
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  if (scene.call == "triangle") {
    attribute(0, 2, {-1, -1, 3, -1, -1, 3});
    return glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  std::vector<float> corners;
  std::vector<float> places;
  for (int i = 0; i < scene.width * scene.height; ++i) {
    const float x = static_cast<float>(i % scene.width) + 0.5F;
    const float y = static_cast<float>(i / scene.width) + 0.5F;
    places.insert(places.end(), {x, y});
    corners.insert(corners.end(), {2 * x / static_cast<float>(scene.width) - 1,
                                   2 * y / static_cast<float>(scene.height) - 1, 0, 1});
  }
  attribute(0, 4, corners);
  attribute(1, 2, places);
  if (scene.call == "patches") glPatchParameteri(GL_PATCH_VERTICES, scene.patch_vertices);
  glDrawArrays(scene.call == "patches" ? GL_PATCHES : GL_POINTS, 0, scene.width * scene.height);
}

void writeWords(std::ostream& out, const std::string& what, const std::vector<std::uint32_t>& words) {
  out << what << std::hex;
  for (const std::uint32_t word : words) out << " " << word;
  out << std::dec << "\n";
}

std::vector<std::uint32_t> bufferWords(GLenum target, GLuint buffer, std::size_t count) {
  std::vector<std::uint32_t> words(count);
  glBindBuffer(target, buffer);
  const auto bytes = static_cast<GLsizeiptr>(4 * count);
  if (const void* mapped = glMapBufferRange(target, 0, bytes, GL_MAP_READ_BIT)) {
    const auto* first = static_cast<const std::uint32_t*>(mapped);
    words.assign(first, first + count);
    glUnmapBuffer(target);
  }
  return words;
}

std::vector<std::uint32_t> pixels(const Scene& scene, GLenum format, GLenum type, int components) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(scene.width * scene.height * components));
  glReadPixels(0, 0, scene.width, scene.height, format, type, words.data());
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) fail("usage: generator-draw SCENE SHADERS... [RESULT]");
  const Scene scene = readScene(argv[1]);
  const std::vector<GLenum> stages = stagesOf(argv + 2);
  makeContext(scene.context);
  const GLuint program = link(scene, stages, argv + 2);
  if (scene.call != "dispatch") makeTargets(scene);
  glUseProgram(program);
  setUniforms(scene, program);
  makeTextures(scene, program);
  for (const GLenum stage : stages) chooseSubroutines(scene, program, stage);
  const GLuint storage = scene.storage > 0 ? zeroedBuffer(GL_SHADER_STORAGE_BUFFER, scene.storage) : 0;
  const GLuint counter = scene.counter ? zeroedBuffer(GL_ATOMIC_COUNTER_BUFFER, 1) : 0;
  const GLuint image = scene.image ? makeImage(scene) : 0;

  run(scene);
  if (scene.storage > 0 || scene.image || scene.counter) glMemoryBarrier(GL_ALL_BARRIER_BITS);

  std::ofstream out;
  if (const char* result = argv[2 + stages.size()]) out.open(result);
  for (std::size_t i = 0; i < scene.targets.size(); ++i) {
    const std::string& kind = scene.targets[i];
    glReadBuffer(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i));
    writeWords(out, "target " + std::to_string(i),
               pixels(scene, kind == "float" ? GL_RGBA : GL_RGBA_INTEGER,
                      kind == "float" ? GL_FLOAT
                      : kind == "int" ? GL_INT
                                      : GL_UNSIGNED_INT,
                      4));
  }
  if (scene.depth && scene.context != "es")
    writeWords(out, "depth", pixels(scene, GL_DEPTH_COMPONENT, GL_FLOAT, 1));
  if (storage != 0) writeWords(out, "storage", bufferWords(GL_SHADER_STORAGE_BUFFER, storage, scene.storage));
  if (counter != 0) writeWords(out, "counter", bufferWords(GL_ATOMIC_COUNTER_BUFFER, counter, 1));
  if (image != 0) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, image, 0);
    const std::vector<std::uint32_t> rgba = pixels(scene, GL_RGBA_INTEGER, GL_INT, 4);
    std::vector<std::uint32_t> red;
    for (std::size_t i = 0; i < rgba.size(); i += 4) red.push_back(rgba[i]);
    writeWords(out, "image", red);
  }
  if (const GLenum error = glGetError()) fail("OpenGL error " + std::to_string(error));
}
