// Whether two draws left the same behind, bit for bit, buffer by buffer.
// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace shadestep::guard {

// What a component is: then it can be said how far two of them are apart.
enum class Number : unsigned char {
  unknown,
  real,
  fraction,  // unsigned, of 2^32 - 1
  signed_integer,
  unsigned_integer,
  double_real,  // two words, of which the second is ...
  second_word,
};

// One buffer of what a draw leaves behind, as it lies in memory after it was read.
struct Section {
  std::string name;  // "draw buffer 0", "image unit 2"
  std::size_t bytes = 0;
  std::size_t word = 4;              // bytes that make one component
  std::uint64_t components = 0;      // that count: what a format lacks is read as constants
  bool output = false;               // of the shader's outputs, which it may leave undefined
  std::vector<Number> numbers = {};  // what the words are, over and over from the first on; none: unknown
};

// Where two readings of a section differ.
struct Difference {
  std::uint64_t components = 0;
  bool told = true;  // all of them are numbers
  // Of those that are, the two that are farthest apart: by `by`, at least 0, infinite where one is not
  // finite.
  double by = -1.0, before = 0.0, now = 0.0;

  void note(Number, const std::byte* before, const std::byte* now);
  void add(const Difference&);
};

std::size_t totalBytes(const std::vector<Section>&);

// By components of `word` bytes.
Difference difference(const std::vector<Number>&, const std::byte* before, const std::byte* now,
                      std::size_t bytes, std::size_t word);
// One for each section.
std::vector<Difference> differences(const std::vector<Section>&, const std::byte* before,
                                    const std::byte* now);

}  // namespace shadestep::guard
