// The scenes that the agent's tests stop in: two draws into a target whose contents matter (blending, depth),
// under state that a careless debugger would disturb, and then a dump of that state. Nothing here knows of
// the debugger.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace scene {

inline constexpr int kWidth = 48, kHeight = 32;

inline GLuint compile(GLenum stage, const std::vector<const char*>& strings) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, static_cast<GLsizei>(strings.size()), strings.data(), nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  char log[2048] = {};
  glGetShaderInfoLog(shader, sizeof log, nullptr, log);
  std::fprintf(stderr, "%s\n", log);
  std::exit(3);
}

// ---- a dump of state, one line a value
// -------------------------------------------------------------------------

class StateDump {
 public:
  explicit StateDump(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {}
  ~StateDump() { std::fclose(file_); }
  void number(const char* name, long long value) { std::fprintf(file_, "%s %lld\n", name, value); }
  void integers(const char* label, GLenum name, int count = 1) {
    GLint values[16] = {};
    glGetIntegerv(name, values);
    std::fprintf(file_, "%s", label);
    for (int i = 0; i < count; ++i) std::fprintf(file_, " %d", values[i]);
    std::fprintf(file_, "\n");
  }
  void floats(const char* label, GLenum name, int count = 1) {
    GLfloat values[16] = {};
    glGetFloatv(name, values);
    std::fprintf(file_, "%s", label);
    for (int i = 0; i < count; ++i) std::fprintf(file_, " %a", static_cast<double>(values[i]));
    std::fprintf(file_, "\n");
  }

 private:
  std::FILE* file_;
};

#define DUMP(name) dump.integers(#name, name)
#define DUMP_N(name, count) dump.integers(#name, name, count)
#define DUMP_F(name, count) dump.floats(#name, name, count)

// What the program can ask after its draw, and what its next texture would be called (not so its other
// objects: Mesa gives no name out again).
inline void dumpState(const std::string& path, bool compatibility) {
  StateDump dump(path);
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) dump.number("error", error);
  DUMP(GL_DRAW_FRAMEBUFFER_BINDING);
  DUMP(GL_READ_FRAMEBUFFER_BINDING);
  DUMP(GL_RENDERBUFFER_BINDING);
  DUMP(GL_CURRENT_PROGRAM);
  DUMP(GL_VERTEX_ARRAY_BINDING);
  DUMP(GL_ARRAY_BUFFER_BINDING);
  DUMP(GL_ELEMENT_ARRAY_BUFFER_BINDING);
  DUMP(GL_PIXEL_PACK_BUFFER_BINDING);
  DUMP(GL_PIXEL_UNPACK_BUFFER_BINDING);
  DUMP(GL_UNIFORM_BUFFER_BINDING);
  DUMP(GL_SHADER_STORAGE_BUFFER_BINDING);
  DUMP(GL_COPY_READ_BUFFER_BINDING);
  DUMP(GL_COPY_WRITE_BUFFER_BINDING);
  DUMP(GL_ACTIVE_TEXTURE);
  DUMP(GL_READ_BUFFER);
  DUMP(GL_PACK_ALIGNMENT);
  DUMP(GL_PACK_ROW_LENGTH);
  DUMP(GL_PACK_SKIP_ROWS);
  DUMP(GL_PACK_SKIP_PIXELS);
  DUMP(GL_PACK_SWAP_BYTES);
  DUMP(GL_UNPACK_ALIGNMENT);
  DUMP(GL_UNPACK_ROW_LENGTH);
  DUMP(GL_CLAMP_READ_COLOR);
  DUMP_N(GL_VIEWPORT, 4);
  DUMP_N(GL_SCISSOR_BOX, 4);
  DUMP(GL_SCISSOR_TEST);
  DUMP(GL_FRAMEBUFFER_SRGB);
  DUMP(GL_DEPTH_TEST);
  DUMP(GL_DEPTH_WRITEMASK);
  DUMP(GL_DEPTH_FUNC);
  DUMP(GL_STENCIL_TEST);
  DUMP(GL_STENCIL_WRITEMASK);
  DUMP(GL_CULL_FACE);
  DUMP(GL_RASTERIZER_DISCARD);
  DUMP(GL_COLOR_LOGIC_OP);
  DUMP(GL_DITHER);
  DUMP(GL_DEBUG_OUTPUT);
  DUMP_N(GL_POLYGON_MODE, compatibility ? 2 : 1);
  DUMP_F(GL_COLOR_CLEAR_VALUE, 4);
  DUMP_F(GL_BLEND_COLOR, 4);
  DUMP(GL_TRANSFORM_FEEDBACK_ACTIVE);
  DUMP(GL_TRANSFORM_FEEDBACK_PAUSED);
  GLint count = 0;
  glGetIntegerv(GL_MAX_DRAW_BUFFERS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLboolean mask[4] = {};
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask);
    dump.number("mask", mask[0] | mask[1] << 1 | mask[2] << 2 | mask[3] << 3);
    dump.number("blend", glIsEnabledi(GL_BLEND, i));
    dump.integers("draw buffer", GL_DRAW_BUFFER0 + i);
  }
  glGetIntegerv(GL_MAX_VIEWPORTS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLfloat box[4] = {};
    glGetFloati_v(GL_VIEWPORT, i, box);
    for (const GLfloat value : box) dump.number("viewport", static_cast<long long>(value * 16));
    dump.number("scissor", glIsEnabledi(GL_SCISSOR_TEST, i));
  }
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLint buffer = 0;
    GLint64 start = 0;
    GLint64 size = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &buffer);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &start);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &size);
    dump.number("storage buffer", buffer);
    dump.number("storage start", start);
    dump.number("storage size", size);
  }
  for (GLenum unit = 0; unit < 4; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    DUMP(GL_TEXTURE_BINDING_2D);
    DUMP(GL_TEXTURE_BINDING_3D);
    DUMP(GL_TEXTURE_BINDING_RECTANGLE);
    DUMP(GL_TEXTURE_BINDING_CUBE_MAP);
  }
  if (compatibility) {
    DUMP(GL_ATTRIB_STACK_DEPTH);
    DUMP(GL_CLIENT_ATTRIB_STACK_DEPTH);
    DUMP(GL_MATRIX_MODE);
    DUMP(GL_ALPHA_TEST);
    DUMP_F(GL_RED_SCALE, 1);
    DUMP_F(GL_ALPHA_BIAS, 1);
    DUMP_F(GL_DEPTH_SCALE, 1);
    DUMP_F(GL_CURRENT_COLOR, 4);
  }
  GLuint next = 0;
  glGenTextures(1, &next);
  dump.number("next texture", next);
  dump.number("last error", glGetError());
}

