// One probe, all threads (thesis 7.1.4).
#include "instrumenter/attachments.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/placement.h"

namespace shadestep::instrumenter {

using frontend::Shader;

namespace {

// Takes as many watches as fit; says why if not even one does.
std::string addFields(Attachments& attachments, const Shader& shader, const Probe& probe) {
  if (probe.outcome && !attachments.add("", outcomeType(shader, probe)))
    return "The outcome of the condition does not fit into " + attachments.place() + ".";
  for (const frontend::Watch& watch : probe.watches) {
    if (attachments.add(watch.expression, watch.type)) continue;
    if (!attachments.layout().fields.empty()) break;
    const std::string value = "'" + watch.expression + "' (" + frontend::glslName(watch.type) + ")";
    return frontend::wordCount(watch.type) == 0
               ? value + " holds no value that can be shown; look at what is read from it."
               : value + " does not fit into " + attachments.place() + "; watch a part of it.";
  }
  return "";
}

bool mayRepeat(const Shader& shader, const Probe& probe) {
  const frontend::FunctionId function = shader.statements[static_cast<std::size_t>(probe.statement)].function;
  const bool any_call = probe.call_path.empty() && functionAt(shader, function).name != "main";
  return any_call || !numberedLoops(shader, probe).empty();
}

// What always holds, but not for the compiler. llvmpipe (Mesa 22.3) goes on computing, also in threads that
// have left a loop, what depends on nothing of the iteration before: without a condition, words that a loop
// captures last would be those of the slowest thread nearby.
std::string opaqueTruth(Draft& draft) {
  return declareProbe(draft) + " == 0";
}

}  // namespace

Result<AttachmentShader> instrumentSingle(const Shader& shader, const Probe& probe, const Target& target) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  std::string reason = attachments.failure();
  if (reason.empty()) reason = misplaced(shader, probe);
  if (reason.empty()) reason = addFields(attachments, shader, probe);
  if (!reason.empty()) return Failure{reason};
  Conditions conditions(draft);

  // 1. Outputs and main first: these replacements must hold in the functions copied below too.
  attachments.declare();
  attachments.frame("  " + attachments.clear(kLaunched) + ";\n", "");
  // 2. The functions along the path, before anything is inserted into them.
  CallPaths paths(draft, {probe.call_path});
  // 3. The counters and the probe.
  std::vector<std::string> values;
  if (probe.outcome) values.push_back(outcomeText(draft, conditions, probe));
  for (std::size_t i = 0; values.size() < attachments.layout().fields.size(); ++i)
    values.push_back(withoutFragColor(frontend::operandOf(probe.watches[i])));
  std::vector<std::string> numbers;
  for (const int iteration : probe.iterations) numbers.push_back(std::to_string(iteration));
  const std::string guard = numbers.empty() && mayRepeat(shader, probe) ? opaqueTruth(draft) : "";
  place(draft, conditions, paths,
        {{probe, guard, numbers, attachments.assign(kLaunched | kReached, values)}});
  // 4. The copies, now that their edits are complete.
  if (auto failure = paths.insertCopies()) return *failure;

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  return AttachmentShader{std::move(std::get<std::string>(text)), attachments.layout()};
}

}  // namespace shadestep::instrumenter
