// The source text of the program's shaders, as it was when each program was linked.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interceptor/calls/named_strings.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::calls {

// The strings of glShaderSource at a shader's last compile.
struct CompiledSource {
  std::vector<std::string> strings;
  std::string reason;  // why there is no text ("" if there is): SPIR-V, a binary
  // Of a text that may include strings: those that there were, and glCompileShaderIncludeARB's paths.
  std::shared_ptr<const NamedStrings> named_strings;
  std::vector<std::string> search_paths;
};

struct LinkedShader {
  GLuint shader = 0;                             // name at link time; may be gone or reused since
  GLenum type = 0;                               // GL_FRAGMENT_SHADER, ...
  std::shared_ptr<const CompiledSource> source;  // never null
};

// What a program was linked from. Later deletes, detaches and new sources do not change it.
struct LinkedProgram {
  std::vector<LinkedShader> shaders;
  // glBindAttribLocation as it stood at the link: an instrumented copy may have attributes alive that the
  // original link dropped.
  std::vector<std::pair<std::string, GLuint>> attributes;
  std::string
      reason;  // why its shaders are not known ("" if they are): a program binary, made before we looked
};

// Of a program of the current context's share group. Never null.
std::shared_ptr<const LinkedProgram> linkedProgram(GLuint program);

// What the program's last glBeginTransformFeedback in the current context was given; OpenGL cannot be asked.
GLenum feedbackMode();

}  // namespace shadestep::calls
