// A fragment shader and the same computation in C++: the values of every pixel at one line, by probes, and of
// one pixel by a recording, must be those.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "launch.h"

namespace shadestep::test {

struct ShaderCase {
  std::string name;
  std::string shader;                                     // `//LAST` marks the line that is looked at
  std::vector<std::string> watches;                       // scalars
  std::function<std::vector<double>(int, int)> expected;  // of the watches, at a pixel
};

inline void PrintTo(const ShaderCase& one, std::ostream* out) {
  *out << one.name;
}

// `program` (of tests/programs) draws with the shader in a file over all of a 16 x 16 target. Under the
// debugger it must also say what it says alone.
void expectValuesOf(const ShaderCase&, const std::string& program);

// The steps of the thread on a pixel.
Json stepsOf(const Scratch&, const std::string& shader, const std::string& program, const std::string& pixel);

}  // namespace shadestep::test
