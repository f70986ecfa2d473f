// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/uniforms.h"

#include <algorithm>
#include <array>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/texture_level.h"
#include "interceptor/guard/value_type.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;
using guard::Scalar;
using guard::ValueType;

// Samplers and images, whose types are many, are set as one int: the unit.
constexpr ValueType kOpaque{0, Scalar::int_, 1, 1};

const ValueType& uniformType(GLenum type) {
  const ValueType* known = guard::valueType(type);
  return known != nullptr ? *known : kOpaque;
}

using Words = std::array<std::uint32_t, 32>;  // the largest: dmat4

void get(GLuint program, GLint location, const ValueType& type, Words& words) {
  void* into = words.data();
  switch (type.scalar) {
    case Scalar::float_:
      gl().GetUniformfv(program, location, static_cast<GLfloat*>(into));
      break;
    case Scalar::int_:
      gl().GetUniformiv(program, location, static_cast<GLint*>(into));
      break;
    case Scalar::uint_:
      gl().GetUniformuiv(program, location, static_cast<GLuint*>(into));
      break;
    case Scalar::double_:
      gl().GetUniformdv(program, location, static_cast<GLdouble*>(into));
      break;
    case Scalar::int64_:
      gl().GetUniformi64vARB(program, location, static_cast<GLint64*>(into));
      break;
    case Scalar::uint64_:
      gl().GetUniformui64vARB(program, location, static_cast<GLuint64*>(into));
      break;
  }
}

template <class Value, class... Setters>
void setVector(int rows, GLint location, GLsizei count, const void* words, Setters... setters) {
  using Setter = void (*)(GLint, GLsizei, const Value*);
  const Setter by_rows[] = {setters...};
  by_rows[rows - 1](location, count, static_cast<const Value*>(words));
}

template <class Value, class Setter>
void setMatrix(Setter setter, GLint location, GLsizei count, const void* words) {
  setter(location, count, GL_FALSE, static_cast<const Value*>(words));
}

void setFloatMatrix(const ValueType& type, GLint location, GLsizei count, const void* words) {
  const auto& table = gl();
  const decltype(table.UniformMatrix2fv) setters[3][3] = {
      {table.UniformMatrix2fv, table.UniformMatrix2x3fv, table.UniformMatrix2x4fv},
      {table.UniformMatrix3x2fv, table.UniformMatrix3fv, table.UniformMatrix3x4fv},
      {table.UniformMatrix4x2fv, table.UniformMatrix4x3fv, table.UniformMatrix4fv}};
  setMatrix<GLfloat>(setters[type.columns - 2][type.rows - 2], location, count, words);
}

void setDoubleMatrix(const ValueType& type, GLint location, GLsizei count, const void* words) {
  const auto& table = gl();
  const decltype(table.UniformMatrix2dv) setters[3][3] = {
      {table.UniformMatrix2dv, table.UniformMatrix2x3dv, table.UniformMatrix2x4dv},
      {table.UniformMatrix3x2dv, table.UniformMatrix3dv, table.UniformMatrix3x4dv},
      {table.UniformMatrix4x2dv, table.UniformMatrix4x3dv, table.UniformMatrix4dv}};
  setMatrix<GLdouble>(setters[type.columns - 2][type.rows - 2], location, count, words);
}

// `words`: aligned for 64 bits.
void set(const ValueType& type, GLint location, GLsizei count, const void* words) {
  const auto& table = gl();
  const bool matrix = type.columns > 1;
  switch (type.scalar) {
    case Scalar::float_:
      if (matrix) return setFloatMatrix(type, location, count, words);
      return setVector<GLfloat>(type.rows, location, count, words, table.Uniform1fv, table.Uniform2fv,
                                table.Uniform3fv, table.Uniform4fv);
    case Scalar::int_:
      return setVector<GLint>(type.rows, location, count, words, table.Uniform1iv, table.Uniform2iv,
                              table.Uniform3iv, table.Uniform4iv);
    case Scalar::uint_:
      return setVector<GLuint>(type.rows, location, count, words, table.Uniform1uiv, table.Uniform2uiv,
                               table.Uniform3uiv, table.Uniform4uiv);
    case Scalar::double_:
      if (matrix) return setDoubleMatrix(type, location, count, words);
      return setVector<GLdouble>(type.rows, location, count, words, table.Uniform1dv, table.Uniform2dv,
                                 table.Uniform3dv, table.Uniform4dv);
    case Scalar::int64_:
      return setVector<GLint64>(type.rows, location, count, words, table.Uniform1i64vARB,
                                table.Uniform2i64vARB, table.Uniform3i64vARB, table.Uniform4i64vARB);
    case Scalar::uint64_:
      return setVector<GLuint64>(type.rows, location, count, words, table.Uniform1ui64vARB,
                                 table.Uniform2ui64vARB, table.Uniform3ui64vARB, table.Uniform4ui64vARB);
  }
}

