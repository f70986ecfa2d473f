// What the small programs share: an OSMesa context, linked directly, and shaders that must compile.
// Nothing here knows of the debugger; each program is about the one thing that its first line says.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <utility>
#include <vector>

inline constexpr int kSize = 64;

// Ends the program with status 1 and a sentence.
[[noreturn]] inline void fail(const char* sentence, const char* detail = "") {
  std::fprintf(stderr, "%s %s\n", sentence, detail);
  std::exit(1);
}

// A context, current while it lives.
class OsmesaContext {
 public:
  enum class Profile { compatibility, core };
  explicit OsmesaContext(Profile profile = Profile::compatibility, int major = 3, int minor = 3,
                         int size = kSize)
      : size_(size), colour_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 4) {
    std::vector<int> attributes = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24};
    if (profile == Profile::core)
      attributes.insert(attributes.end(), {OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION,
                                           major, OSMESA_CONTEXT_MINOR_VERSION, minor});
    attributes.push_back(0);
    context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (!context_) fail("no OSMesa context");
    makeCurrent();
  }
  ~OsmesaContext() { OSMesaDestroyContext(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void makeCurrent() {
    if (!OSMesaMakeCurrent(context_, colour_.data(), GL_UNSIGNED_BYTE, size_, size_))
      fail("no OSMesa context");
  }

  // RGBA of a pixel of the default framebuffer, y upwards.
  std::array<int, 4> pixel(int x, int y) {
    glFinish();
    const std::size_t first =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x));
    return {colour_[first], colour_[first + 1], colour_[first + 2], colour_[first + 3]};
  }

  // Carries out what was drawn; the default framebuffer's bytes go into a file, if the user named one.
  // (Mesa 22.3 crashes when a context is destroyed with immediate-mode vertices still waiting.)
  void save(int argc, char** argv) {
    glFinish();
    if (argc < 2) return;
    std::FILE* const file = std::fopen(argv[1], "wb");
    if (!file || std::fwrite(colour_.data(), colour_.size(), 1, file) != 1 || std::fclose(file) != 0)
      fail("cannot write", argv[1]);
  }

 private:
  int size_;
  std::vector<unsigned char> colour_;
  OSMesaContext context_ = nullptr;
};

inline GLuint compile(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  if (!compiled) fail("the shader does not compile:", log.data());
  return shader;
}

// Linked, its shaders still attached.
inline GLuint linkStages(std::initializer_list<std::pair<GLenum, const char*>> shaders) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : shaders) glAttachShader(program, compile(stage, text));
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program, log.size(), nullptr, log.data());
  if (!linked) fail("the program does not link:", log.data());
  return program;
}
inline GLuint linkProgram(const char* vertex, const char* fragment) {
  return linkStages({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
}

// GLSL 1.20: the vertex as it is, in clip space.
inline constexpr const char* kPlainVertex = R"glsl(#version 120
void main()
{
    gl_Position = gl_Vertex;
}
)glsl";

// GLSL 3.30: a triangle that covers everything, from three vertices without attributes.
inline constexpr const char* kCornerVertex = R"glsl(#version 330 core
void main()
{
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)glsl";

// From now on all is drawn to a renderbuffer, as the first colour attachment, and to the whole of it.
inline void drawToRenderbuffer(GLenum format, int width, int height) {
  GLuint framebuffer = 0;
  GLuint target = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glGenRenderbuffers(1, &target);
  glBindRenderbuffer(GL_RENDERBUFFER, target);
  glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
  glViewport(0, 0, width, height);
}

// Fills the window with one triangle.
inline void drawEverywhere() {
  static const float corners[] = {-1, -1, 3, -1, -1, 3};
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, corners);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}
