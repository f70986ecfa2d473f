#include "leaping.h"

namespace raycaster {

LeapingRenderer::LeapingRenderer(const Gl& gl, const Scene& scene, const Permutation& permutation, int size,
                                 const Care& care)
    : gl_(gl),
      permutation_(permutation),
      size_(size),
      care_(care),
      objects_(gl_),
      box_(gl_, objects_, permutation.glsl),
      points_(gl_, objects_, permutation.glsl) {
  permutation_.leaping = true;
  createSceneTextures(gl_, objects_, scene);
  setBox(box_, scene.volume.extent);
  std::vector<float> pixels;
  std::vector<unsigned> indices;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      indices.push_back(static_cast<unsigned>(indices.size()));
      for (const double component : {(x + 0.5) / size, (y + 0.5) / size, 0.0})
        pixels.push_back(static_cast<float>(component));
    }
  points_.set(pixels, indices);

  const GLuint colour = objects_.image(GL_TEXTURE2, colourFormat(scene.targetBits), size);
  hits_ = objects_.image(GL_TEXTURE3, GL_RGBA32F, size);
  target_ = objects_.framebuffer({colour, hits_});
  start_ = objects_.image(GL_TEXTURE4, GL_RGBA32F, size);
  startTarget_ = objects_.framebuffer({start_}, true, size);

  rays_ = objects_.program(shaderText(permutation_));
  setSceneUniforms(gl_, rays_, scene);
  setUniform(gl_, rays_, "start", 4);
  setUniform(gl_, rays_, "pixel", 1.0 / size);
  setUniform(gl_, rays_, "margin", care.margin);
  reprojection_ = objects_.program(reprojectionText(permutation.glsl));
  setUniform(gl_, reprojection_, "hits", 3);
  gl_.CullFace(GL_BACK);
  gl_.Viewport(0, 0, size_, size_);
}

void LeapingRenderer::draw(const Camera& camera) {
  reproject(camera);
  gl_.UseProgram(rays_);
  setMatrix(gl_, permutation_.glsl, rays_, camera.modelViewProjection());
  setUniform(gl_, rays_, "camera", camera.position());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.Enable(GL_CULL_FACE);
  box_.draw();
  known_ = true;
}

void LeapingRenderer::reproject(const Camera& camera) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, startTarget_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (!known_) return;
  gl_.UseProgram(reprojection_);
  setMatrix(gl_, permutation_.glsl, reprojection_, camera.modelViewProjection());
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.PointSize(care_.splat);
  points_.draw(GL_POINTS);
  gl_.Disable(GL_DEPTH_TEST);
}

void LeapingRenderer::copyToWindow() {
  copyFramebuffer(gl_, target_, size_);
}

Image LeapingRenderer::read() {
  return readImage(gl_, target_, size_);
}

}  // namespace raycaster
