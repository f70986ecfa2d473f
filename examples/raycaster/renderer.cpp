#include "renderer.h"

#include <array>
#include <stdexcept>
#include <string>

namespace raycaster {
namespace {

// The box's faces, counter-clockwise from outside; corner number = x + 2 y + 4 z.
constexpr std::array<GLubyte, 36> kBoxIndices = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3,   // +z, -z
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

// A texture left bound to the unit.
GLuint createTexture(const Gl& gl, GLenum unit, GLenum target) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(unit);
  gl.BindTexture(target, texture);
  gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(target, wrap, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

ShaderText shaderText(Glsl glsl, Classification classification) {
  return {glsl, vertexShader(glsl), fragmentShader(glsl, classification)};
}

Renderer::Renderer(const Gl& gl, const Scene& scene, const ShaderText& text, int size)
    : gl_(gl), glsl_(text.glsl), size_(size) {
  createTextures(scene);
  createProgram(text, scene);
  createBox(scene.volume.extent);
  createTarget();
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.Viewport(0, 0, size_, size_);
  if (gl_.GetError() != GL_NO_ERROR)
    throw std::runtime_error("the driver refuses float textures of this size; try a smaller --size");
}

void Renderer::draw(const Camera& camera) {
  const Eigen::Matrix4f matrix = camera.modelViewProjection().cast<float>();
  const Eigen::Vector3f position = camera.position().cast<float>();
  if (glsl_ == Glsl::v120) {
    gl_.MatrixMode(GL_PROJECTION);
    gl_.LoadMatrixf(matrix.data());
  } else {
    gl_.UniformMatrix4fv(gl_.GetUniformLocation(program_, "modelViewProjection"), 1, GL_FALSE, matrix.data());
  }
  gl_.Uniform3f(gl_.GetUniformLocation(program_, "camera"), position.x(), position.y(), position.z());

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(kBoxIndices.size()), GL_UNSIGNED_BYTE, nullptr);
}

void Renderer::copyToWindow() {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl_.BlitFramebuffer(0, 0, size_, size_, 0, 0, size_, size_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image Renderer::read() {
  Image image{size_,
              std::vector<float>(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_) * 4)};
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl_.ReadPixels(0, 0, size_, size_, GL_RGBA, GL_FLOAT, image.pixels.data());
  return image;
}

// Unit 0: the volume, unit 1: the transfer function.
void Renderer::createTextures(const Scene& scene) {
  const Eigen::Vector3i size = scene.volume.size;
  createTexture(gl_, GL_TEXTURE0, GL_TEXTURE_3D);
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_R32F, size.x(), size.y(), size.z(), 0, GL_RED, GL_FLOAT,
                 scene.volume.voxels.data());

  constexpr int kEntries = 256;
  if (scene.classification == Classification::preintegrated) {
    createTexture(gl_, GL_TEXTURE1, GL_TEXTURE_2D);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kEntries, kEntries, 0, GL_RGBA, GL_FLOAT,
                   preintegrationTable(scene.transfer, scene.step, kEntries).data());
  } else {
    createTexture(gl_, GL_TEXTURE1, GL_TEXTURE_1D);
    gl_.TexImage1D(GL_TEXTURE_1D, 0, GL_RGBA32F, kEntries, 0, GL_RGBA, GL_FLOAT,
                   postClassificationTable(scene.transfer, kEntries).data());
  }
}

void Renderer::createProgram(const ShaderText& text, const Scene& scene) {
  program_ = gl_.CreateProgram();
  gl_.AttachShader(program_, compile(gl_, GL_VERTEX_SHADER, text.vertex));
  gl_.AttachShader(program_, compile(gl_, GL_FRAGMENT_SHADER, text.fragment));
  if (glsl_ == Glsl::v330) gl_.BindAttribLocation(program_, 0, "vertex");
  gl_.LinkProgram(program_);
  GLint linked = 0;
  gl_.GetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    gl_.GetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("the driver does not link the program: ") + log.c_str());
  }

  const Eigen::Vector3f scale = scene.volume.extent.cwiseInverse().cast<float>();
  gl_.UseProgram(program_);
  gl_.Uniform1i(gl_.GetUniformLocation(program_, "volume"), 0);
  gl_.Uniform1i(gl_.GetUniformLocation(program_, "transferFunction"), 1);
  gl_.Uniform3f(gl_.GetUniformLocation(program_, "scale"), scale.x(), scale.y(), scale.z());
  gl_.Uniform1f(gl_.GetUniformLocation(program_, "stepSize"), static_cast<float>(scene.step));
  const double limit = scene.opacityLimit > 0 ? scene.opacityLimit : 2;  // no opacity gets above 1
  gl_.Uniform1f(gl_.GetUniformLocation(program_, "opacityLimit"), static_cast<float>(limit));
}

void Renderer::createBox(const Eigen::Vector3d& extent) {
  std::array<float, 24> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = (i / 3) >> (i % 3) & 1 ? static_cast<float>(extent[static_cast<int>(i % 3)]) : 0.0F;

  std::array<GLuint, 2> buffers{};
  gl_.GenBuffers(2, buffers.data());
  if (glsl_ == Glsl::v330) {
    GLuint vertexArray = 0;
    gl_.GenVertexArrays(1, &vertexArray);
    gl_.BindVertexArray(vertexArray);
  }
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl_.BufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STATIC_DRAW);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof kBoxIndices, kBoxIndices.data(), GL_STATIC_DRAW);
  if (glsl_ == Glsl::v330) {
    gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl_.EnableVertexAttribArray(0);
  } else {
    gl_.VertexPointer(3, GL_FLOAT, 0, nullptr);
    gl_.EnableClientState(GL_VERTEX_ARRAY);
  }
}

void Renderer::createTarget() {
  const GLuint target = createTexture(gl_, GL_TEXTURE2, GL_TEXTURE_2D);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size_, size_, 0, GL_RGBA, GL_FLOAT, nullptr);
  gl_.GenFramebuffers(1, &framebuffer_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver cannot render into an RGBA32F texture; update it");
}

}  // namespace raycaster
