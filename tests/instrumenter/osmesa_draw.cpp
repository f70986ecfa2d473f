#include "osmesa_draw.h"

#include <GL/osmesa.h>
// After osmesa.h, which brings GL/gl.h.
#include <GL/glext.h>

#include <array>
#include <stdexcept>

namespace shadestep::instrumenter::test {

namespace {

template <class Pointer>
Pointer load(const char* name) {
  const auto found = OSMesaGetProcAddress(name);
  if (!found) throw std::runtime_error(std::string("OSMesa lacks ") + name);
  return reinterpret_cast<Pointer>(found);
}

const auto CreateShader = load<PFNGLCREATESHADERPROC>("glCreateShader");
const auto ShaderSource = load<PFNGLSHADERSOURCEPROC>("glShaderSource");
const auto CompileShader = load<PFNGLCOMPILESHADERPROC>("glCompileShader");
const auto GetShaderiv = load<PFNGLGETSHADERIVPROC>("glGetShaderiv");
const auto GetShaderInfoLog = load<PFNGLGETSHADERINFOLOGPROC>("glGetShaderInfoLog");
const auto DeleteShader = load<PFNGLDELETESHADERPROC>("glDeleteShader");
const auto CreateProgram = load<PFNGLCREATEPROGRAMPROC>("glCreateProgram");
const auto AttachShader = load<PFNGLATTACHSHADERPROC>("glAttachShader");
const auto BindFragDataLocation = load<PFNGLBINDFRAGDATALOCATIONPROC>("glBindFragDataLocation");
const auto BindAttribLocation = load<PFNGLBINDATTRIBLOCATIONPROC>("glBindAttribLocation");
const auto LinkProgram = load<PFNGLLINKPROGRAMPROC>("glLinkProgram");
const auto GetProgramiv = load<PFNGLGETPROGRAMIVPROC>("glGetProgramiv");
const auto GetProgramInfoLog = load<PFNGLGETPROGRAMINFOLOGPROC>("glGetProgramInfoLog");
const auto DeleteProgram = load<PFNGLDELETEPROGRAMPROC>("glDeleteProgram");
const auto UseProgram = load<PFNGLUSEPROGRAMPROC>("glUseProgram");
const auto GetUniformLocation = load<PFNGLGETUNIFORMLOCATIONPROC>("glGetUniformLocation");
const auto Uniform1i = load<PFNGLUNIFORM1IPROC>("glUniform1i");
const auto Uniform4iv = load<PFNGLUNIFORM4IVPROC>("glUniform4iv");
const auto Uniform4uiv = load<PFNGLUNIFORM4UIVPROC>("glUniform4uiv");
const auto Uniform1fv = load<PFNGLUNIFORM1FVPROC>("glUniform1fv");
const auto Uniform2fv = load<PFNGLUNIFORM2FVPROC>("glUniform2fv");
const auto Uniform3fv = load<PFNGLUNIFORM3FVPROC>("glUniform3fv");
const auto Uniform4fv = load<PFNGLUNIFORM4FVPROC>("glUniform4fv");
const auto GenVertexArrays = load<PFNGLGENVERTEXARRAYSPROC>("glGenVertexArrays");
const auto BindVertexArray = load<PFNGLBINDVERTEXARRAYPROC>("glBindVertexArray");
const auto GenBuffers = load<PFNGLGENBUFFERSPROC>("glGenBuffers");
const auto BindBuffer = load<PFNGLBINDBUFFERPROC>("glBindBuffer");
const auto BindBufferBase = load<PFNGLBINDBUFFERBASEPROC>("glBindBufferBase");
const auto BufferData = load<PFNGLBUFFERDATAPROC>("glBufferData");
const auto GetBufferSubData = load<PFNGLGETBUFFERSUBDATAPROC>("glGetBufferSubData");
const auto DeleteBuffers = load<PFNGLDELETEBUFFERSPROC>("glDeleteBuffers");
const auto VertexAttribPointer = load<PFNGLVERTEXATTRIBPOINTERPROC>("glVertexAttribPointer");
const auto EnableVertexAttribArray = load<PFNGLENABLEVERTEXATTRIBARRAYPROC>("glEnableVertexAttribArray");
const auto GetProgramResourceIndex = load<PFNGLGETPROGRAMRESOURCEINDEXPROC>("glGetProgramResourceIndex");
const auto ShaderStorageBlockBinding =
    load<PFNGLSHADERSTORAGEBLOCKBINDINGPROC>("glShaderStorageBlockBinding");
const auto GenFramebuffers = load<PFNGLGENFRAMEBUFFERSPROC>("glGenFramebuffers");
const auto BindFramebuffer = load<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer");
const auto DeleteFramebuffers = load<PFNGLDELETEFRAMEBUFFERSPROC>("glDeleteFramebuffers");
const auto FramebufferTexture2D = load<PFNGLFRAMEBUFFERTEXTURE2DPROC>("glFramebufferTexture2D");
const auto DrawBuffers = load<PFNGLDRAWBUFFERSPROC>("glDrawBuffers");
const auto ClearBufferfv = load<PFNGLCLEARBUFFERFVPROC>("glClearBufferfv");
const auto ClearBufferuiv = load<PFNGLCLEARBUFFERUIVPROC>("glClearBufferuiv");

// A context of each profile, made at first use, current on a small buffer of its own.
void makeCurrent(Profile profile) {
  struct Context {
    OSMesaContext context = nullptr;
    std::array<std::uint32_t, kPixels> image{};
  };
  static std::array<Context, 2> contexts;
  Context& mine = contexts[profile == Profile::core ? 0 : 1];
  if (!mine.context) {
    const int core[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        4,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        5,
                        0};
    const int compatibility[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
    mine.context = OSMesaCreateContextAttribs(profile == Profile::core ? core : compatibility, nullptr);
    if (!mine.context) throw std::runtime_error("OSMesa gives no context");
  }
  OSMesaMakeCurrent(mine.context, mine.image.data(), GL_UNSIGNED_BYTE, kSize, kSize);
}

std::string compile(GLuint program, GLenum stage, const std::string& text) {
  const GLuint shader = CreateShader(stage);
  const char* string = text.c_str();
  ShaderSource(shader, 1, &string, nullptr);
  CompileShader(shader);
  AttachShader(program, shader);
  DeleteShader(shader);  // with the program
  GLint compiled = 0;
  GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<char, 4096> log{};
  GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return compiled ? "" : std::string(log.data()) + "\n" + text;
}

// A vertex shader of the same version that gives `place`.
std::string defaultVertexText(const std::string& fragment) {
  const std::string version = fragment.substr(0, fragment.find('\n') + 1);
  const bool old = version.starts_with("#version 1") && version.find("#version 13") &&
                   version.find("#version 14") && version.find("#version 15");
  const std::string in = old ? "attribute " : "in ", out = old ? "varying " : "out ";
  return version + in + "vec2 corner;\n" + out + "vec2 place;\n" +
         "void main() { place = corner * 0.5 + 0.5; gl_Position = vec4(corner, 0.0, 1.0); }\n";
}

std::string link(GLuint program, const DrawRequest& request) {
  const std::string vertex =
      request.vertex_text.empty() ? defaultVertexText(request.text) : request.vertex_text;
  std::string error =
      compile(program, GL_VERTEX_SHADER, vertex) + compile(program, GL_FRAGMENT_SHADER, request.text);
  if (!error.empty()) return error;
  BindAttribLocation(program, 0, request.vertex_text.empty() ? "corner" : "sd_corner");
  GLuint location = 0;
  for (const std::string& output : request.user_outputs)
    BindFragDataLocation(program, location++, output.c_str());
  location = static_cast<GLuint>(request.color_buffers);
  for (const std::string& output : request.capture.outputs)
    BindFragDataLocation(program, location++, output.c_str());
  LinkProgram(program);
  GLint linked = 0;
  GetProgramiv(program, GL_LINK_STATUS, &linked);
  std::array<char, 4096> log{};
  GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return linked ? "" : std::string(log.data()) + "\n" + request.text;
}

void setUniform(GLuint program, const std::string& name, const Uniform& uniform) {
  const GLint location = GetUniformLocation(program, name.c_str());
  const auto* floats = reinterpret_cast<const GLfloat*>(uniform.words.data());
  const auto* ints = reinterpret_cast<const GLint*>(uniform.words.data());
  const bool is_float = uniform.type.basic == frontend::Basic::float_;
  switch (uniform.type.rows) {
    case 1:
      is_float ? Uniform1fv(location, 1, floats) : Uniform1i(location, *ints);
      break;
    case 2:
      Uniform2fv(location, 1, floats);
      break;
    case 3:
      Uniform3fv(location, 1, floats);
      break;
    default:
      if (is_float)
        Uniform4fv(location, static_cast<GLsizei>(uniform.words.size() / 4), floats);
      else if (uniform.type.basic == frontend::Basic::uint_)
        Uniform4uiv(location, static_cast<GLsizei>(uniform.words.size() / 4), uniform.words.data());
      else
        Uniform4iv(location, 1, ints);
  }
}

GLuint makeTexture(GLenum format, GLenum transfer, GLenum type) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), kSize, kSize, 0, transfer, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

std::vector<std::uint32_t> readBack(int attachment, GLenum transfer, GLenum type) {
  std::vector<std::uint32_t> words(kPixels * 4);
  glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachment));
  glReadPixels(0, 0, kSize, kSize, transfer, type, words.data());
  return words;
}

