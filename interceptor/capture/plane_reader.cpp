// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/plane_reader.h"

#include <string>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/fragment_guards.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

// A triangle that covers everything, from nothing but the number of its vertex.
constexpr const char* kVertex =
    "void main() {\n"
    "  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);\n"
    "}\n";

std::string header(const guard::ContextFacts& facts) {
  if (!facts.es) return "#version 150\n#extension GL_ARB_texture_multisample : enable\n";
  return facts.atLeast(0, 32)
             ? "#version 320 es\nprecision highp float;\nprecision highp int;\n"
             : "#version 310 es\n#extension GL_OES_texture_storage_multisample_2d_array : enable\n"
               "precision highp float;\nprecision highp int;\n";
}

std::string fragment(GLenum type, bool array) {
  const std::string prefix = type == GL_INT ? "i" : type == GL_UNSIGNED_INT ? "u" : "";
  const std::string sampler = prefix + (array ? "sampler2DMSArray" : "sampler2DMS");
  return "uniform highp " + sampler +
         " image;\n"
         "uniform ivec3 plane;\n"  // layer, sample, height if the rows are stored from the top, else 0
         "out " +
         prefix +
         "vec4 value;\n"
         "void main() {\n"
         "  ivec2 at = ivec2(gl_FragCoord.xy);\n"
         "  if (plane.z > 0) at.y = plane.z - 1 - at.y;\n"
         "  value = texelFetch(image, " +
         (array ? "ivec3(at, plane.x)" : "at") + ", plane.y);\n}\n";
}

GLuint compile(GLenum type, const std::string& text) {
  const GLuint shader = gl().CreateShader(type);
  const GLchar* start = text.c_str();
  gl().ShaderSource(shader, 1, &start, nullptr);
  gl().CompileShader(shader);
  return shader;
}

// A texture at unit 0, unfiltered by any sampler object.
class TextureGuard {
 public:
  TextureGuard(const guard::ContextFacts& facts, GLenum target, GLuint texture)
      : target_(target), samplers_(facts.atLeast(33, 30) || facts.has("GL_ARB_sampler_objects")) {
    gl().GetIntegerv(GL_ACTIVE_TEXTURE, &unit_);
    gl().ActiveTexture(GL_TEXTURE0);
    gl().GetIntegerv(target == GL_TEXTURE_2D_MULTISAMPLE ? GL_TEXTURE_BINDING_2D_MULTISAMPLE
                                                         : GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY,
                     &texture_);
    gl().BindTexture(target, texture);
    if (!samplers_) return;
    gl().GetIntegerv(GL_SAMPLER_BINDING, &sampler_);
    gl().BindSampler(0, 0);
  }
  ~TextureGuard() {
    gl().BindTexture(target_, static_cast<GLuint>(texture_));
    if (samplers_) gl().BindSampler(0, static_cast<GLuint>(sampler_));
    gl().ActiveTexture(static_cast<GLenum>(unit_));
  }
  TextureGuard(const TextureGuard&) = delete;
  TextureGuard& operator=(const TextureGuard&) = delete;

 private:
  GLenum target_;
  bool samplers_;
  GLint unit_ = 0, texture_ = 0, sampler_ = 0;
};

}  // namespace

PlaneReader::~PlaneReader() {
  if (framebuffer_ != 0) gl().DeleteFramebuffers(1, &framebuffer_);
  if (vertex_array_ != 0) gl().DeleteVertexArrays(1, &vertex_array_);
  for (const auto& [format, renderbuffer] : destinations_) gl().DeleteRenderbuffers(1, &renderbuffer);
  for (const auto& [type, program] : programs_) gl().DeleteProgram(program);
}

void PlaneReader::bind(const Image& image, Part part, GLenum type, int layer, int sample) {
  if (framebuffer_ == 0) gl().GenFramebuffers(1, &framebuffer_);
  if (target_.samples > 0) return fetchSample(image, part, type, layer, sample);
  constexpr GLenum kAttachments[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT, GL_STENCIL_ATTACHMENT};
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  for (const GLenum attachment : kAttachments) {
    gl().FramebufferRenderbuffer(GL_READ_FRAMEBUFFER, attachment, GL_RENDERBUFFER, 0);
  }
  attachLayer(GL_READ_FRAMEBUFFER, kAttachments[static_cast<int>(part)], image.texture(), layer);
  gl().ReadBuffer(part == Part::color ? GL_COLOR_ATTACHMENT0 : GL_NONE);
}

void PlaneReader::fetchSample(const Image& image, Part part, GLenum type, int layer, int sample) {
  if (part == Part::stencil) type = GL_UNSIGNED_INT;
  const guard::VertexArrayGuard vertices;
  const guard::PlainRasterGuard raster(facts_, target_.width, target_.height);
  const TextureGuard texture(facts_, image.texture().target, image.undecoded());
  if (part != Part::color && facts_.stencilTextures()) {
    gl().TexParameteri(image.texture().target, GL_DEPTH_STENCIL_TEXTURE_MODE,
                       part == Part::stencil ? GL_STENCIL_INDEX : GL_DEPTH_COMPONENT);
  }
  if (vertex_array_ == 0) gl().GenVertexArrays(1, &vertex_array_);
  gl().BindVertexArray(vertex_array_);
  bindDestination(type == GL_INT ? GL_RGBA32I : type == GL_UNSIGNED_INT ? GL_RGBA32UI : GL_RGBA32F);
  const GLuint fetch = program(type);
  gl().UseProgram(fetch);
  gl().Uniform1i(gl().GetUniformLocation(fetch, "image"), 0);
  gl().Uniform3i(gl().GetUniformLocation(fetch, "plane"), layer, sample, upside_down_ ? target_.height : 0);
  gl().DrawArrays(GL_TRIANGLES, 0, 3);
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl().ReadBuffer(GL_COLOR_ATTACHMENT0);
}

void PlaneReader::bindDestination(GLenum format) {
  GLuint& renderbuffer = destinations_[format];
  if (renderbuffer == 0) {
    gl().GenRenderbuffers(1, &renderbuffer);
    gl().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer);
    gl().RenderbufferStorage(GL_RENDERBUFFER, format, target_.width, target_.height);
  }
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer);
  constexpr GLenum kBuffer = GL_COLOR_ATTACHMENT0;
  gl().DrawBuffers(1, &kBuffer);
}

GLuint PlaneReader::program(GLenum type) {
  GLuint& program = programs_[type == GL_INT || type == GL_UNSIGNED_INT ? type : GL_FLOAT];
  if (program != 0) return program;
  const GLuint vertex = compile(GL_VERTEX_SHADER, header(facts_) + kVertex);
  const GLuint fetch = compile(GL_FRAGMENT_SHADER, header(facts_) + fragment(type, target_.layers > 0));
  program = gl().CreateProgram();
  gl().AttachShader(program, vertex);
  gl().AttachShader(program, fetch);
  gl().LinkProgram(program);
  gl().DeleteShader(vertex);
  gl().DeleteShader(fetch);
  return program;
}

}  // namespace shadestep::capture
