// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/context_facts.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/registry/gl_enums.h"

namespace shadestep::guard {
namespace {

int integer(GLenum name) {
  GLint value = 0;
  dispatch::gl().GetIntegerv(name, &value);
  return value;
}

std::string text(GLenum name) {
  const GLubyte* value = dispatch::gl().GetString(name);
  return value != nullptr ? reinterpret_cast<const char*>(value) : "";
}

void readVersion(ContextFacts& facts) {
  const std::string version = text(GL_VERSION);
  facts.es = version.rfind("OpenGL ES", 0) == 0;
  const char* digits = version.c_str() + std::min(version.find_first_of("0123456789"), version.size());
  if (std::sscanf(digits, "%d.%d", &facts.major, &facts.minor) != 2) facts.major = 1;
}

void readExtensions(ContextFacts& facts) {
  const auto& gl = dispatch::gl();
  if (facts.atLeast(30, 30)) {
    const int count = integer(GL_NUM_EXTENSIONS);
    for (int i = 0; i < count; ++i) {
      const GLubyte* name = gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
      if (name != nullptr) facts.extensions.emplace_back(reinterpret_cast<const char*>(name));
    }
    return;
  }
  const std::string all = text(GL_EXTENSIONS);
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find(' ', at), all.size());
    if (end > at) facts.extensions.push_back(all.substr(at, end - at));
    at = end + 1;
  }
}

bool isCore(const ContextFacts& facts) {
  if (facts.es) return false;
  if (facts.atLeast(32, 0)) return (integer(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_CORE_PROFILE_BIT) != 0;
  return facts.atLeast(31, 0) && !facts.has("GL_ARB_compatibility");
}

}  // namespace

bool ContextFacts::has(std::string_view extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

ContextFacts contextFacts() {
  ContextFacts facts;
  readVersion(facts);
  readExtensions(facts);
  facts.core = isCore(facts);
  if (facts.framebufferObjects()) {
    facts.max_draw_buffers = std::min(integer(GL_MAX_DRAW_BUFFERS), integer(GL_MAX_COLOR_ATTACHMENTS));
  }
  if (facts.storageBuffers()) {
    facts.storage_blocks = {integer(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
                            integer(GL_MAX_TESS_CONTROL_SHADER_STORAGE_BLOCKS),
                            integer(GL_MAX_TESS_EVALUATION_SHADER_STORAGE_BLOCKS),
                            integer(GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS),
                            integer(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS),
                            integer(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS)};
    facts.max_storage_bindings = integer(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  }
  return facts;
}

}  // namespace shadestep::guard
