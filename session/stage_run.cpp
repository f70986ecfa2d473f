// The whole run of one thread of a stage other than the fragment stage.
#include <algorithm>

#include "session/probed_run.h"
#include "session/thread_run.h"
#include "session/thread_values.h"

namespace shadestep::session {
namespace {

using frontend::Shader;
using instrumenter::Probe;

const char* const kPatchVertices = "gl_PatchVerticesIn";
constexpr int kUnlimited = 1 << 30;
constexpr int kWidestInput = 512;  // words; wider ones are not among a run's inputs

bool ofPatch(const Shader& shader) {
  return shader.stage == Stage::tess_control || shader.stage == Stage::tess_eval;
}

bool uses(const Shader& shader, const std::string& name) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [&](const frontend::Token& token) { return token.text == name; });
}

// Of the block array gl_in the members that the shader names: nobody has written the others.
void watchBlocks(const Shader& shader, frontend::VariableId id, std::vector<frontend::Watch>& watches) {
  const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  for (int i = 0; i < variable.type.array.front(); ++i) {
    for (const frontend::Member& member : variable.type.members->members) {
      if (uses(shader, member.name) && frontend::wordCount(member.type) > 0)
        watches.push_back({variable.name + "[" + std::to_string(i) + "]." + member.name, id, member.type});
    }
  }
}

// At the start of main, with the inputs that the shader uses.
Probe inputsProbe(const Shader& shader) {
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  for (const frontend::VariableId id : shader.statements[static_cast<std::size_t>(probe.statement)].scope) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const bool given = variable.storage == frontend::Storage::in ||
                       (variable.storage == frontend::Storage::builtin && !variable.written);
    if (!given || !variable.read) continue;
    const int words = frontend::wordCount(variable.type);
    if (variable.name == "gl_in" && variable.type.isArray() && variable.type.members)
      watchBlocks(shader, id, probe.watches);
    else if (words > 0 && words <= kWidestInput)
      probe.watches.push_back({variable.name, id, variable.type});
  }
  if (ofPatch(shader)) {
    frontend::Type number;
    number.basic = frontend::Basic::int_;
    probe.watches.push_back({kPatchVertices, frontend::kNone, number});
  }
  return probe;
}

// The token that opens the braces around `i`, kNone outside of all.
frontend::TokenIndex openingBrace(const Shader& shader, frontend::TokenIndex i) {
  int depth = 0;
  for (--i; i >= 0; --i) {
    const std::string& text = shader.tokens[static_cast<std::size_t>(i)].text;
    if (text == "}") ++depth;
    if (text == "{" && depth-- == 0) return i;
  }
  return frontend::kNone;
}

// Is the variable declared with `patch`, alone or in a block?
bool isPatch(const Shader& shader, const frontend::Variable& variable) {
  const auto text = [&](frontend::TokenIndex i) { return shader.tokens[static_cast<std::size_t>(i)].text; };
  frontend::TokenIndex head = variable.declared;
  if (head > 0 && text(head - 1) == "}")
    head = openingBrace(shader, head - 1);  // the block of this instance
  else if (const auto block = openingBrace(shader, head); block != frontend::kNone)
    head = block;
  for (frontend::TokenIndex i = head - 1; i >= 0 && text(i) != ";" && text(i) != "}"; --i)
    if (text(i) == "patch") return true;
  return false;
}

// One value for each vertex of the patch, in an array that has room for as many as there can be.
bool isPerVertex(const Shader& shader, const std::string& name) {
  for (const frontend::Variable& variable : shader.variables)
    if (variable.name == name && variable.storage == frontend::Storage::in && variable.type.isArray())
      return !isPatch(shader, variable);
  return false;
}

