#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {
namespace {

bool mentions(const frontend::Shader& shader, std::string_view name) {
  for (const frontend::Token& token : shader.tokens)
    if (token.text == name) return true;
  return false;
}

}  // namespace

Result<std::string> instrumentFilledOutputs(const frontend::Shader& shader, const Target& target,
                                            int quarters) {
  Draft draft(shader);
  const std::string value = std::to_string(static_cast<float>(quarters) / 4);
  const bool fragments = shader.stage == frontend::Stage::fragment;
  std::string assignments = assignOutputs(shader, fragments ? shader.outputs : stageOutputs(shader), value,
                                          std::to_string(quarters));
  if (mentions(shader, "gl_FragColor")) assignments += "  gl_FragColor = vec4(" + value + ");\n";
  if (mentions(shader, "gl_FragData")) {
    for (int i = 0; i < target.used_draw_buffers; ++i)
      assignments += "  gl_FragData[" + std::to_string(i) + "] = vec4(" + value + ");\n";
  }
  wrapMain(draft, assignments, "");
  return draft.finish();
}

}  // namespace shadestep::instrumenter
