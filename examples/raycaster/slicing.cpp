#include "slicing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace raycaster {
namespace {

using Eigen::Vector3d;

Vector3d corner(const Vector3d& extent, int number) {
  return {number & 1 ? extent.x() : 0, number & 2 ? extent.y() : 0, number & 4 ? extent.z() : 0};
}

}  // namespace

std::vector<Vector3d> slicePolygon(const Camera& camera, const Vector3d& extent, double distance) {
  std::vector<Vector3d> corners;
  const auto ahead = [&](const Vector3d& place) { return (place - camera.position()).dot(camera.forward()); };
  for (int from = 0; from < 8; ++from)
    for (int axis = 1; axis < 8; axis *= 2) {
      const int to = from | axis;
      if (to == from) continue;
      const Vector3d a = corner(extent, from), b = corner(extent, to);
      const double da = ahead(a) - distance, db = ahead(b) - distance;
      if ((da < 0) != (db < 0)) corners.push_back(a + da / (da - db) * (b - a));
    }
  if (corners.size() < 3) return {};
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& one : corners) middle += one / static_cast<double>(corners.size());
  const Vector3d right = (corners[0] - middle).normalized(), up = camera.forward().cross(right);
  const auto angle = [&](const Vector3d& one) {
    return std::atan2((one - middle).dot(up), (one - middle).dot(right));
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Vector3d& a, const Vector3d& b) { return angle(a) < angle(b); });
  return corners;
}

SlicingRenderer::SlicingRenderer(const Gl& gl, const Scene& scene, const Permutation& permutation, int size)
    : gl_(gl),
      permutation_(permutation),
      size_(size),
      extent_(scene.volume.extent),
      step_(scene.step),
      objects_(gl_),
      mesh_(gl_, objects_, permutation.glsl) {
  createSceneTextures(gl_, objects_, scene);
  program_ = objects_.program(sliceText(permutation));
  setSceneUniforms(gl_, program_, scene);
  framebuffer_ = objects_.framebuffer({objects_.image(GL_TEXTURE2, colourFormat(scene.targetBits), size)});
  gl_.Viewport(0, 0, size_, size_);
}

void SlicingRenderer::draw(const Camera& camera) {
  double nearest = 1e300, farthest = 0;
  for (int number = 0; number < 8; ++number) {
    const double distance = (corner(extent_, number) - camera.position()).dot(camera.forward());
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  gl_.UseProgram(program_);
  setMatrix(gl_, permutation_.glsl, program_, camera.modelViewProjection());
  setUniform(gl_, program_, "camera", camera.position());
  setUniform(gl_, program_, "forward", camera.forward());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  if (permutation_.counting)
    gl_.BlendFunc(GL_ONE, GL_ONE);
  else
    gl_.BlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);  // front to back
  for (double distance = std::max(nearest, 0.0) + step_ / 2; distance < farthest; distance += step_) {
    const std::vector<Vector3d> polygon = slicePolygon(camera, extent_, distance);
    std::vector<float> corners;
    std::vector<unsigned> indices;
    for (const Vector3d& one : polygon)
      for (const double component : one) corners.push_back(static_cast<float>(component));
    for (unsigned i = 2; i < polygon.size(); ++i) indices.insert(indices.end(), {0, i - 1, i});
    if (indices.empty()) continue;
    mesh_.set(corners, indices);
    mesh_.draw();
  }
  gl_.Disable(GL_BLEND);
}

void SlicingRenderer::copyToWindow() {
  copyFramebuffer(gl_, framebuffer_, size_);
}

Image SlicingRenderer::read() {
  return readImage(gl_, framebuffer_, size_);
}

}  // namespace raycaster
