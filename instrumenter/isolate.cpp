// One thread's work, everywhere (thesis 7.2.1).
#include <algorithm>
#include <string_view>

#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/constructs/thread_inputs.h"
#include "instrumenter/measures.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Component;
using frontend::Shader;
using frontend::Token;
using frontend::TokenKind;
using frontend::Type;
using frontend::Variable;

namespace {

std::string versionLine(const Shader& shader) {
  std::string line = "#version " + std::to_string(shader.version);
  if (!shader.profile.empty() && !(shader.profile == "es" && shader.version == 100))
    line += " " + shader.profile;
  return line + "\n";
}

std::string leadingDirectives(const Shader& shader) {
  std::string text;
  for (const Token& token : shader.tokens) {
    if (token.kind != TokenKind::directive) break;
    text += token.text + "\n";
  }
  return text;
}

// The same outputs, all written with `value`, a float. `declared` comes before main, `start` first in it.
std::string onlyOutputs(const Shader& shader, const Target& target, const std::string& declared,
                        const std::string& start, const std::string& value) {
  const bool es = isEs(shader);
  std::string declarations;
  std::string assignments = assignOutputs(shader, shader.outputs, value, value);
  for (std::size_t i = 0; i < shader.outputs.size(); ++i) {
    const Variable& output = shader.variables[static_cast<std::size_t>(shader.outputs[i])];
    if (es) declarations += "layout(location = " + std::to_string(i) + ") ";
    declarations += std::string("out ") + (es ? "highp " : "") + frontend::glslName(output.type) + " " +
                    output.name + ";\n";
  }
  if (writesFragData(shader))
    for (int i = 0; i < target.used_draw_buffers; ++i)
      assignments += "  gl_FragData[" + std::to_string(i) + "] = vec4(" + value + ");\n";
  if (shader.traits.writes_depth) assignments += "  gl_FragDepth = 0.5;\n";
  return leadingDirectives(shader) + declarations + declared + "void main() {\n" + start + assignments +
         "}\n";
}

// A chain of dependent steps that no compiler can shorten. GLSL ES 1.00 wants constant bounds.
std::string knownWork(const Shader& shader, const Target& target, const std::string& work) {
  const std::string precision = isEs(shader) ? "highp " : "";
  return onlyOutputs(shader, target, "uniform " + precision + "int " + work + ";\n",
                     "  " + precision +
                         "float x = 0.3;\n"
                         "  for (int i = 0; i < 10000; ++i) {\n    if (i >= " +
                         work +
                         ") break;\n"
                         "    x = 3.7 * x * (1.0 - x);\n  }\n",
                     "x");
}

// One triangle that covers the target. Below 1.30 there is no gl_VertexID: attribute 0 gives the corners
// (-1,-1), (3,-1), (-1,3).
std::string coveringVertex(const Shader& shader) {
  const bool has_id = shader.version >= 130 || (isEs(shader) && shader.version >= 300);
  if (!has_id)
    return versionLine(shader) +
           "attribute vec2 sd_corner;\n"
           "void main() {\n"
           "  gl_Position = vec4(sd_corner, 0.0, 1.0);\n"
           "}\n";
  return versionLine(shader) +
         "void main() {\n"
         "  float x = gl_VertexID == 1 ? 3.0 : -1.0, y = gl_VertexID == 2 ? 3.0 : -1.0;\n"
         "  gl_Position = vec4(x, y, 0.0, 1.0);\n"
         "}\n";
}

// The value of a component from its word (two, for 64 bits), read by `word`.
std::string fromWords(const Draft& draft, Basic basic, bool floats, const std::string& first,
                      const std::string& second) {
  switch (basic) {
    case Basic::float_:
      return floats ? first : "uintBitsToFloat(" + first + ")";
    case Basic::int_:
      return (draft.es() ? draft.name("int") : "int") + "(" + first + ")";
    case Basic::bool_:
      return floats ? first + " != 0.0" : first + " != 0u";
    case Basic::double_:
      return "packDouble2x32(uvec2(" + first + ", " + second + "))";
    case Basic::int64_:
      return "packInt2x32(ivec2(uvec2(" + first + ", " + second + ")))";
    case Basic::uint64_:
      return "packUint2x32(uvec2(" + first + ", " + second + "))";
    default:
      return first;
  }
}

// Statements that set every input from the uniform; completes `isolated`.
std::string setInputs(Draft& draft, const std::vector<ThreadInput>& inputs, const Target& target,
                      Isolation mode, IsolatedShader& isolated, Failure& failure) {
  const Shader& shader = draft.shader();
  if (inputs.empty()) return "";
  if (shader.main == frontend::kNone) {
    failure.reason = "The shader has no main; it is a part of a program whose main is in another shader.";
    return "";
  }
  isolated.floats = shader.version < 130 || (!draft.es() && shader.version < 330 && !target.bit_encoding);
  int words = 0;
  for (const ThreadInput& input : inputs) {
    if (isolated.floats && input.type.basic != Basic::float_ && input.type.basic != Basic::bool_) {
      failure.reason = "The input '" + input.input + "' is a " + frontend::glslName(input.type) +
                       ", which needs GL_ARB_shader_bit_encoding to be handed over.";
      return "";
    }
    isolated.inputs.push_back({input.input, input.type, words});
    words += frontend::wordCount(input.type);
  }
  isolated.words_uniform = draft.name("inputs");
  isolated.vectors_per_thread = (words + 3) / 4;
  if (!isolated.floats) prepareWords(draft);
  const bool quad = mode == Isolation::quad;
  const int vectors = isolated.vectors_per_thread;
  const std::string type = draft.highp() + (isolated.floats ? "vec4 " : "uvec4 ");
  draft.declare("uniform " + type + isolated.words_uniform + "[" + std::to_string(vectors * (quad ? 4 : 1)) +
                "];");

  const std::string odd_x = draft.name("odd_x"), odd_y = draft.name("odd_y");
  std::string start;
  if (quad)
    start += "  bool " + odd_x + " = fract(0.5 * gl_FragCoord.x) > 0.5, " + odd_y +
             " = fract(0.5 * gl_FragCoord.y) > 0.5;\n";
  const auto vectorName = [&draft](int i) { return draft.name("vector" + std::to_string(i)); };
  for (int i = 0; i < vectors; ++i) {
    const auto ofThread = [&](int thread) {
      return isolated.words_uniform + "[" + std::to_string(thread * vectors + i) + "]";
    };
    start += "  " + type + vectorName(i) + " = " +
             (quad ? odd_y + " ? (" + odd_x + " ? " + ofThread(3) + " : " + ofThread(2) + ") : (" + odd_x +
                         " ? " + ofThread(1) + " : " + ofThread(0) + ")"
                   : ofThread(0)) +
             ";\n";
  }
  int word = 0;
  const auto next = [&] {
    const std::string text = vectorName(word / 4) + "." + "xyzw"[word % 4];
    ++word;
    return text;
  };
  for (const ThreadInput& input : inputs)
    for (const Component& component : frontend::components(input.type)) {
      Type scalar;
      scalar.basic = component.basic;
      const std::string first = next();
      const std::string second = frontend::wordCount(scalar) == 2 ? next() : "";
      start += "  " + input.variable + component.access + " = " +
               fromWords(draft, component.basic, isolated.floats, first, second) + ";\n";
    }
  return start;
}

}  // namespace

