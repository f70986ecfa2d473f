// Several probes in one text, chosen by a uniform.
#include <algorithm>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/placement.h"

namespace shadestep::instrumenter {

using frontend::Shader;

namespace {

std::string misplaced(const Shader& shader, const std::vector<Probe>& probes) {
  for (const Probe& probe : probes) {
    std::string reason = misplaced(shader, probe);
    if (!reason.empty()) return reason;
  }
  return "";
}

std::string addFields(Attachments& attachments, const Shader& shader, const Probe& probe) {
  if (probe.outcome && !attachments.add("", outcomeType(shader, probe)))
    return "The outcome of a condition does not fit into " + attachments.place() + ".";
  for (const frontend::Watch& watch : probe.watches) {
    if (!attachments.add(watch.expression, watch.type))
      return "'" + watch.expression + "' (" + frontend::glslName(watch.type) + ") does not fit into " +
             attachments.place() + " beside the other values of its probe; watch fewer at once.";
  }
  return "";
}

// A probe that takes any call of a function misses the calls that run a copy of it.
std::string mixedPaths(const Shader& shader, const CallPaths& paths, const std::vector<Probe>& probes) {
  for (const Probe& probe : probes) {
    const frontend::FunctionId function =
        shader.statements[static_cast<std::size_t>(probe.statement)].function;
    if (probe.call_path.empty() && !paths.into(function).empty())
      return "Any call of '" + functionAt(shader, function).name +
             "' and one certain call of it cannot be looked at by one text; take them one by one.";
  }
  return "";
}

// What words hold before a probe captures. Floats begin with no constant: Mesa turns the choice between the
// constants -1.0 and 0.0 by a probe's number into -0.0 for 0.0.
std::string nothing(const Draft& draft, const Attachments& attachments) {
  const bool floats = attachments.layout().carrier == Carrier::float_attachments;
  return floats ? "float(" + draft.name("probe") + ")" : "";
}

std::vector<std::string> declareUniforms(Draft& draft, const std::vector<Probe>& probes) {
  std::size_t loops = 0;
  for (const Probe& probe : probes) loops = std::max(loops, probe.iterations.size());
  std::vector<std::string> names = {declareProbe(draft)};
  for (std::size_t i = 0; i < loops; ++i) {
    names.push_back(draft.name("number" + std::to_string(i)));
    draft.declare("uniform " + draft.highp() + "int " + names.back() + ";");
  }
  return names;
}

}  // namespace

Result<WindowShader> instrumentWindow(const Shader& shader, const std::vector<Probe>& probes,
                                      const Target& target) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  std::string reason = attachments.failure();
  if (reason.empty()) reason = misplaced(shader, probes);
  WindowLayout layout;
  for (const Probe& probe : probes) {
    if (reason.empty()) reason = addFields(attachments, shader, probe);
    layout.probes.push_back(attachments.overlay());
  }
  if (!reason.empty()) return Failure{reason};
  Conditions conditions(draft);

  // In the same order as for a single probe.
  attachments.hideConstants();
  attachments.declare();
  attachments.frame("  " + attachments.clear(kLaunched, nothing(draft, attachments)) + ";\n", "");
  std::vector<CallPaths::Path> wanted;
  for (const Probe& probe : probes) wanted.push_back(probe.call_path);
  CallPaths paths(draft, wanted);
  reason = mixedPaths(shader, paths, probes);
  if (!reason.empty()) return Failure{reason};

  layout.capture = attachments.layout();
  layout.iteration_uniforms = declareUniforms(draft, probes);
  layout.probe_uniform = layout.iteration_uniforms.front();
  layout.iteration_uniforms.erase(layout.iteration_uniforms.begin());
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const Probe& probe = probes[i];
    std::vector<std::string> values;
    if (probe.outcome) values.push_back(outcomeText(draft, conditions, probe));
    for (const frontend::Watch& watch : probe.watches)
      values.push_back(withoutFragColor(frontend::operandOf(watch)));
    const std::vector<std::string> numbers(
        layout.iteration_uniforms.begin(),
        layout.iteration_uniforms.begin() + static_cast<std::ptrdiff_t>(probe.iterations.size()));
    placed.push_back({probe, layout.probe_uniform + " == " + std::to_string(i), numbers,
                      attachments.assign(layout.probes[i].fields, kLaunched | kReached, values)});
    layout.probes[i].outputs = layout.capture.outputs;
    layout.probes[i].list_block = layout.capture.list_block;
    // In a list all threads take as many words as those of the widest probe.
    if (layout.capture.carrier == Carrier::list) layout.probes[i].words = layout.capture.words;
    layout.probes[i].discarded_block = layout.capture.discarded_block;
    layout.probes[i].discarded_words = layout.capture.discarded_words;
  }
  place(draft, conditions, paths, placed);
  if (auto failure = paths.insertCopies()) return *failure;

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  return WindowShader{std::move(std::get<std::string>(text)), std::move(layout)};
}

}  // namespace shadestep::instrumenter
