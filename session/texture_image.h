// What stands in the textures that a draw's fragment shader reads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

struct ShaderTexture {
  SampledTexture facts;
  std::string type;  // of the sampler: "isampler3D"
};
// Of the shader's samplers that the driver kept, in the order of their declaration; those inside of
// structures are left out. Selects the fragment stage for as long as it takes.
std::vector<ShaderTexture> shaderTextures(Session&);

// Slices of a level, as textureImage counts them.
int slicesOf(const SampledTexture&, std::size_t level);

// One level of one texture, a slice or layer of it: what texelFetch gives.
struct TextureImage {
  std::string uniform;
  int level = 0;  // as OpenGL numbers it
  int slice = 0;
  int stride = 1;  // every how manieth texel along each axis is there; 1 unless it is larger than 4,096
  int width = 0, height = 0;         // of the image, in texels that are there
  frontend::Type type;               // of a texel: vec4, ivec4 or uvec4
  std::vector<std::uint32_t> words;  // width*height*4, the row of t = 0 first
  Check check;                       // the texels read in two ways (twice, if they are whole numbers)
};
// Slices of a cube map are its faces, +x, -x, +y, -y, +z, -z, of an array of them six of each; of a
// multisampled texture its samples, of an array of them each layer's; of a buffer there is one row. What a
// sampler compares with is shown as it stands in the texture. Throws cannot_debug for levels of a cube map
// whose filter does not reach them, and where texelFetch, sampler objects (for cube maps and comparing
// samplers) or a target of floats is missing; nothing_matches where there is no such texture, level or slice.
TextureImage textureImage(Session&, const std::string& uniform, int level, int slice);

}  // namespace shadestep::session
