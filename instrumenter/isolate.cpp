// One fragment's work, everywhere (thesis 7.2.1).
#include "instrumenter/constructs/fragment_inputs.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Token;
using frontend::TokenKind;
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

// The same outputs, written with constants.
std::string baseline(const Shader& shader, const Target& target) {
  const bool es = isEs(shader);
  std::string declarations;
  std::string assignments = assignOutputs(shader, "0");
  for (std::size_t i = 0; i < shader.outputs.size(); ++i) {
    const Variable& output = shader.variables[static_cast<std::size_t>(shader.outputs[i])];
    if (es) declarations += "layout(location = " + std::to_string(i) + ") ";
    declarations += std::string("out ") + (es ? "highp " : "") + frontend::glslName(output.type) + " " +
                    output.name + ";\n";
  }
  if (writesFragData(shader))
    for (int i = 0; i < target.used_draw_buffers; ++i)
      assignments += "  gl_FragData[" + std::to_string(i) + "] = vec4(0.0);\n";
  if (shader.traits.writes_depth) assignments += "  gl_FragDepth = 0.5;\n";
  return leadingDirectives(shader) + declarations + "void main() {\n" + assignments + "}\n";
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

}  // namespace

Result<IsolatedShader> instrumentIsolate(const Shader& shader, const Target& target) {
  if (shader.stage != frontend::Stage::fragment)
    return Failure{"Only fragment shaders can be isolated; choose --stage fragment."};
  Draft draft(shader);
  auto inputs = fragmentInputs(draft);
  if (auto* failure = std::get_if<Failure>(&inputs)) return *failure;
  IsolatedShader isolated;
  isolated.inputs = std::move(std::get<std::vector<IsolatedInput>>(inputs));
  replaceInputs(draft, isolated.inputs);
  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  isolated.text = std::move(std::get<std::string>(text));
  isolated.baseline_text = baseline(shader, target);
  isolated.vertex_text = coveringVertex(shader);
  return isolated;
}

Probe inputsProbe(const Shader& shader) {
  Probe probe;
  if (shader.main != frontend::kNone)
    probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const Draft draft(shader);
  const auto inputs = fragmentInputs(draft);
  if (const auto* found = std::get_if<std::vector<IsolatedInput>>(&inputs))
    for (const IsolatedInput& input : *found)
      probe.watches.push_back(frontend::Watch{input.input, frontend::kNone, input.type});
  return probe;
}

std::string uninstrumented(const Shader& shader) {
  return frontend::emit(shader.tokens);
}

}  // namespace shadestep::instrumenter
