// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/state_digest.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/value_type.h"
#include "interceptor/registry/state_names.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;
using registry::StateName;

// The longest answer is a list of formats; the rest of the room keeps its mark and so shows the answer's
// length.
constexpr std::size_t kRoom = 1024;
constexpr unsigned char kMark = 0xa7;

// What changes by itself, what names the device (Mesa 22.3's OSMesa dies of GL_DEVICE_LUID_EXT), and
// GL_ACTIVE_TEXTURE, which is asked for first.
constexpr std::array kNotAsked = {std::string_view("GL_TIMESTAMP"),     std::string_view("GL_GPU_DISJOINT"),
                                  std::string_view("MEMORY_INFO"),      std::string_view("FREE_MEMORY"),
                                  std::string_view("GL_DEVICE_"),       std::string_view("GL_DRIVER_UUID"),
                                  std::string_view("GL_ACTIVE_TEXTURE")};

bool startsWith(const char* name, std::string_view prefix) {
  return std::string_view(name).substr(0, prefix.size()) == prefix;
}

GLint integer(GLenum name) {
  GLint value = 0;
  gl().GetIntegerv(name, &value);
  return clearErrors() ? 0 : std::clamp(value, 0, 4096);
}

template <class Number>
std::string spell(const std::array<Number, kRoom>& numbers) {
  std::array<Number, 1> mark;
  std::memset(mark.data(), kMark, sizeof mark);
  std::size_t length = numbers.size();
  while (length > 0 && std::memcmp(&numbers[length - 1], mark.data(), sizeof(Number)) == 0) --length;
  std::string text;
  for (std::size_t i = 0; i < length; ++i) {
    char one[40];
    if constexpr (std::is_floating_point_v<Number>) {
      std::snprintf(one, sizeof one, "%s%.*g", i > 0 ? " " : "", sizeof(Number) == 8 ? 17 : 9,
                    static_cast<double>(numbers[i]));
    } else if constexpr (std::is_unsigned_v<Number>) {
      std::snprintf(one, sizeof one, "%s%llu", i > 0 ? " " : "", static_cast<unsigned long long>(numbers[i]));
    } else {
      std::snprintf(one, sizeof one, "%s%lld", i > 0 ? " " : "", static_cast<long long>(numbers[i]));
    }
    text += one;
  }
  return text;
}

class Digest {
 public:
  explicit Digest(const ContextFacts& facts) : facts_(facts) {}

  std::vector<StateValue> take() {
    parameters();
    capabilities();
    textureUnits();
    indexedBindings();
    vertexAttributes();
    framebuffer();
    program();
    queries();
    return std::move(values_);
  }

 private:
  // Asks by `get(numbers)`; keeps the answer unless the driver does not know the question.
  template <class Number, class Get>
  bool ask(const std::string& name, Get get) {
    static std::array<Number, kRoom> numbers;  // one thread at a time stands in a stop
    std::memset(numbers.data(), kMark, sizeof numbers);
    get(numbers.data());
    if (clearErrors()) return false;
    values_.push_back({name, spell(numbers)});
    return true;
  }

  // Integers keep large values exact, floats keep fractions: both are asked for.
  void parameters() {
    gl().GetIntegerv(GL_ACTIVE_TEXTURE, &active_texture_);
    ask<GLint>("GL_ACTIVE_TEXTURE", [](GLint* to) { gl().GetIntegerv(GL_ACTIVE_TEXTURE, to); });
    for (const StateName& one : registry::kParameters) {
      const bool left_out = std::any_of(kNotAsked.begin(), kNotAsked.end(), [&](std::string_view part) {
        return std::string_view(one.name).find(part) != std::string_view::npos;
      });
      if (left_out) continue;
      if (ask<GLint>(one.name, [&](GLint* to) { gl().GetIntegerv(one.value, to); }))
        ask<GLfloat>(one.name, [&](GLfloat* to) { gl().GetFloatv(one.value, to); });
    }
  }

  void capabilities() {
    for (const StateName& one : registry::kCapabilities) {
      ask<GLint>(one.name, [&](GLint* to) { *to = gl().IsEnabled(one.value); });
    }
    const auto indexed = [&](const char* name, GLenum capability, GLint count) {
      for (GLint i = 0; i < count; ++i) {
        ask<GLint>(numbered("", i, name),
                   [&](GLint* to) { *to = gl().IsEnabledi(capability, static_cast<GLuint>(i)); });
      }
    };
    if (facts_.indexedDrawBuffers()) indexed("GL_BLEND", GL_BLEND, integer(GL_MAX_DRAW_BUFFERS));
    if (facts_.viewportArrays()) indexed("GL_SCISSOR_TEST", GL_SCISSOR_TEST, integer(GL_MAX_VIEWPORTS));
  }