// The draw framebuffer's contents: RGBA floats, rows from the bottom up, then depth. All state that the dump
// looks at has been dumped before.
inline void saveImage(const std::string& path, bool compatibility, GLuint framebuffer) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glPixelStorei(GL_PACK_SKIP_ROWS, 0);
  if (compatibility) {
    glPixelTransferf(GL_RED_SCALE, 1);
    glPixelTransferf(GL_ALPHA_BIAS, 0);
  }
  std::vector<float> pixels(static_cast<std::size_t>(kWidth) * kHeight * 5);
  glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data());
  glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, pixels.data() + kWidth * kHeight * 4);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(pixels.data(), sizeof(float), pixels.size(), file) != pixels.size())
    std::exit(4);
  std::fclose(file);
}

// ---- 3.3 core
// --------------------------------------------------------------------------------------------------

inline constexpr const char* kCoreVertex = R"glsl(#version 330 core
in vec2 corner;
in float unused_by_the_fragment;
uniform vec2 shift;
out vec2 place;
out float extra;
void main() {
  place = corner * 0.5 + 0.5;
  extra = unused_by_the_fragment;
  gl_Position = vec4(corner + shift, 0.25 * corner.x, 1.0);
}
)glsl";

// In two strings: what the program gives is what the session must get.
inline constexpr const char* kCoreVersion = "#version 330 core\n";
inline constexpr const char* kCoreFragment = R"glsl(
struct Light { vec3 color; float power[2]; };
uniform float scale;
uniform ivec3 bias;
uniform mat3x2 twist;
uniform uvec2 bits;
uniform bool on;
uniform Light lights[2];
layout(std140) uniform Tint { vec4 tint; };
uniform sampler2D image;
in vec2 place;
in float extra;
out vec4 color;
void main() {
  color = vec4(place * scale, 0.5, 0.75) * tint;
  color.x += twist[2][1] + float(bias.z) + lights[1].power[1] * texture(image, place).x;
  if (on) color.y += float(bits.y & 7u);
  color.x += 0.25 * fract((place.x + place.y) * 65536.0);  // shows the last bits of an interpolation
}
)glsl";

