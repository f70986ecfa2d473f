// Values as 32-bit words: the GLSL expressions that make them. Order and count follow frontend::components.
#pragma once

#include <string>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// `expression`, of this type, as GLSL expressions of type uint, a word each.
std::vector<std::string> uintWords(const Draft& draft, const std::string& expression,
                                   const frontend::Type& type);
// The same of type int; needs no uint, so it works in every dialect that has floatBitsToInt.
std::vector<std::string> intWords(const Draft& draft, const std::string& expression,
                                  const frontend::Type& type);
// The same as expressions of type float, a channel each: floats as they are, other words as two halves of 16
// bits, low half first. Below GLSL 1.30 they call the functions of helpers/attachment_halves.glsl.
std::vector<std::string> floatChannels(const Draft& draft, const std::string& expression,
                                       const frontend::Type& type);
// Number of floatChannels of a type.
int channelCount(const frontend::Type& type);

// Declares what uintWords and intWords call and the dialect lacks.
void prepareWords(Draft& draft);

}  // namespace shadestep::instrumenter
