// Comparing texts of shaders. Blanks do not count.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace shadestep::instrumenter::test {

inline const std::string kHead = "#version 330 core\nin vec2 place;\nout vec4 color;\nuniform int n;\n";

inline std::string squeezed(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
  return text;
}

// The text's part between two of the user's own markers is compared.
inline void expectPart(const std::string& text, const std::string& expected) {
  EXPECT_NE(squeezed(text).find(squeezed(expected)), std::string::npos)
      << "no " << expected << "\nin " << text;
}

}  // namespace shadestep::instrumenter::test
