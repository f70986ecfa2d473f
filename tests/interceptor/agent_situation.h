// What the situations share: a triangle over all pixels, drawn in grey.
#pragma once

#include "agent_scene.h"

#include <GL/osmesa.h>

#include <vector>

namespace situation {

inline constexpr const char* kVertex =
    "#version 330 compatibility\nvoid main() { gl_Position = gl_Vertex; }\n";
inline constexpr const char* kFragment =
    "#version 330 compatibility\nout vec4 color;\nvoid main() { color = vec4(0.5); }\n";

inline constexpr GLfloat kCorners[] = {-1, -1, 3, -1, -1, 3};

// Newer than what libOSMesa exports by name.
template <class Function>
Function opened(const char* name) {
  return reinterpret_cast<Function>(OSMesaGetProcAddress(name));
}

inline GLuint linked(const char* vertex, const std::vector<const char*>& fragments) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, scene::compile(GL_VERTEX_SHADER, {vertex}));
  for (const char* text : fragments) glAttachShader(program, scene::compile(GL_FRAGMENT_SHADER, {text}));
  glLinkProgram(program);
  return program;
}

inline void draw() {
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

inline bool drawnEverywhere() {
  std::vector<GLubyte> pixels(static_cast<std::size_t>(scene::kWidth) * scene::kHeight * 4);
  glReadPixels(0, 0, scene::kWidth, scene::kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  for (const GLubyte value : pixels) {
    if (value != 127 && value != 128) return false;
  }
  return true;
}

// agent_situation_queries.cpp
int activeQueries();
int queriedCondition();
int condition(bool holds);

}  // namespace situation
