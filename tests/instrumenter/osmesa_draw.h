// One triangle over a 16 x 16 target, drawn by OSMesa with a fragment shader under test. What the agent does
// inside a program, in the smallest form.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "shaders.h"

namespace shadestep::instrumenter::test {

inline constexpr int kSize = 16;
inline constexpr int kPixels = kSize * kSize;

struct Uniform {
  frontend::Type type;
  std::vector<std::uint32_t> words;
};

struct DrawRequest {
  std::string text;                       // fragment shader
  std::string vertex_text;                // "" = one that gives `vec2 place` in [0, 1]
  std::vector<std::string> user_outputs;  // bound to locations 0...
  int color_buffers = 1;
  AttachmentLayout capture{Carrier::uint_attachments, 0, {}, {}, {}, 0, {}, 0, {}};  // words = 0: none
  std::string storage_block;
  std::vector<std::uint32_t> storage;
  std::map<std::string, Uniform> uniforms;
};

// Rows from the bottom up.
struct DrawResult {
  std::string error;                                // compiler's or linker's log
  std::vector<std::vector<std::uint32_t>> outputs;  // per colour buffer 4 words a pixel (floats' bits)
  std::vector<std::vector<std::uint32_t>>
      captured;  // per pixel capture.words words, of discarded threads too
  std::vector<std::uint32_t> storage;
};

DrawResult draw(Profile, const DrawRequest&);

}  // namespace shadestep::instrumenter::test