void drawTriangle() {
  static const GLfloat corners[] = {-1, -1, 3, -1, -1, 3};
  GLuint array = 0, buffer = 0;
  GenVertexArrays(1, &array);
  BindVertexArray(array);
  GenBuffers(1, &buffer);
  BindBuffer(GL_ARRAY_BUFFER, buffer);
  BufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  EnableVertexAttribArray(0);
  glViewport(0, 0, kSize, kSize);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFinish();
}

void gather(const DrawRequest& request, DrawResult& result) {
  for (int i = 0; i < request.color_buffers; ++i) result.outputs.push_back(readBack(i, GL_RGBA, GL_FLOAT));
  if (request.capture.words == 0) return;
  const bool floats = request.capture.carrier == Carrier::float_attachments;
  result.captured.resize(kPixels);
  for (int i = 0; i < request.capture.attachments(); ++i) {
    const std::vector<std::uint32_t> words = readBack(
        request.color_buffers + i, floats ? GL_RGBA : GL_RGBA_INTEGER, floats ? GL_FLOAT : GL_UNSIGNED_INT);
    for (std::size_t pixel = 0; pixel < kPixels; ++pixel)
      for (std::size_t channel = 0; channel < 4; ++channel)
        result.captured[pixel].push_back(words[pixel * 4 + channel]);
  }
}