namespace {

// Why no thread of this shader can do its work alone; empty if it can.
std::string whyNotAlone(const Shader& shader) {
  if (shader.stage != frontend::Stage::fragment && shader.stage != frontend::Stage::vertex &&
      shader.stage != frontend::Stage::compute)
    return "Only fragments, vertices and invocations of compute shaders can be isolated: threads of other "
           "stages read "
           "what others of their primitive left.";
  const auto uses = [&shader](std::string_view word) {
    return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                       [word](const Token& token) { return token.text == word; });
  };
  if (shader.stage == frontend::Stage::compute && (uses("shared") || uses("barrier")))
    return "The shader's invocations work together (shared memory, barriers): alone, one would do something "
           "else.";
  return "";
}

// The text with a main that does nothing, so that all else is the same.
Result<std::string> withoutWork(const Shader& shader) {
  Draft draft(shader);
  wrapMain(draft, "  return;\n", "");
  return draft.finish();
}

}  // namespace

Result<IsolatedShader> instrumentIsolate(const Shader& shader, const Target& target, Isolation mode) {
  if (std::string reason = whyNotAlone(shader); !reason.empty()) return Failure{std::move(reason)};
  Draft draft(shader);
  auto inputs = threadInputs(draft);
  if (auto* failure = std::get_if<Failure>(&inputs)) return *failure;
  const auto& found = std::get<std::vector<ThreadInput>>(inputs);
  IsolatedShader isolated;
  replaceInputs(draft, found);
  Failure failure;
  const std::string start = setInputs(draft, found, target, mode, isolated, failure);
  if (!failure.reason.empty()) return failure;
  if (!start.empty()) wrapMain(draft, start, "");
  auto text = draft.finish();
  if (auto* refused = std::get_if<Failure>(&text)) return *refused;
  isolated.text = std::move(std::get<std::string>(text));
  if (shader.stage != frontend::Stage::fragment) {
    auto empty = withoutWork(shader);
    if (auto* refused = std::get_if<Failure>(&empty)) return *refused;
    isolated.baseline_text = std::move(std::get<std::string>(empty));
    return isolated;
  }
  isolated.baseline_text = onlyOutputs(shader, target, "", "", "0.0");
  isolated.work_uniform = draft.name("work");
  isolated.work_text = knownWork(shader, target, isolated.work_uniform);
  isolated.vertex_text = coveringVertex(shader);
  return isolated;
}

Probe inputsProbe(const Shader& shader) {
  Probe probe;
  if (shader.main != frontend::kNone)
    probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const Draft draft(shader);
  const auto inputs = threadInputs(draft);
  if (const auto* found = std::get_if<std::vector<ThreadInput>>(&inputs))
    for (const ThreadInput& input : *found)
      probe.watches.push_back(frontend::Watch{input.input, frontend::kNone, input.type});
  return probe;
}

std::string uninstrumented(const Shader& shader) {
  return frontend::emit(shader.tokens);
}

}  // namespace shadestep::instrumenter
