// Values as text: exact, as GLSL writes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "instrumenter/instrumenter.h"

namespace shadestep::session {

// One component: floats with the fewest digits that parse back to the same bits; "NaN", "Infinity",
// "-Infinity". `words` points at one word, or two (low first) for 64-bit types.
std::string formatComponent(frontend::Basic basic, const std::uint32_t* words);

// A whole value: "0.5", "vec3(0.1, 2, -3)", "mat2(1, 0, 0, 1)", "float[2](1, 2)", "Light(vec3(...), 2)".
std::string formatValue(const instrumenter::Value& value);

// The value of a component as a double: exact for everything but 64-bit integers beyond 2^53.
// NaN and infinities stay what they are.
double componentAsDouble(frontend::Basic basic, const std::uint32_t* words);

// For a float, the double that prints shortest and still parses back to the same float.
double shortestDouble(float value);

int wordsPerComponent(frontend::Basic basic);

}  // namespace shadestep::session
