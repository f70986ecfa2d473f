#include "renderer.h"

#include "oracle.h"

#include <stdexcept>

namespace raycaster {
namespace {

constexpr double kLongestSlab = 256;  // steps that adaptive sampling may make one

}  // namespace

Permutation permutationFor(const Scene& scene, Glsl glsl, const Camera& camera) {
  return {.glsl = glsl,
          .classification = scene.classification,
          .inside = !camera.outside(),
          .adaptive = scene.adaptiveTolerance > 0 && camera.outside()};
}

Renderer::Renderer(const Gl& gl, const Scene& scene, const Permutation& permutation, int size)
    : Renderer(gl, scene, permutation, size, shaderText(permutation)) {}

Renderer::Renderer(const Gl& gl, const Scene& scene, const Permutation& permutation, int size,
                   const ShaderText& text)
    : gl_(gl), permutation_(permutation), size_(size), objects_(gl_), mesh_(gl_, objects_, permutation.glsl) {
  createSceneTextures(gl_, objects_, scene);
  program_ = objects_.program(text);
  setSceneUniforms(gl_, program_, scene);
  if (permutation.adaptive) createOracle(scene);
  setBox(mesh_, scene.volume.extent);
  framebuffer_ = objects_.framebuffer({objects_.image(GL_TEXTURE2, colourFormat(scene.targetBits), size)});
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(GL_BACK);
  gl_.Viewport(0, 0, size_, size_);
  if (gl_.GetError() != GL_NO_ERROR)
    throw std::runtime_error("the driver refuses float textures of this size; try a smaller --size");
}

void Renderer::draw(const Camera& camera) {
  if (permutation_.inside) setView(mesh_, camera);
  gl_.UseProgram(program_);
  setMatrix(gl_, permutation_.glsl, program_, camera.modelViewProjection());
  setUniform(gl_, program_, "camera", camera.position());

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  mesh_.draw();
}

void Renderer::createOracle(const Scene& scene) {
  const Eigen::Vector3i size = scene.volume.size;
  const std::vector<float> distances =
      samplingDistances(scene.volume, scene.transfer, scene.adaptiveTolerance);
  objects_.texture(GL_TEXTURE5, GL_TEXTURE_3D);
  gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_R32F, size.x(), size.y(), size.z(), 0, GL_RED, GL_FLOAT,
                 distances.data());
  setUniform(gl_, program_, "oracle", 5);
  setUniform(gl_, program_, "longestSlab", kLongestSlab);
}

void Renderer::copyToWindow() {
  copyFramebuffer(gl_, framebuffer_, size_);
}

Image Renderer::read() {
  return readImage(gl_, framebuffer_, size_);
}

void setView(Mesh& mesh, const Camera& camera) {
  std::vector<float> corners;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    const Eigen::Vector3d corner = camera.corner(x, y);
    for (const double component : corner) corners.push_back(static_cast<float>(component));
  }
  mesh.set(corners, {0, 1, 2, 0, 2, 3});
}

void createVolumeTexture(const Gl& gl, Objects& objects, const Volume& volume) {
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  objects.texture(GL_TEXTURE0, GL_TEXTURE_3D);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_R32F, volume.size.x(), volume.size.y(), volume.size.z(), 0, GL_RED,
                GL_FLOAT, volume.voxels.data());
}

void createSceneTextures(const Gl& gl, Objects& objects, const Scene& scene) {
  createVolumeTexture(gl, objects, scene.volume);
  const int n = scene.tableSize;
  const GLint format = colourFormat(scene.tableBits);
  const std::vector<float> table = classificationTable(scene.transfer, scene.classification, scene.step, n);
  if (scene.classification == Classification::post) {
    objects.texture(GL_TEXTURE1, GL_TEXTURE_1D);
    gl.TexImage1D(GL_TEXTURE_1D, 0, format, n, 0, GL_RGBA, GL_FLOAT, table.data());
  } else {
    objects.texture(GL_TEXTURE1, GL_TEXTURE_2D);
    gl.TexImage2D(GL_TEXTURE_2D, 0, format, n, n, 0, GL_RGBA, GL_FLOAT, table.data());
  }
}

void setSceneUniforms(const Gl& gl, GLuint program, const Scene& scene) {
  setUniform(gl, program, "volume", 0);
  setUniform(gl, program, "transferFunction", 1);
  setUniform(gl, program, "scale", scene.volume.extent.cwiseInverse());
  setUniform(gl, program, "stepSize", scene.step);
  setUniform(gl, program, "opacityLimit",
             scene.opacityLimit > 0 ? scene.opacityLimit : 2);  // none gets above 1
}

void copyFramebuffer(const Gl& gl, GLuint framebuffer, int size) {
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl.BlitFramebuffer(0, 0, size, size, 0, 0, size, size, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image readImage(const Gl& gl, GLuint framebuffer, int size) {
  Image image{size, std::vector<float>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 4)};
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  gl.ReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, image.pixels.data());
  return image;
}

}  // namespace raycaster
