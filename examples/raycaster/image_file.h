// Writing a square float image to a file, whole or not at all.
#pragma once

#include <string>
#include <vector>

namespace raycaster {

// RGBA, premultiplied, rows from the bottom up (OpenGL's order).
struct Image {
  int size = 0;
  std::vector<float> pixels;
};

// By the name's ending: .png (8 bits, over a dark background, no gamma applied), .exr (float RGBA, exact) or
// .raw (the floats as they are, rows from the bottom up). Throws std::runtime_error with a sentence for the
// user.
void write(const Image&, const std::string& path);

// Whether write() knows the name's ending.
bool canWrite(const std::string& path);

}  // namespace raycaster
