#include "spectral_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kubelka_munk.h"
#include "renderer.h"

namespace raycaster {
namespace {

constexpr std::size_t kLanes = 4;
constexpr std::size_t kRows = 4;

// The rows of the medium's table for the wavelengths of a pass: two as the shader's storage wants them, the
// index, and how it grows with the scalar.
std::vector<float> mediumTable(const SpectralScene& scene, const std::vector<SpectralBin>& bins) {
  const auto n = static_cast<std::size_t>(scene.tableSize);
  std::vector<float> texels(n * kRows * 4, 0.0F);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t lane = 0; lane < bins.size(); ++lane) {
      const double scalar = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      const OpticalProperties at = scene.medium.at(scalar, bins[lane].wavelength);
      const Layer whole = layer(at.absorption, at.scattering, scene.step);
      const double first = scene.storage == Storage::coefficients    ? at.absorption
                           : scene.storage == Storage::transmittance ? whole.t
                                                                     : 1 - whole.t;
      const double second = scene.storage == Storage::coefficients ? at.scattering : whole.r;
      constexpr double kSmall = 1e-4;
      const double slope = (scene.medium.at(scalar + kSmall, bins[lane].wavelength).index -
                            scene.medium.at(scalar - kSmall, bins[lane].wavelength).index) /
                           (2 * kSmall);
      for (const auto& [row, value] :
           {std::pair<std::size_t, double>{0, first}, {1, second}, {2, at.index}, {3, slope}})
        texels[4 * (row * n + i) + lane] = static_cast<float>(value);
    }
  return texels;
}

}  // namespace

SpectralPermutation permutationFor(const SpectralScene& scene, Glsl glsl) {
  return {.glsl = glsl,
          .storage = scene.storage,
          .scattering = scene.medium.scatters(),
          .refraction = scene.medium.refracts()};
}

SpectralRenderer::SpectralRenderer(const Gl& gl, const SpectralScene& scene,
                                   const SpectralPermutation& permutation, int size)
    : SpectralRenderer(gl, scene, permutation, size, shaderText(permutation)) {}

SpectralRenderer::SpectralRenderer(const Gl& gl, const SpectralScene& scene,
                                   const SpectralPermutation& permutation, int size, const ShaderText& text)
    : gl_(gl),
      permutation_(permutation),
      size_(size),
      extent_(scene.volume.extent),
      backdrop_(scene.backdrop),
      objects_(gl_),
      mesh_(gl_, objects_, permutation.glsl) {
  createVolumeTexture(gl_, objects_, scene.volume);
  createMedium(scene, spectralBins(scene.wavelengths, "/usr/share/colord",
                                   scene.printedMatrix ? kPrintedXyzToRgb : kXyzToRgb));
  program_ = objects_.program(text);
  setUniform(gl_, program_, "volume", 0);
  setUniform(gl_, program_, "medium", 1);
  setUniform(gl_, program_, "scale", extent_.cwiseInverse());
  setUniform(gl_, program_, "stepSize", scene.step);
  setUniform(gl_, program_, "voxel", scene.volume.size.cast<double>().cwiseInverse());
  setUniform(gl_, program_, "longest", static_cast<int>(std::min(65000.0, 4 * extent_.norm() / scene.step)));
  framebuffer_ = objects_.framebuffer({objects_.image(GL_TEXTURE2, GL_RGBA32F, size)});
  gl_.Viewport(0, 0, size_, size_);
}

void SpectralRenderer::createMedium(const SpectralScene& scene, const std::vector<SpectralBin>& bins) {
  const std::size_t lanes = scene.medium.disperses() ? 1 : kLanes;
  for (std::size_t first = 0; first < bins.size(); first += lanes) {
    const auto begin = bins.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<SpectralBin> batch(
        begin, begin + static_cast<std::ptrdiff_t>(std::min(lanes, bins.size() - first)));
    passes_.push_back({objects_.texture(GL_TEXTURE1, GL_TEXTURE_2D), batch});
    gl_.TexImage2D(GL_TEXTURE_2D, 0, colourFormat(scene.tableBits), scene.tableSize, kRows, 0, GL_RGBA,
                   GL_FLOAT, mediumTable(scene, batch).data());
  }
}

void SpectralRenderer::draw(const Camera& camera) {
  const BackdropPlane plane(backdrop_, camera, extent_);
  setView(mesh_, camera);
  gl_.UseProgram(program_);
  setMatrix(gl_, permutation_.glsl, program_, camera.modelViewProjection());
  setUniform(gl_, program_, "camera", camera.position());
  setUniform(gl_, program_, "backdropOrigin", plane.origin);
  setUniform(gl_, program_, "backdropRight", plane.right);
  setUniform(gl_, program_, "backdropUp", plane.up);
  setUniform(gl_, program_, "backdropPattern",
             Eigen::Vector3d(plane.pattern.mean, plane.pattern.amplitude, plane.pattern.frequency));
  setUniform(gl_, program_, "share", 1.0 / static_cast<double>(passes_.size()));

  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_ONE, GL_ONE);
  constexpr std::array<const char*, kLanes> kWeights = {"weight0", "weight1", "weight2", "weight3"};
  for (const Pass& pass : passes_) {
    gl_.ActiveTexture(GL_TEXTURE1);
    gl_.BindTexture(GL_TEXTURE_2D, pass.medium);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      setUniform(gl_, program_, kWeights[lane],
                 lane < pass.bins.size() ? pass.bins[lane].weight : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    mesh_.draw();
  }
  gl_.Disable(GL_BLEND);
}

void SpectralRenderer::copyToWindow() {
  copyFramebuffer(gl_, framebuffer_, size_);
}

Image SpectralRenderer::read() {
  return readImage(gl_, framebuffer_, size_);
}

}  // namespace raycaster