inline GLuint floatTarget() {
  GLuint color = 0;
  GLuint depth = 0;
  GLuint framebuffer = 0;
  glGenTextures(1, &color);
  glBindTexture(GL_TEXTURE_2D, color);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kWidth, kHeight, 0, GL_RGBA, GL_FLOAT, nullptr);
  glGenRenderbuffers(1, &depth);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH32F_STENCIL8, kWidth, kHeight);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2, GL_TEXTURE_2D, color, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth);
  const GLenum buffers[] = {GL_NONE, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(2, buffers);
  glReadBuffer(GL_COLOR_ATTACHMENT2);
  return framebuffer;
}

// Draws twice; `own_target`: into an RGBA32F texture at draw buffer 1 instead of the window.
inline void drawCore(bool own_target) {
  const GLuint program = glCreateProgram();
  const GLuint vertex = compile(GL_VERTEX_SHADER, {kCoreVertex});
  const GLuint fragment = compile(GL_FRAGMENT_SHADER, {kCoreVersion, kCoreFragment});
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glBindAttribLocation(program, 3, "corner");
  glBindAttribLocation(program, 5, "unused_by_the_fragment");
  glBindFragDataLocation(program, own_target ? 1 : 0, "color");
  glLinkProgram(program);
  // New text that is never linked, and the end of the shader: what was linked counts.
  const char* other = "nonsense";
  glShaderSource(fragment, 1, &other, nullptr);
  glCompileShader(fragment);
  glDeleteShader(fragment);
  glDetachShader(program, fragment);
  glUseProgram(program);

  const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
  const GLfloat twist[6] = {0, 0, 0, 0, 0, 0.0625F};
  glUniform1f(at("scale"), 0.7F);
  glUniform3i(at("bias"), 4, 5, -1);
  glUniformMatrix3x2fv(at("twist"), 1, GL_FALSE, twist);
  glUniform2ui(at("bits"), 1, 0xfffffffaU);
  glUniform1i(at("on"), 1);
  glUniform1f(at("lights[1].power[1]"), 1.25F);
  glUniform2f(at("shift"), 0.125F, 0.0F);
  glUniform1i(at("image"), 2);

  const GLfloat tint[4] = {0.5F, 0.25F, 0.875F, 1.0F};
  GLuint buffers[4];
  glGenBuffers(4, buffers);
  glBindBuffer(GL_UNIFORM_BUFFER, buffers[0]);
  glBufferData(GL_UNIFORM_BUFFER, sizeof tint, tint, GL_STATIC_DRAW);
  glUniformBlockBinding(program, glGetUniformBlockIndex(program, "Tint"), 7);
  glBindBufferBase(GL_UNIFORM_BUFFER, 7, buffers[0]);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);

  const GLfloat texels[4] = {0.25F, 0.5F, 0.75F, 1.0F};
  GLuint texture = 0;
  glActiveTexture(GL_TEXTURE2);
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, 2, 2, 0, GL_RED, GL_FLOAT, texels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glActiveTexture(GL_TEXTURE1);

  const GLuint framebuffer = own_target ? floatTarget() : 0;
  const GLfloat corners[] = {-0.9F, -0.8F, 7, 0.95F, -0.7F, 7, 0.0F, 0.9F, 7};
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, 12, nullptr);
  glVertexAttribPointer(5, 1, GL_FLOAT, GL_FALSE, 12, reinterpret_cast<const void*>(8));
  glEnableVertexAttribArray(3);
  glEnableVertexAttribArray(5);

  glViewport(0, 0, kWidth, kHeight);
  glClearColor(0.125F, 0.25F, 0.5F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  // State that stands in a debugger's way.
  glEnable(GL_SCISSOR_TEST);
  glScissor(3, 2, 40, 27);
  glColorMask(GL_TRUE, GL_TRUE, GL_FALSE, GL_TRUE);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[2]);
  glBufferData(GL_PIXEL_PACK_BUFFER, 64, nullptr, GL_STATIC_READ);
  glPixelStorei(GL_PACK_ALIGNMENT, 8);
  glPixelStorei(GL_PACK_ROW_LENGTH, 100);
  glPixelStorei(GL_PACK_SKIP_ROWS, 2);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[2]);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[2]);
  glBufferData(GL_SHADER_STORAGE_BUFFER, 4096, nullptr, GL_STATIC_READ);
  GLint bindings = 0;
  GLint alignment = 256;
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &bindings);
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(bindings) - 1, buffers[2], alignment, 32);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[3]);
  if (own_target) {
    GLuint other = 0;
    glGenFramebuffers(1, &other);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, other);
  }
  glBindTexture(GL_TEXTURE_2D, texture);
  glViewportIndexedf(3, 1, 2, 3, 4);
  glEnable(static_cast<GLenum>(0xdead));  // leaves GL_INVALID_ENUM waiting
  glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 2);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
}

