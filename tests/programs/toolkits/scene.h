// What the toolkit programs share: a fragment shader whose value at a pixel is known, drawn in three frames.
// Each program gets its window, its context and its GL functions in the way of one toolkit; nothing here
// knows of the debugger.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <type_traits>

namespace toolkits {

inline constexpr int kWidth = 64, kHeight = 48, kFrames = 3;

[[noreturn]] inline void fail(const char* what) {
  std::fprintf(stderr, "cannot run here: %s\n", what);
  std::exit(77);
}
inline void require(bool ok, const char* what) {
  if (!ok) fail(what);
}

inline constexpr const char* kVertex = "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n";
inline constexpr const char* kFragment =
    "#version 120\n"
    "uniform float frame;\n"
    "void main() {\n"
    "  float seen = gl_FragCoord.x + 100.0 * frame;\n"
    "  gl_FragColor = vec4(seen / 400.0, 0.0, 0.0, 1.0);\n"
    "}\n";

// The functions as a loader by name gives them.
struct Loaded {
  unsigned (*CreateProgram)();
  unsigned (*CreateShader)(unsigned);
  void (*ShaderSource)(unsigned, int, const char* const*, const int*);
  void (*CompileShader)(unsigned);
  void (*AttachShader)(unsigned, unsigned);
  void (*LinkProgram)(unsigned);
  void (*UseProgram)(unsigned);
  void (*Viewport)(int, int, int, int);
  void (*Uniform1f)(int, float);
  int (*GetUniformLocation)(unsigned, const char*);
  void (*VertexAttribPointer)(unsigned, int, unsigned, unsigned char, int, const void*);
  void (*EnableVertexAttribArray)(unsigned);
  void (*DrawArrays)(unsigned, int, int);
  void (*ReadPixels)(int, int, int, int, unsigned, unsigned, void*);
};

class Scene {
 public:
  explicit Scene(const Loaded& gl) : gl_(gl) {
    program_ = gl_.CreateProgram();
    for (const auto& [stage, text] :
         {Part{0x8B31 /* GL_VERTEX_SHADER */, kVertex}, Part{0x8B30 /* GL_FRAGMENT_SHADER */, kFragment}}) {
      const unsigned shader = gl_.CreateShader(stage);
      gl_.ShaderSource(shader, 1, &text, nullptr);
      gl_.CompileShader(shader);
      gl_.AttachShader(program_, shader);
    }
    gl_.LinkProgram(program_);
    gl_.UseProgram(program_);
  }

  void draw(int frame) const {
    static const float corners[] = {-1, -1, 3, -1, -1, 3};
    gl_.Viewport(0, 0, kWidth, kHeight);
    gl_.Uniform1f(gl_.GetUniformLocation(program_, "frame"), static_cast<float>(frame));
    gl_.VertexAttribPointer(0, 2, 0x1406 /* GL_FLOAT */, 0, 0, corners);
    gl_.EnableVertexAttribArray(0);
    gl_.DrawArrays(4 /* GL_TRIANGLES */, 0, 3);
  }

  // Whether the pixel shows what the last frame drew: 200 + 10.5 of 400, in 255ths.
  bool right() const {
    unsigned char pixel[4] = {};
    gl_.ReadPixels(10, 7, 1, 1, 0x1908 /* GL_RGBA */, 0x1401 /* GL_UNSIGNED_BYTE */, pixel);
    return pixel[0] >= 133 && pixel[0] <= 135;
  }

 private:
  struct Part {
    unsigned stage;
    const char* text;
  };
  Loaded gl_;
  unsigned program_ = 0;
};

template <class Load>
Loaded load(Load byName) {
  Loaded gl{};
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(byName(name));
    require(function != nullptr, name);
  };
  find(gl.CreateProgram, "glCreateProgram");
  find(gl.CreateShader, "glCreateShader");
  find(gl.ShaderSource, "glShaderSource");
  find(gl.CompileShader, "glCompileShader");
  find(gl.AttachShader, "glAttachShader");
  find(gl.LinkProgram, "glLinkProgram");
  find(gl.UseProgram, "glUseProgram");
  find(gl.Viewport, "glViewport");
  find(gl.Uniform1f, "glUniform1f");
  find(gl.GetUniformLocation, "glGetUniformLocation");
  find(gl.VertexAttribPointer, "glVertexAttribPointer");
  find(gl.EnableVertexAttribArray, "glEnableVertexAttribArray");
  find(gl.DrawArrays, "glDrawArrays");
  find(gl.ReadPixels, "glReadPixels");
  return gl;
}

}  // namespace toolkits

// For headers that declare glX as a function or a macro: the functions by those names.
#define TOOLKITS_NAMED_GL                                                                            \
  toolkits::Loaded {                                                                                 \
    glCreateProgram, glCreateShader, glShaderSource, glCompileShader, glAttachShader, glLinkProgram, \
        glUseProgram, glViewport, glUniform1f, glGetUniformLocation, glVertexAttribPointer,          \
        glEnableVertexAttribArray, glDrawArrays, glReadPixels                                        \
  }
