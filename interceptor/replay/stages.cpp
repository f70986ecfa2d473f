// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/stages.h"

#include <algorithm>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/value_type.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;

using guard::Number;

Number numberOf(guard::Scalar scalar) {
  switch (scalar) {
    case guard::Scalar::float_:
      return Number::real;
    case guard::Scalar::int_:
      return Number::signed_integer;
    case guard::Scalar::uint_:
      return Number::unsigned_integer;
    case guard::Scalar::double_:
      return Number::double_real;
    default:
      return Number::unknown;
  }
}

// The 32-bit words of `size` values of a type; GL_NONE is that of gl_SkipComponentsN, whose size is N.
void appendWords(GLenum type, GLint size, std::vector<Number>& words) {
  if (type == GL_NONE) words.insert(words.end(), static_cast<std::size_t>(size), Number::unknown);
  const guard::ValueType* const known = guard::valueType(type);
  if (known == nullptr) return;
  const Number number = numberOf(known->scalar);
  for (int i = 0; i < size * known->components(); ++i) {
    words.push_back(number);
    if (known->wide()) words.push_back(number == Number::double_real ? Number::second_word : Number::unknown);
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