struct ActiveUniform {
  std::string name;  // of an array: with its "[0]"
  GLint size = 0;
  GLenum type = 0;
};

ActiveUniform activeUniform(GLuint program, GLuint index, std::vector<GLchar>& buffer) {
  ActiveUniform uniform;
  GLsizei length = 0;
  gl().GetActiveUniform(program, index, static_cast<GLsizei>(buffer.size()), &length, &uniform.size,
                        &uniform.type, buffer.data());
  uniform.name.assign(buffer.data(), static_cast<std::size_t>(length));
  return uniform;
}

// "a[0]" and 3 -> "a[3]"; what is no array has one element, itself.
std::string elementName(const ActiveUniform& uniform, GLint element) {
  const bool array = uniform.name.size() > 3 && uniform.name.compare(uniform.name.size() - 3, 3, "[0]") == 0;
  if (!array) return element == 0 ? uniform.name : uniform.name + "[" + std::to_string(element) + "]";
  return uniform.name.substr(0, uniform.name.size() - 2) + std::to_string(element) + "]";
}

void copyDefaultBlock(const guard::ContextFacts& facts, GLuint original, GLuint copy) {
  GLint count = 0;
  GLint longest = 0;
  gl().GetProgramiv(copy, GL_ACTIVE_UNIFORMS, &count);
  gl().GetProgramiv(copy, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::vector<GLchar> buffer(static_cast<std::size_t>(longest) + 1);
  for (GLint i = 0; i < count; ++i) {
    const ActiveUniform uniform = activeUniform(copy, static_cast<GLuint>(i), buffer);
    for (GLint element = 0; element < uniform.size; ++element) {
      const std::string name = elementName(uniform, element);
      const GLint from = gl().GetUniformLocation(original, name.c_str());
      const GLint to = gl().GetUniformLocation(copy, name.c_str());
      if (from < 0 || to < 0) continue;  // built-in, in a block, or not alive in the original
      if (facts.es && guard::isImageType(uniform.type)) continue;  // ES: fixed by the shader's text
      const ValueType& type = uniformType(uniform.type);
      alignas(8) Words words{};
      get(original, from, type, words);
      set(type, to, 1, words.data());
    }
  }
}

void copyUniformBlocks(GLuint original, GLuint copy) {
  GLint count = 0;
  gl().GetProgramiv(copy, GL_ACTIVE_UNIFORM_BLOCKS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLint length = 0;
    gl().GetActiveUniformBlockiv(copy, i, GL_UNIFORM_BLOCK_NAME_LENGTH, &length);
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    gl().GetActiveUniformBlockName(copy, i, length, nullptr, name.data());
    const GLuint index = gl().GetUniformBlockIndex(original, name.c_str());
    if (index == GL_INVALID_INDEX) continue;
    GLint binding = 0;
    gl().GetActiveUniformBlockiv(original, index, GL_UNIFORM_BLOCK_BINDING, &binding);
    gl().UniformBlockBinding(copy, i, static_cast<GLuint>(binding));
  }
}

void copyStorageBlocks(const guard::ContextFacts& facts, GLuint original, GLuint copy) {
  if (!dispatch::available("glShaderStorageBlockBinding") || facts.es) return;  // fixed by the shader's text
  GLint count = 0;
  GLint longest = 0;
  gl().GetProgramInterfaceiv(copy, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
  gl().GetProgramInterfaceiv(copy, GL_SHADER_STORAGE_BLOCK, GL_MAX_NAME_LENGTH, &longest);
  std::vector<GLchar> name(static_cast<std::size_t>(longest) + 1);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    gl().GetProgramResourceName(copy, GL_SHADER_STORAGE_BLOCK, i, static_cast<GLsizei>(name.size()), nullptr,
                                name.data());
    const GLuint index = gl().GetProgramResourceIndex(original, GL_SHADER_STORAGE_BLOCK, name.data());
    if (index == GL_INVALID_INDEX) continue;
    constexpr GLenum kBinding = GL_BUFFER_BINDING;
    GLint binding = 0;
    gl().GetProgramResourceiv(original, GL_SHADER_STORAGE_BLOCK, index, 1, &kBinding, 1, nullptr, &binding);
    gl().ShaderStorageBlockBinding(copy, i, static_cast<GLuint>(binding));
  }
}

}  // namespace

void copyUniforms(const guard::ContextFacts& facts, GLuint original, GLuint copy) {
  gl().UseProgram(copy);
  copyDefaultBlock(facts, original, copy);
  if (facts.uniformBlocks()) copyUniformBlocks(original, copy);
  if (facts.storageBuffers()) copyStorageBlocks(facts, original, copy);
}