// ---- 2.1, GLSL 1.20
// --------------------------------------------------------------------------------------------

inline constexpr const char* kOldVertex = R"glsl(#version 120
varying vec2 place;
void main() {
  place = gl_Vertex.xy * 0.5 + 0.5;
  gl_FrontColor = gl_Color;
  gl_Position = ftransform();
}
)glsl";
inline constexpr const char* kOldFragment = R"glsl(#version 120
uniform float scale;
uniform vec3 steps[3];
varying vec2 place;
void main() {
  gl_FragColor = vec4(place * scale, steps[2].y, 0.75) * gl_Color;
}
)glsl";

inline void drawCompatibility() {
  const GLuint program = glCreateProgram();
  // As programs of that time did it.
  const GLhandleARB fragment = glCreateShaderObjectARB(GL_FRAGMENT_SHADER_ARB);
  const char* text = kOldFragment;
  glShaderSourceARB(fragment, 1, &text, nullptr);
  glCompileShaderARB(fragment);
  glAttachShader(program, compile(GL_VERTEX_SHADER, {kOldVertex}));
  glAttachObjectARB(program, fragment);
  glLinkProgramARB(program);
  glUseProgramObjectARB(program);
  glUniform1f(glGetUniformLocation(program, "scale"), 0.7F);
  glUniform3f(glGetUniformLocation(program, "steps[2]"), 0, 0.3F, 0);

  static const GLfloat corners[] = {-0.9F, -0.8F, 0.95F, -0.7F, 0.0F, 0.9F};
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(2, GL_FLOAT, 0, corners);
  glViewport(0, 0, kWidth, kHeight);
  glClearColor(0.125F, 0.25F, 0.5F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE);
  glColor4f(1.0F, 0.5F, 0.25F, 0.5F);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  glMatrixMode(GL_TEXTURE);
  glRotatef(20, 0, 0, 1);
  glMatrixMode(GL_MODELVIEW);
  glRotatef(30, 0, 0, 1);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_GREATER, 0.1F);
  glEnable(GL_DEPTH_TEST);
  glPixelTransferf(GL_RED_SCALE, 0.5F);
  glPixelTransferf(GL_ALPHA_BIAS, 0.25F);
  glPixelStorei(GL_PACK_ROW_LENGTH, 100);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

inline int run(const std::string& name, const std::string& out) {
  const bool compatibility = name == "compatibility";
  const bool own_target = name == "core-texture";
  if (compatibility) {
    drawCompatibility();
  } else {
    drawCore(own_target);
  }
  GLint framebuffer = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  dumpState(out + ".state", compatibility);
  saveImage(out + ".image", compatibility, static_cast<GLuint>(framebuffer));
  return 0;
}

}  // namespace scene
