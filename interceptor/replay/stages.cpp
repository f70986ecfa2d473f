// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/stages.h"

#include <algorithm>
#include <iterator>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;

// A type of what transform feedback writes, by its components.
struct FeedbackType {
  GLenum type;
  guard::Number component;
  int components;
};

using guard::Number;
constexpr FeedbackType kFeedbackTypes[] = {
    {GL_NONE, Number::unknown, 1},  // of gl_SkipComponentsN, whose size is N
    {GL_FLOAT, Number::real, 1},
    {GL_FLOAT_VEC2, Number::real, 2},
    {GL_FLOAT_VEC3, Number::real, 3},
    {GL_FLOAT_VEC4, Number::real, 4},
    {GL_FLOAT_MAT2, Number::real, 4},
    {GL_FLOAT_MAT2x3, Number::real, 6},
    {GL_FLOAT_MAT2x4, Number::real, 8},
    {GL_FLOAT_MAT3x2, Number::real, 6},
    {GL_FLOAT_MAT3, Number::real, 9},
    {GL_FLOAT_MAT3x4, Number::real, 12},
    {GL_FLOAT_MAT4x2, Number::real, 8},
    {GL_FLOAT_MAT4x3, Number::real, 12},
    {GL_FLOAT_MAT4, Number::real, 16},
    {GL_INT, Number::signed_integer, 1},
    {GL_INT_VEC2, Number::signed_integer, 2},
    {GL_INT_VEC3, Number::signed_integer, 3},
    {GL_INT_VEC4, Number::signed_integer, 4},
    {GL_UNSIGNED_INT, Number::unsigned_integer, 1},
    {GL_UNSIGNED_INT_VEC2, Number::unsigned_integer, 2},
    {GL_UNSIGNED_INT_VEC3, Number::unsigned_integer, 3},
    {GL_UNSIGNED_INT_VEC4, Number::unsigned_integer, 4},
    {GL_INT64_ARB, Number::unknown, 2},
    {GL_INT64_VEC2_ARB, Number::unknown, 4},
    {GL_INT64_VEC3_ARB, Number::unknown, 6},
    {GL_INT64_VEC4_ARB, Number::unknown, 8},
    {GL_UNSIGNED_INT64_ARB, Number::unknown, 2},
    {GL_UNSIGNED_INT64_VEC2_ARB, Number::unknown, 4},
    {GL_UNSIGNED_INT64_VEC3_ARB, Number::unknown, 6},
    {GL_UNSIGNED_INT64_VEC4_ARB, Number::unknown, 8},
    {GL_DOUBLE, Number::double_real, 1},
    {GL_DOUBLE_VEC2, Number::double_real, 2},
    {GL_DOUBLE_VEC3, Number::double_real, 3},
    {GL_DOUBLE_VEC4, Number::double_real, 4},
    {GL_DOUBLE_MAT2, Number::double_real, 4},
    {GL_DOUBLE_MAT2x3, Number::double_real, 6},
    {GL_DOUBLE_MAT2x4, Number::double_real, 8},
    {GL_DOUBLE_MAT3x2, Number::double_real, 6},
    {GL_DOUBLE_MAT3, Number::double_real, 9},
    {GL_DOUBLE_MAT3x4, Number::double_real, 12},
    {GL_DOUBLE_MAT4x2, Number::double_real, 8},
    {GL_DOUBLE_MAT4x3, Number::double_real, 12},
    {GL_DOUBLE_MAT4, Number::double_real, 16},
};

// The 32-bit words of `size` values of a type.
void appendWords(GLenum type, GLint size, std::vector<Number>& words) {
  const auto* found = std::find_if(std::begin(kFeedbackTypes), std::end(kFeedbackTypes),
                                   [&](const FeedbackType& known) { return known.type == type; });
  if (found == std::end(kFeedbackTypes)) return;
  for (int i = 0; i < size * found->components; ++i) {
    words.push_back(found->component);
    if (found->component == Number::double_real) words.push_back(Number::second_word);
  }
}

GLenum primitiveMode(GLuint program, wire::Stage last) {
  GLint made = GL_POINTS;
  GLint points = GL_TRUE;
  switch (last) {
    case wire::Stage::TessControl:
    case wire::Stage::TessEval:
      gl().GetProgramiv(program, GL_TESS_GEN_POINT_MODE, &points);
      gl().GetProgramiv(program, GL_TESS_GEN_MODE, &made);
      return points ? GL_POINTS : made == GL_ISOLINES ? GL_LINES : GL_TRIANGLES;
    case wire::Stage::Geometry:
      gl().GetProgramiv(program, GL_GEOMETRY_OUTPUT_TYPE, &made);
      return made == GL_POINTS ? GL_POINTS : made == GL_LINE_STRIP ? GL_LINES : GL_TRIANGLES;
    default:
      return GL_POINTS;
  }
}