std::string setUniforms(GLuint program, const std::vector<std::unique_ptr<wire::UniformValueT>>& values) {
  for (const auto& value : values) {
    const ValueType& type = uniformType(value->gl_type);
    const std::size_t words = static_cast<std::size_t>(type.words());
    if (value->words.empty() || value->words.size() % words != 0) {
      return "the uniform " + value->name + " needs a multiple of " + std::to_string(words) + " words, not " +
             std::to_string(value->words.size());
    }
    const GLint location = gl().GetUniformLocation(program, value->name.c_str());
    if (location < 0) continue;
    set(type, location, static_cast<GLsizei>(value->words.size() / words), value->words.data());
  }
  return "";
}

std::vector<std::unique_ptr<wire::ActiveUniformT>> activeUniforms(GLuint program) {
  std::vector<std::unique_ptr<wire::ActiveUniformT>> uniforms;
  GLint count = 0;
  GLint longest = 0;
  gl().GetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  gl().GetProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::vector<GLchar> buffer(static_cast<std::size_t>(longest) + 1);
  for (GLint i = 0; i < count; ++i) {
    ActiveUniform uniform = activeUniform(program, static_cast<GLuint>(i), buffer);
    auto told = std::make_unique<wire::ActiveUniformT>();
    told->name = std::move(uniform.name);
    told->size = uniform.size;
    uniforms.push_back(std::move(told));
  }
  return uniforms;
}

std::set<GLuint> imageUnits(GLuint program) {
  std::set<GLuint> units;
  GLint count = 0;
  GLint longest = 0;
  gl().GetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  gl().GetProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::vector<GLchar> buffer(static_cast<std::size_t>(longest) + 1);
  for (GLint i = 0; i < count; ++i) {
    const ActiveUniform uniform = activeUniform(program, static_cast<GLuint>(i), buffer);
    if (!guard::isImageType(uniform.type)) continue;
    for (GLint element = 0; element < uniform.size; ++element) {
      const GLint location = gl().GetUniformLocation(program, elementName(uniform, element).c_str());
      GLint unit = -1;
      if (location >= 0) gl().GetUniformiv(program, location, &unit);
      if (unit >= 0) units.insert(static_cast<GLuint>(unit));
    }
  }
  return units;
}

std::vector<SubroutineChoice> subroutineChoices(const guard::ContextFacts& facts, GLuint original,
                                                GLuint copy) {
  std::vector<SubroutineChoice> choices;
  if (!facts.subroutines()) return choices;
  for (const GLenum stage : {GL_VERTEX_SHADER, GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER,
                             GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER, GL_COMPUTE_SHADER}) {
    SubroutineChoice choice{static_cast<GLenum>(stage), {}};
    const auto ask = [&](GLuint program, GLenum what) {
      GLint value = 0;
      gl().GetProgramStageiv(program, choice.stage, what, &value);
      return value;
    };
    const GLint locations = ask(copy, GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS);
    if (locations <= 0) continue;
    choice.indices.assign(static_cast<std::size_t>(locations), 0);
    std::vector<GLchar> name(
        static_cast<std::size_t>(std::max({ask(copy, GL_ACTIVE_SUBROUTINE_UNIFORM_MAX_LENGTH),
                                           ask(original, GL_ACTIVE_SUBROUTINE_MAX_LENGTH), 1}) +
                                 1));
    const GLint uniforms = ask(copy, GL_ACTIVE_SUBROUTINE_UNIFORMS);
    for (GLuint uniform = 0; uniform < static_cast<GLuint>(uniforms); ++uniform) {
      gl().GetActiveSubroutineUniformName(copy, choice.stage, uniform, static_cast<GLsizei>(name.size()),
                                          nullptr, name.data());
      GLint size = 1;
      gl().GetActiveSubroutineUniformiv(copy, choice.stage, uniform, GL_UNIFORM_SIZE, &size);
      const ActiveUniform shape{name.data(), size, 0};
      for (GLint element = 0; element < size; ++element) {
        const std::string element_name = elementName(shape, element);
        const GLint to = gl().GetSubroutineUniformLocation(copy, choice.stage, element_name.c_str());
        const GLint from = gl().GetSubroutineUniformLocation(original, choice.stage, element_name.c_str());
        if (to < 0 || to >= locations || from < 0) continue;
        GLuint chosen = 0;
        gl().GetUniformSubroutineuiv(choice.stage, from, &chosen);
        gl().GetActiveSubroutineName(original, choice.stage, chosen, static_cast<GLsizei>(name.size()),
                                     nullptr, name.data());
        const GLuint index = gl().GetSubroutineIndex(copy, choice.stage, name.data());
        if (index != GL_INVALID_INDEX) choice.indices[static_cast<std::size_t>(to)] = index;
      }
    }
    choices.push_back(std::move(choice));
  }
  guard::clearErrors();  // asking about a stage that the program lacks is an error
  return choices;
}

void selectSubroutines(const std::vector<SubroutineChoice>& choices) {
  for (const SubroutineChoice& choice : choices) {
    gl().UniformSubroutinesuiv(choice.stage, static_cast<GLsizei>(choice.indices.size()),
                               choice.indices.data());
  }
}

}  // namespace shadestep::replay
