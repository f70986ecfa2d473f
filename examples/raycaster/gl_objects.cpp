#include "gl_objects.h"

#include <array>
#include <stdexcept>

namespace raycaster {
namespace {

// Corner number = x + 2 y + 4 z.
const std::vector<unsigned> kBoxIndices = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3,   // +z, -z
                                           5, 1, 3, 5, 3, 7, 0, 4, 6, 0, 6, 2,   // +x, -x
                                           6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};  // +y, -y

GLuint compile(const Gl& gl, GLenum stage, const std::string& text) {
  const GLuint shader = gl.CreateShader(stage);
  const char* const string = text.c_str();
  gl.ShaderSource(shader, 1, &string, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string log(4096, '\0');
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("the driver does not compile the shader: ") + log.c_str());
  }
  return shader;
}

}  // namespace

GLint colourFormat(int bits) {
  return bits == 8 ? GL_RGBA8 : bits == 16 ? GL_RGBA16F : GL_RGBA32F;
}

Objects::~Objects() {
  const auto all = [](const std::vector<GLuint>& names, auto&& remove) {
    remove(static_cast<GLsizei>(names.size()), names.data());
  };
  all(framebuffers_, gl_.DeleteFramebuffers);
  all(renderbuffers_, gl_.DeleteRenderbuffers);
  all(textures_, gl_.DeleteTextures);
  all(buffers_, gl_.DeleteBuffers);
  if (!arrays_.empty()) all(arrays_, gl_.DeleteVertexArrays);
  for (const GLuint program : programs_) gl_.DeleteProgram(program);
  for (const GLuint shader : shaders_) gl_.DeleteShader(shader);
}

GLuint Objects::texture(GLenum unit, GLenum target, bool nearest) {
  GLuint texture = 0;
  gl_.GenTextures(1, &texture);
  textures_.push_back(texture);
  gl_.ActiveTexture(unit);
  gl_.BindTexture(target, texture);
  gl_.TexParameteri(target, GL_TEXTURE_MIN_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
  gl_.TexParameteri(target, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl_.TexParameteri(target, wrap, GL_CLAMP_TO_EDGE);
  return texture;
}

GLuint Objects::image(GLenum unit, GLint format, int size) {
  const GLuint name = texture(unit, GL_TEXTURE_2D, true);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, format, size, size, 0, GL_RGBA, GL_FLOAT, nullptr);
  return name;
}

GLuint Objects::framebuffer(const std::vector<GLuint>& colours, bool depth, int size) {
  GLuint framebuffer = 0;
  gl_.GenFramebuffers(1, &framebuffer);
  framebuffers_.push_back(framebuffer);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<GLenum> attachments;
  for (const GLuint colour : colours) {
    attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, attachments.back(), GL_TEXTURE_2D, colour, 0);
  }
  if (colours.size() > 1) gl_.DrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
  if (depth) {
    GLuint buffer = 0;
    gl_.GenRenderbuffers(1, &buffer);
    renderbuffers_.push_back(buffer);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, size, size);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffer);
  }
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver cannot render into an RGBA32F texture; update it");
  return framebuffer;
}

GLuint Objects::program(const ShaderText& text) {
  const GLuint program = gl_.CreateProgram();
  programs_.push_back(program);
  shaders_.push_back(compile(gl_, GL_VERTEX_SHADER, text.vertex));
  gl_.AttachShader(program, shaders_.back());
  shaders_.push_back(compile(gl_, GL_FRAGMENT_SHADER, text.fragment));
  gl_.AttachShader(program, shaders_.back());
  if (text.glsl == Glsl::v330) {
    gl_.BindAttribLocation(program, 0, "vertex");
    gl_.BindFragDataLocation(program, 0, "FragColor");
    gl_.BindFragDataLocation(program, 1, "HitPosition");
  }
  gl_.LinkProgram(program);
  GLint linked = 0;
  gl_.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    gl_.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("the driver does not link the program: ") + log.c_str());
  }
  gl_.UseProgram(program);
  return program;
}

GLuint Objects::buffer() {
  GLuint buffer = 0;
  gl_.GenBuffers(1, &buffer);
  buffers_.push_back(buffer);
  return buffer;
}

GLuint Objects::vertexArray() {
  GLuint array = 0;
  gl_.GenVertexArrays(1, &array);
  arrays_.push_back(array);
  gl_.BindVertexArray(array);
  return array;
}

Mesh::Mesh(const Gl& gl, Objects& objects, Glsl glsl)
    : gl_(gl), glsl_(glsl), vertices_(objects.buffer()), indices_(objects.buffer()) {
  if (glsl_ == Glsl::v330) array_ = objects.vertexArray();
}

void Mesh::set(const std::vector<float>& corners, const std::vector<unsigned>& indices) {
  const auto bytes = [](const auto& values) {
    return static_cast<GLsizeiptr>(values.size() * sizeof values.front());
  };
  count_ = static_cast<GLsizei>(indices.size());
  if (glsl_ == Glsl::v330) gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER, bytes(corners), corners.data(), GL_STATIC_DRAW);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices), indices.data(), GL_STATIC_DRAW);
  if (glsl_ == Glsl::v330) {
    gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(0);
  }
}

void Mesh::draw(GLenum mode) const {
  if (glsl_ == Glsl::v330) {
    gl_.BindVertexArray(array_);
  } else {
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    gl_.VertexPointer(3, GL_FLOAT, 0, nullptr);
    gl_.EnableClientState(GL_VERTEX_ARRAY);
  }
  gl_.DrawElements(mode, count_, GL_UNSIGNED_INT, nullptr);
}

void setMatrix(const Gl& gl, Glsl glsl, GLuint program, const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix4f single = matrix.cast<float>();
  if (glsl == Glsl::v120) {
    gl.MatrixMode(GL_PROJECTION);
    gl.LoadMatrixf(single.data());
  } else {
    gl.UniformMatrix4fv(gl.GetUniformLocation(program, "modelViewProjection"), 1, GL_FALSE, single.data());
  }
}

void setUniform(const Gl& gl, GLuint program, const char* name, const Eigen::Vector3d& value) {
  const Eigen::Vector3f single = value.cast<float>();
  gl.Uniform3f(gl.GetUniformLocation(program, name), single.x(), single.y(), single.z());
}

void setUniform(const Gl& gl, GLuint program, const char* name, double value) {
  gl.Uniform1f(gl.GetUniformLocation(program, name), static_cast<float>(value));
}

void setUniform(const Gl& gl, GLuint program, const char* name, int value) {
  gl.Uniform1i(gl.GetUniformLocation(program, name), value);
}

void setBox(Mesh& mesh, const Eigen::Vector3d& extent) {
  std::vector<float> corners(24);
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = (i / 3) >> (i % 3) & 1 ? static_cast<float>(extent[static_cast<int>(i % 3)]) : 0.0F;
  mesh.set(corners, kBoxIndices);
}

}  // namespace raycaster
