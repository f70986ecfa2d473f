// The whole run of one thread of a stage other than the fragment stage.
#include <algorithm>

#include "session/probed_run.h"
#include "session/thread_run.h"
#include "session/thread_values.h"

namespace shadestep::session {
namespace {

using frontend::Shader;
using instrumenter::Probe;

// At the start of main, with the inputs that the shader uses.
Probe inputsProbe(const Shader& shader) {
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  for (const frontend::VariableId id : shader.statements[static_cast<std::size_t>(probe.statement)].scope) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const bool given = variable.storage == frontend::Storage::in ||
                       (variable.storage == frontend::Storage::builtin && !variable.written);
    if (given && variable.read && frontend::wordCount(variable.type) > 0)
      probe.watches.push_back({variable.name, id, variable.type});
  }
  return probe;
}

std::string range(const WatchedValues& numbers) {
  const auto less = [](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b);
  };
  const auto [least, most] = std::minmax_element(numbers.words.begin(), numbers.words.end(), less);
  return numbers.name + " " + std::to_string(static_cast<std::int32_t>(*least)) + " to " +
         std::to_string(static_cast<std::int32_t>(*most));
}

[[noreturn]] void noSuchThread(const ThreadValues& threads, const std::vector<std::int32_t>& wanted) {
  std::string asked;
  std::string there;
  for (std::size_t i = 0; i < threads.identity.size(); ++i) {
    const WatchedValues& numbers = threads.identity[i];
    if (i < wanted.size())
      asked += (asked.empty() ? "" : ", ") + numbers.name + " " + std::to_string(wanted[i]);
    if (!numbers.words.empty()) there += (there.empty() ? "" : ", ") + range(numbers);
  }
  throw Error(Outcome::nothing_matches, "the draw runs no thread " + asked + "; " +
                                            (there.empty() ? "it runs none" : "there are " + there));
}

}  // namespace

ThreadRun followThread(Session& session, std::vector<std::int32_t> identity) {
  const Shader& shader = session.shader();
  const ThreadValues inputs = valuesAt(session, inputsProbe(shader));
  identity.resize(inputs.identity.size());
  const std::optional<std::size_t> number = inputs.find(identity);
  if (!number) noSuchThread(inputs, identity);

  auto instrumented = instrumenter::instrumentRecording(shader, session.target());
  ThreadRun run;
  if (auto* recording = std::get_if<instrumenter::RecordingShader>(&instrumented)) {
    Prepared program = session.prepare(*recording);
    const Session::Recorded recorded = session.record({std::move(*recording), std::move(program)}, identity);
    if (recorded.recording.threads.empty()) noSuchThread(inputs, identity);
    const instrumenter::ThreadRecording& thread = recorded.recording.threads.front();
    run.steps = stepsOf(shader, recorded.layout, thread);
    run.complete = thread.complete;
    run.check = recorded.execution.check;
  } else {
    run = followThreadByProbes(session, *number);
  }
  for (const WatchedValues& one : inputs.identity) run.identity.push_back({one.name, one.valueAt(*number)});
  for (const WatchedValues& one : inputs.values) run.inputs.push_back({one.name, one.valueAt(*number)});
  return run;
}

}  // namespace shadestep::session