  void textureUnits() {
    const GLint units = std::max(integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS), 1);
    for (GLint unit = 0; unit < units; ++unit) {
      gl().ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
      if (clearErrors()) break;
      for (const StateName& one : registry::kParameters) {
        if (!startsWith(one.name, "GL_TEXTURE_BINDING_") && !startsWith(one.name, "GL_SAMPLER_BINDING"))
          continue;
        ask<GLint>(numbered("texture unit", unit, one.name),
                   [&](GLint* to) { gl().GetIntegerv(one.value, to); });
      }
    }
    gl().ActiveTexture(static_cast<GLenum>(active_texture_));
    clearErrors();
  }

  void indexedBindings() {
    struct Indexed {
      const char* name;
      GLenum value, count;
      bool wide;  // offsets and sizes of buffers
    };
    static constexpr Indexed kIndexed[] = {
        {"GL_UNIFORM_BUFFER_BINDING", GL_UNIFORM_BUFFER_BINDING, GL_MAX_UNIFORM_BUFFER_BINDINGS, false},
        {"GL_UNIFORM_BUFFER_START", GL_UNIFORM_BUFFER_START, GL_MAX_UNIFORM_BUFFER_BINDINGS, true},
        {"GL_UNIFORM_BUFFER_SIZE", GL_UNIFORM_BUFFER_SIZE, GL_MAX_UNIFORM_BUFFER_BINDINGS, true},
        {"GL_SHADER_STORAGE_BUFFER_BINDING", GL_SHADER_STORAGE_BUFFER_BINDING,
         GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, false},
        {"GL_SHADER_STORAGE_BUFFER_START", GL_SHADER_STORAGE_BUFFER_START,
         GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, true},
        {"GL_SHADER_STORAGE_BUFFER_SIZE", GL_SHADER_STORAGE_BUFFER_SIZE,
         GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, true},
        {"GL_ATOMIC_COUNTER_BUFFER_BINDING", GL_ATOMIC_COUNTER_BUFFER_BINDING,
         GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS, false},
        {"GL_TRANSFORM_FEEDBACK_BUFFER_BINDING", GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
         GL_MAX_TRANSFORM_FEEDBACK_BUFFERS, false},
        {"GL_IMAGE_BINDING_NAME", GL_IMAGE_BINDING_NAME, GL_MAX_IMAGE_UNITS, false},
        {"GL_IMAGE_BINDING_LEVEL", GL_IMAGE_BINDING_LEVEL, GL_MAX_IMAGE_UNITS, false},
        {"GL_IMAGE_BINDING_LAYER", GL_IMAGE_BINDING_LAYER, GL_MAX_IMAGE_UNITS, false},
        {"GL_IMAGE_BINDING_ACCESS", GL_IMAGE_BINDING_ACCESS, GL_MAX_IMAGE_UNITS, false},
        {"GL_IMAGE_BINDING_FORMAT", GL_IMAGE_BINDING_FORMAT, GL_MAX_IMAGE_UNITS, false},
        {"GL_COLOR_WRITEMASK", GL_COLOR_WRITEMASK, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_SRC_RGB", GL_BLEND_SRC_RGB, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_DST_RGB", GL_BLEND_DST_RGB, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_SRC_ALPHA", GL_BLEND_SRC_ALPHA, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_DST_ALPHA", GL_BLEND_DST_ALPHA, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_EQUATION_RGB", GL_BLEND_EQUATION_RGB, GL_MAX_DRAW_BUFFERS, false},
        {"GL_BLEND_EQUATION_ALPHA", GL_BLEND_EQUATION_ALPHA, GL_MAX_DRAW_BUFFERS, false},
        {"GL_VIEWPORT", GL_VIEWPORT, GL_MAX_VIEWPORTS, false},
        {"GL_SCISSOR_BOX", GL_SCISSOR_BOX, GL_MAX_VIEWPORTS, false},
        {"GL_SAMPLE_MASK_VALUE", GL_SAMPLE_MASK_VALUE, GL_MAX_SAMPLE_MASK_WORDS, false},
    };
    if (!facts_.atLeast(30, 30)) return;
    const bool wide = facts_.atLeast(32, 30);
    for (const Indexed& one : kIndexed) {
      const GLint count = integer(one.count);
      for (GLint i = 0; i < count; ++i) {
        const auto index = static_cast<GLuint>(i);
        const std::string name = numbered("", i, one.name);
        if (one.wide && !wide) continue;
        const bool known =
            one.wide ? ask<GLint64>(name, [&](GLint64* to) { gl().GetInteger64i_v(one.value, index, to); })
                     : ask<GLint>(name, [&](GLint* to) { gl().GetIntegeri_v(one.value, index, to); });
        if (!known) break;
      }
    }
  }

  void vertexAttributes() {
    const GLint count = integer(GL_MAX_VERTEX_ATTRIBS);
    for (GLint i = 0; i < count; ++i) {
      for (const StateName& one : registry::kVertexAttributes) {
        ask<GLfloat>(numbered("vertex attribute", i, one.name),
                     [&](GLfloat* to) { gl().GetVertexAttribfv(static_cast<GLuint>(i), one.value, to); });
      }
    }
  }

  // What the program's framebuffers are made of.
  void framebuffer() {
    if (!facts_.framebufferObjects()) return;
    for (const GLenum target : {GL_DRAW_FRAMEBUFFER, GL_READ_FRAMEBUFFER}) {
      const char* which = target == GL_DRAW_FRAMEBUFFER ? "drawn to," : "read from,";
      for (GLint i = 0; i < integer(GL_MAX_COLOR_ATTACHMENTS); ++i) {
        attachment(which, static_cast<GLenum>(target), GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
      }
      attachment(which, static_cast<GLenum>(target), GL_DEPTH_ATTACHMENT);
      attachment(which, static_cast<GLenum>(target), GL_STENCIL_ATTACHMENT);
    }
  }

  void attachment(const char* which, GLenum target, GLenum point) {
    char name[64];
    for (const GLenum parameter :
         {GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME,
          GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL}) {
      std::snprintf(name, sizeof name, "%s attachment 0x%x, 0x%x", which, point,
                    static_cast<GLenum>(parameter));
      ask<GLint>(name, [&](GLint* to) {
        gl().GetFramebufferAttachmentParameteriv(target, point, static_cast<GLenum>(parameter), to);
      });
    }
  }

  // The current program's uniforms, by location, as what they are; of arrays every element.
  void program() {
    const auto current = static_cast<GLuint>(std::max(program_(), 0));
    if (current == 0) return;
    GLint count = 0;
    gl().GetProgramiv(current, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
      char name[256] = {};
      GLint size = 0;
      GLenum type = 0;
      gl().GetActiveUniform(current, static_cast<GLuint>(i), sizeof name, nullptr, &size, &type, name);
      if (size == 1) uniform(current, name, type);
      const std::string array(std::string_view(name).substr(0, std::string_view(name).rfind('[')));
      for (GLint k = 0; size > 1 && k < size; ++k)
        uniform(current, array + "[" + std::to_string(k) + "]", type);
    }
    clearErrors();
    if (!facts_.subroutines()) return;
    for (const GLenum stage : {GL_VERTEX_SHADER, GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER,
                               GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER}) {
      GLint locations = 0;
      gl().GetProgramStageiv(current, static_cast<GLenum>(stage), GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS,
                             &locations);
      if (clearErrors()) continue;
      for (GLint i = 0; i < locations; ++i) {
        ask<GLint>(numbered("subroutine uniform", i, ""), [&](GLint* to) {
          GLuint index = 0;
          gl().GetUniformSubroutineuiv(static_cast<GLenum>(stage), i, &index);
          *to = static_cast<GLint>(index);
        });
      }
    }
  }

  void uniform(GLuint current, const std::string& name, GLenum type) {
    const GLint location = gl().GetUniformLocation(current, name.c_str());
    if (location < 0) return;
    const ValueType* const known = valueType(type);
    const std::string told = "uniform " + name;
    switch (known != nullptr ? known->scalar : Scalar::int_) {
      case Scalar::float_:
        ask<GLfloat>(told, [&](GLfloat* to) { gl().GetUniformfv(current, location, to); });
        break;
      case Scalar::int_:
        ask<GLint>(told, [&](GLint* to) { gl().GetUniformiv(current, location, to); });
        break;
      case Scalar::uint_:
        ask<GLuint>(told, [&](GLuint* to) { gl().GetUniformuiv(current, location, to); });
        break;
      case Scalar::double_:
        ask<GLdouble>(told, [&](GLdouble* to) { gl().GetUniformdv(current, location, to); });
        break;
      case Scalar::int64_:
        ask<GLint64>(told, [&](GLint64* to) { gl().GetUniformi64vARB(current, location, to); });
        break;
      case Scalar::uint64_:
        ask<GLuint64>(told, [&](GLuint64* to) { gl().GetUniformui64vARB(current, location, to); });
        break;
    }
  }

  static GLint program_() {
    GLint current = 0;
    gl().GetIntegerv(GL_CURRENT_PROGRAM, &current);
    return current;
  }

  void queries() {
    for (const GLenum target :
         {GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED_CONSERVATIVE, GL_TIME_ELAPSED,
          GL_PRIMITIVES_GENERATED, GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN}) {
      ask<GLint>(numbered("current query", static_cast<GLint>(target), ""),
                 [&](GLint* to) { gl().GetQueryiv(static_cast<GLenum>(target), GL_CURRENT_QUERY, to); });
    }
  }

  static std::string numbered(std::string_view before, GLint number, std::string_view after) {
    std::string text(before);
    text += (text.empty() ? "" : " ") + std::to_string(number);
    if (!after.empty()) text += " " + std::string(after);
    return text;
  }

  const ContextFacts& facts_;
  std::vector<StateValue> values_;
  GLint active_texture_ = GL_TEXTURE0;
};

}  // namespace

std::vector<StateValue> stateDigest(const ContextFacts& facts) {
  clearErrors();
  return Digest(facts).take();
}

}  // namespace shadestep::guard
