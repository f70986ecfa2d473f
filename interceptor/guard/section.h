// Whether two draws left the same behind, bit for bit, buffer by buffer.
// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace shadestep::guard {

// One buffer of what a draw leaves behind, as it lies in memory after it was read.
struct Section {
  std::string name;  // "draw buffer 0", "image unit 2"
  std::size_t bytes = 0;
  std::size_t word = 4;          // bytes that make one component
  std::uint64_t components = 0;  // that count: what a format lacks is read as constants
  bool color = false;            // a colour buffer of the draw
};

std::size_t totalBytes(const std::vector<Section>&);

// How many components of `word` bytes differ.
std::uint64_t differing(const std::byte* a, const std::byte* b, std::size_t bytes, std::size_t word);
// The same of sections, a number for each.
std::vector<std::uint64_t> differences(const std::vector<Section>&, const std::byte* a, const std::byte* b);

}  // namespace shadestep::guard
