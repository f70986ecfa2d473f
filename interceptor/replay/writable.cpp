// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/writable.h"

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/replay/uniforms.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;

// Bindings of the active resources of a program interface that has buffers. `most`: the name of the limit.
std::set<GLuint> bufferBindings(const guard::ContextFacts& facts, GLuint program, GLenum interface,
                                GLenum most) {
  std::set<GLuint> bindings;
  GLint count = 0;
  if (!facts.interfaceQueries()) {
    gl().GetIntegerv(most, &count);
    for (GLint i = 0; i < count; ++i) bindings.insert(static_cast<GLuint>(i));
    return bindings;
  }
  gl().GetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  for (GLint i = 0; i < count; ++i) {
    constexpr GLenum kBinding = GL_BUFFER_BINDING;
    GLint binding = 0;
    gl().GetProgramResourceiv(program, interface, static_cast<GLuint>(i), 1, &kBinding, 1, nullptr, &binding);
    bindings.insert(static_cast<GLuint>(binding));
  }
  return bindings;
}

}  // namespace

guard::WritableBindings writableBindings(const guard::ContextFacts& facts, GLuint program) {
  guard::WritableBindings bindings;
  if (facts.atLeast(43, 31) || facts.has("GL_ARB_shader_storage_buffer_object")) {
    bindings.storage =
        bufferBindings(facts, program, GL_SHADER_STORAGE_BLOCK, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  }
  if (facts.atLeast(42, 31) || facts.has("GL_ARB_shader_atomic_counters")) {
    bindings.counters =
        bufferBindings(facts, program, GL_ATOMIC_COUNTER_BUFFER, GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS);
  }
  if (facts.atLeast(42, 31) || facts.has("GL_ARB_shader_image_load_store")) {
    bindings.images = imageUnits(program);
  }
  guard::clearErrors();
  return bindings;
}

}  // namespace shadestep::replay