// Whether all threads with the numbers of this one, save `repeat`, have its value.
bool agrees(const ThreadValues& threads, const WatchedValues& values, std::size_t thread) {
  const auto same = [&](std::size_t p) {
    return threads.marks[p] != 0 &&
           std::all_of(threads.identity.begin(), threads.identity.end(), [&](const WatchedValues& one) {
             return one.name == "repeat" || *one.at(p) == *one.at(thread);
           });
  };
  for (std::size_t p = 0; p < threads.marks.size(); ++p)
    if (same(p) && !std::equal(values.at(p), values.at(p) + values.stride, values.at(thread))) return false;
  return true;
}

// The inputs of a thread: of a patch only the vertices that it has.
// Threads with the same numbers are told apart by their order alone, which a second draw, the one that gives
// the inputs, need not keep: an input that they do not agree on goes to `ambiguous`.
std::vector<NamedValue> inputsOf(const Shader& shader, const ThreadValues& threads, std::size_t thread,
                                 std::string& ambiguous) {
  const int vertices =
      ofPatch(shader) ? static_cast<std::int32_t>(*threads.values.back().at(thread)) : kUnlimited;
  std::vector<NamedValue> inputs;
  for (const WatchedValues& one : threads.values) {
    if (ofPatch(shader) && &one == &threads.values.back()) break;
    const bool of_block = one.name.starts_with("gl_in[");
    if (of_block && std::stoi(one.name.substr(std::string("gl_in[").size())) >= vertices) continue;
    if (!agrees(threads, one, thread)) {
      ambiguous += (ambiguous.empty() ? "" : ", ") + one.name;
      continue;
    }
    NamedValue input{one.name, one.valueAt(thread)};
    frontend::Type& type = input.value.type;
    if (isPerVertex(shader, one.name) && type.array.front() > vertices) {
      type.array.front() = vertices;
      input.value.words.resize(static_cast<std::size_t>(frontend::wordCount(type)));
    }
    inputs.push_back(std::move(input));
  }
  return inputs;
}

}  // namespace

// By the numbers that the recording compares; threads that have the same ones come in the driver's order.
ThreadRecord recordThread(Session& session, const Session::PreparedRecording& prepared,
                          const ThreadValues& all, std::size_t place) {
  std::vector<std::int32_t> numbers;
  std::size_t repeat = 0;
  for (const WatchedValues& one : all.identity) {
    if (one.name == "repeat")
      repeat = *one.at(place);
    else
      numbers.push_back(static_cast<std::int32_t>(*one.at(place)));
  }
  ThreadRecord record{session.record(prepared, numbers), -1};
  if (repeat < record.recorded.recording.threads.size()) record.thread = static_cast<int>(repeat);
  return record;
}

ThreadRun followThread(Session& session, const ThreadName& name) {
  const Shader& shader = session.shader();
  const ThreadValues inputs = valuesAt(session, inputsProbe(shader));
  const std::size_t number = requireThread(inputs, name);

  auto instrumented = instrumenter::instrumentRecording(shader, session.target());
  const auto redraw = [&] { return followThreadByProbes(session, name); };
  ThreadRun run;
  if (auto* recording = std::get_if<instrumenter::RecordingShader>(&instrumented)) {
    Prepared program = session.prepare(*recording);
    const auto [recorded, which] =
        recordThread(session, {std::move(*recording), std::move(program)}, inputs, number);
    if (which < 0)
      throw Error(Outcome::failed, "the draw does not run this thread again; its run cannot be shown");
    const instrumenter::ThreadRecording& thread = recorded.recording.threads[static_cast<std::size_t>(which)];
    run.steps = stepsOf(shader, recorded.layout, thread);
    run.complete = thread.complete;
    run.check = recorded.execution.check;
    run = trusted(std::move(run), redraw);
  } else {
    run = redraw();
  }
  for (const WatchedValues& one : inputs.identity) run.identity.push_back({one.name, one.valueAt(number)});
  std::string ambiguous;
  run.inputs = inputsOf(shader, inputs, number, ambiguous);
  run.check.merge(inputs.check);
  if (!ambiguous.empty())
    run.check.left_out += (run.check.left_out.empty() ? "" : "; ") +
                          ("inputs that differ among the threads with these numbers: " + ambiguous);
  return run;
}

}  // namespace shadestep::session