// For every pixel once: one triangle has no more.
std::vector<std::uint32_t> roomForDiscarded(const AttachmentLayout& layout) {
  std::vector<std::uint32_t> words(kDiscardedHeader +
                                   static_cast<std::size_t>(layout.discarded_words) * kPixels);
  words[1] = kPixels;
  return words;
}

void addDiscarded(const AttachmentLayout& layout, DrawResult& result) {
  const DiscardedThreads discarded = decodeDiscarded(layout, result.storage);
  if (discarded.ended != discarded.threads.size()) result.error = "more discarded threads than pixels";
  for (const DiscardedThread& thread : discarded.threads) {
    std::vector<std::uint32_t>& words =
        result.captured.at(static_cast<std::size_t>(thread.y * kSize + thread.x));
    if (decodeMark(layout, words.data()) != 0) result.error = "a discarded thread left words";
    words.assign(thread.words, thread.words + 4 * layout.attachments());
    words[0] = encodeMark(layout, decodeMark(layout, words.data()) | kDiscarded);
  }
}

}  // namespace

DrawResult draw(Profile profile, const DrawRequest& request) {
  makeCurrent(profile);
  DrawResult result;
  const GLuint program = CreateProgram();
  result.error = link(program, request);
  if (!result.error.empty()) {
    DeleteProgram(program);
    return result;
  }
  UseProgram(program);
  for (const auto& [name, uniform] : request.uniforms) setUniform(program, name, uniform);

  const std::string& list = request.capture.discarded_block;
  const std::string& block = list.empty() ? request.storage_block : list;
  result.storage = list.empty() ? request.storage : roomForDiscarded(request.capture);
  GLuint storage = 0;
  if (!block.empty()) {
    GenBuffers(1, &storage);
    BindBuffer(GL_SHADER_STORAGE_BUFFER, storage);
    BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(result.storage.size() * 4),
               result.storage.data(), GL_DYNAMIC_READ);
    BindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, storage);
    ShaderStorageBlockBinding(program,
                              GetProgramResourceIndex(program, GL_SHADER_STORAGE_BLOCK, block.c_str()), 3);
  }

  GLuint framebuffer = 0;
  GenFramebuffers(1, &framebuffer);
  BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<GLuint> textures;
  std::vector<GLenum> buffers;
  const int captures = request.capture.words == 0 ? 0 : request.capture.attachments();
  const bool floats = request.capture.carrier == Carrier::float_attachments;
  for (int i = 0; i < request.color_buffers + captures; ++i) {
    const bool integer = i >= request.color_buffers && !floats;
    textures.push_back(integer ? makeTexture(GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT)
                               : makeTexture(GL_RGBA32F, GL_RGBA, GL_FLOAT));
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    FramebufferTexture2D(GL_FRAMEBUFFER, buffers.back(), GL_TEXTURE_2D, textures.back(), 0);
  }
  DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  for (int i = 0; i < request.color_buffers + captures; ++i) {
    const GLfloat zero[4] = {};
    const GLuint zero_bits[4] = {};
    if (i >= request.color_buffers && !floats)
      ClearBufferuiv(GL_COLOR, i, zero_bits);
    else
      ClearBufferfv(GL_COLOR, i, zero);
  }
  drawTriangle();
  gather(request, result);

  if (storage != 0) {
    BindBuffer(GL_SHADER_STORAGE_BUFFER, storage);
    GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(result.storage.size() * 4),
                     result.storage.data());
    DeleteBuffers(1, &storage);
  }
  if (!list.empty()) addDiscarded(request.capture, result);
  if (const GLenum code = glGetError()) result.error = "GL error " + std::to_string(code);
  DeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
  UseProgram(0);
  DeleteProgram(program);
  return result;
}

}  // namespace shadestep::instrumenter::test