// Varyings cannot be named while the current feedback object is active, even if it is paused: meanwhile it is
// another.
class OtherFeedbackObject {
 public:
  explicit OtherFeedbackObject(const guard::ContextFacts& facts) : objects_(facts.pausesTransformFeedback()) {
    if (!objects_) return;
    gl().GetIntegerv(GL_TRANSFORM_FEEDBACK_BINDING, &before_);
    gl().GenTransformFeedbacks(1, &other_);
    gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, other_);
  }
  ~OtherFeedbackObject() {
    if (!objects_) return;
    gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, static_cast<GLuint>(before_));
    gl().DeleteTransformFeedbacks(1, &other_);
  }
  OtherFeedbackObject(const OtherFeedbackObject&) = delete;
  OtherFeedbackObject& operator=(const OtherFeedbackObject&) = delete;

 private:
  bool objects_;
  GLint before_ = 0;
  GLuint other_ = 0;
};

}  // namespace

const char* stageWord(GLenum type) {
  switch (type) {
    case GL_VERTEX_SHADER:
      return "vertex";
    case GL_TESS_CONTROL_SHADER:
      return "tessellation control";
    case GL_TESS_EVALUATION_SHADER:
      return "tessellation evaluation";
    case GL_GEOMETRY_SHADER:
      return "geometry";
    case GL_FRAGMENT_SHADER:
      return "fragment";
    default:
      return "compute";
  }
}

GLenum shaderType(wire::Stage stage) {
  switch (stage) {
    case wire::Stage::Vertex:
      return GL_VERTEX_SHADER;
    case wire::Stage::TessControl:
      return GL_TESS_CONTROL_SHADER;
    case wire::Stage::TessEval:
      return GL_TESS_EVALUATION_SHADER;
    case wire::Stage::Geometry:
      return GL_GEOMETRY_SHADER;
    case wire::Stage::Fragment:
      return GL_FRAGMENT_SHADER;
    case wire::Stage::Compute:
      return GL_COMPUTE_SHADER;
  }
  return 0;
}

bool runsUpTo(GLenum type, wire::Stage last) {
  if (last == wire::Stage::Compute) return type == GL_COMPUTE_SHADER;
  switch (type) {
    case GL_VERTEX_SHADER:
      return true;
    case GL_TESS_CONTROL_SHADER:
    case GL_TESS_EVALUATION_SHADER:
      return last != wire::Stage::Vertex;
    case GL_GEOMETRY_SHADER:
      return last == wire::Stage::Geometry;
    default:
      return false;
  }
}

void setFeedbackVaryings(const guard::ContextFacts& facts, GLuint program, const wire::PrepareT& request) {
  std::vector<const GLchar*> names;
  for (const std::string& name : request.feedback_captures) names.push_back(name.c_str());
  for (const std::string& name : request.feedback_outputs) names.push_back(name.c_str());
  if (names.empty()) return;
  const OtherFeedbackObject other(facts);
  gl().TransformFeedbackVaryings(program, static_cast<GLsizei>(names.size()), names.data(),
                                 GL_INTERLEAVED_ATTRIBS);
}

void copyFeedbackVaryings(const guard::ContextFacts& facts, GLuint original, GLuint copy) {
  GLint count = 0;
  gl().GetProgramiv(original, GL_TRANSFORM_FEEDBACK_VARYINGS, &count);
  if (guard::clearErrors() || count <= 0) return;
  GLint longest = 0;
  GLint mode = GL_INTERLEAVED_ATTRIBS;
  gl().GetProgramiv(original, GL_TRANSFORM_FEEDBACK_VARYING_MAX_LENGTH, &longest);
  gl().GetProgramiv(original, GL_TRANSFORM_FEEDBACK_BUFFER_MODE, &mode);
  std::vector<std::string> names;
  std::vector<const GLchar*> pointers;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    std::string name(static_cast<std::size_t>(longest) + 1, '\0');
    GLsizei length = 0;
    GLsizei size = 0;
    GLenum type = 0;
    gl().GetTransformFeedbackVarying(original, i, longest, &length, &size, &type, name.data());
    name.resize(static_cast<std::size_t>(length));
    names.push_back(std::move(name));
  }
  for (const std::string& name : names) pointers.push_back(name.c_str());
  const OtherFeedbackObject other(facts);
  gl().TransformFeedbackVaryings(copy, count, pointers.data(), static_cast<GLenum>(mode));
}

capture::FeedbackLayout feedbackLayout(GLuint program, const wire::PrepareT& request) {
  capture::FeedbackLayout layout;
  const std::size_t captures = request.feedback_captures.size();
  const std::size_t count = captures + request.feedback_outputs.size();
  if (count == 0) return layout;
  layout.mode = primitiveMode(program, request.stage);
  GLint longest = 0;
  gl().GetProgramiv(program, GL_TRANSFORM_FEEDBACK_VARYING_MAX_LENGTH, &longest);
  std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
  std::vector<Number> captured;
  for (GLuint i = 0; i < count; ++i) {
    GLsizei size = 0;
    GLenum type = 0;
    gl().GetTransformFeedbackVarying(program, i, static_cast<GLsizei>(name.size()), nullptr, &size, &type,
                                     name.data());
    if (type == GL_NONE && name.starts_with("gl_NextBuffer")) {
      layout.outputs.emplace_back();
      continue;
    }
    layout.holes |= type == GL_NONE;
    appendWords(type, size, i < captures ? captured : layout.outputs.back());
  }
  layout.capture_words = static_cast<int>(captured.size());
  return layout;
}

}  // namespace shadestep::replay
