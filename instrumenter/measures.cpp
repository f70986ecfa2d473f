// Whole-thread measures: loops, executed statements, clock ticks.
#include <map>
#include <set>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/loop.h"
#include "instrumenter/constructs/statement.h"
#include "instrumenter/measures.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Type;

namespace {

// Numbers of the thread's run that are captured at its end. They are ints in the shader (there is no uint
// below 1.30) and uints to the reader.
class Measures {
 public:
  Measures(Draft& draft, const Target& target) : draft_(draft), attachments_(draft, target) {
    failure_ = attachments_.failure();
  }

  // `value`: an int or uint expression at the end of the thread.
  void add(const std::string& name, const std::string& value) {
    Type type;
    type.basic = frontend::Basic::uint_;
    if (!attachments_.add(name, type) && failure_.empty())
      failure_ = "So many counts do not fit into " + attachments_.place() +
                 " at once; ask for fewer (there was no room from '" + name + "' on).";
    values_.push_back(value);
  }
  // The same with a counter of its own, which starts at zero.
  std::string addCounter(const std::string& name) {
    const std::string counter = draft_.name("count" + std::to_string(values_.size()));
    draft_.declare(draft_.highp() + "int " + counter + " = 0;");
    add(name, counter);
    return counter;
  }
  const std::string& failure() const { return failure_; }

  // `start`, `end`: further statements of the new main.
  Result<AttachmentShader> finish(const std::string& start = "", const std::string& end = "") {
    if (!failure_.empty()) return Failure{failure_};
    attachments_.declare();
    attachments_.frame(start, end + assign());
    return text();
  }
  // The thread does these statements instead of the shader's own.
  Result<AttachmentShader> finishInstead(const std::string& statements) {
    if (!failure_.empty()) return Failure{failure_};
    attachments_.declare();
    attachments_.frameInstead(statements + assign());
    return text();
  }

 private:
  std::string assign() const { return "  " + attachments_.assign(kLaunched | kReached, values_) + ";\n"; }
  Result<AttachmentShader> text() {
    auto text = draft_.finish();
    if (auto* failure = std::get_if<Failure>(&text)) return *failure;
    return AttachmentShader{std::move(std::get<std::string>(text)), attachments_.layout()};
  }

  Draft& draft_;
  Attachments attachments_;
  std::string failure_;
  std::vector<std::string> values_;
};

bool exists(const Shader& shader, StatementId id) {
  return id >= 0 && static_cast<std::size_t>(id) < shader.statements.size();
}

// Each time the statement runs: `count` once; loops count each evaluation of their condition.
void countRuns(Draft& draft, Conditions& conditions, StatementId id, const std::string& count) {
  const Shader& shader = draft.shader();
  const StatementKind kind = statementAt(shader, id).kind;
  if (hasCondition(kind)) {
    if (kind == StatementKind::switch_)
      putAround(draft.edits, shader, id, count + "++;", "");
    else
      conditions.putBefore(draft.edits, id, count + "++");
  } else if (isForInit(shader, id)) {
    putAround(draft.edits, shader, statementAt(shader, id).parent, count + "++;", "");
  } else {
    putAround(draft.edits, shader, id, count + "++;", "");
  }
}

bool isCounted(const Statement& statement) {
  return statement.function != frontend::kNone && statement.kind != StatementKind::block &&
         statement.kind != StatementKind::case_label;
}

// "" if it can be counted.
std::string whyNotCounted(const Shader& shader, const std::vector<TextureFetch>& fetches,
                          const Counted& counted) {
  const std::string number = std::to_string(counted.id);
  switch (counted.kind) {
    case Counted::Kind::runs:
      if (exists(shader, counted.id) && isCounted(statementAt(shader, counted.id))) return "";
      return "Statement number " + number + " is no step that could be counted.";
    case Counted::Kind::taken:
      if (exists(shader, counted.id) && hasCondition(statementAt(shader, counted.id).kind) &&
          statementAt(shader, counted.id).kind != StatementKind::switch_)
        return "";
      return "Statement number " + number + " has no condition.";
    case Counted::Kind::entered:
      if (counted.id >= 0 && static_cast<std::size_t>(counted.id) < shader.functions.size() &&
          shader.functions[static_cast<std::size_t>(counted.id)].body != frontend::kNone)
        return "";
      return "There is no function number " + number + ".";
    case Counted::Kind::fetched:
      if (counted.id >= 0 && static_cast<std::size_t>(counted.id) < fetches.size()) return "";
      return "There is no texture lookup number " + number + ".";
  }
  return "";
}

void count(Draft& draft, Conditions& conditions, const std::vector<TextureFetch>& fetches,
           const Counted& counted, const std::string& counter) {
  switch (counted.kind) {
    case Counted::Kind::runs:
      return countRuns(draft, conditions, counted.id, counter);
    case Counted::Kind::taken:
      return conditions.putAfter(draft.edits, counted.id,
                                 counter + " += int(" + conditions.outcome(counted.id) + ")");
    case Counted::Kind::entered: {
      const frontend::Function& function = draft.shader().functions[static_cast<std::size_t>(counted.id)];
      return putAtBodyStart(draft.edits, draft.shader(), function.body, counter + "++;");
    }
    case Counted::Kind::fetched: {
      const TextureFetch& fetch = fetches[static_cast<std::size_t>(counted.id)];
      return draft.edits.wrap({fetch.name, fetch.close}, "(" + counter + "++, ", ")");
    }
  }
}

}  // namespace

namespace {

// A loop goes on from the start of a body until its condition fails or a `break` leaves it; other jumps out
// of it do not come to what stands behind it. Where it still goes on there, the driver has ended it.
void countCuts(Draft& draft, Conditions& conditions, StatementId loop, const std::string& cut) {
  const Shader& shader = draft.shader();
  const std::string goes_on = draft.name("goes_on" + std::to_string(loop));
  draft.declare("bool " + goes_on + ";");
  putAround(draft.edits, shader, loop, goes_on + " = false;", "if (" + goes_on + ") " + cut + "++;");
  putAtBodyStart(draft.edits, shader, statementAt(shader, loop).children.back(), goes_on + " = true;");
  conditions.putAfter(draft.edits, loop, goes_on + " = " + conditions.outcome(loop));
  for (const StatementId jump : breaksOf(shader, loop))
    putAround(draft.edits, shader, jump, goes_on + " = false;", "");
}

}  // namespace

Result<AttachmentShader> instrumentLoops(const Shader& shader, const std::vector<StatementId>& loops,
                                         const Target& target) {
  Draft draft(shader);
  Conditions conditions(draft);
  Measures measures(draft, target);
  // Outer loops first, as the edits need them; a statement has a smaller number than what it holds.
  for (const StatementId loop : std::set<StatementId>(loops.begin(), loops.end())) {
    if (!exists(shader, loop) || !isLoop(statementAt(shader, loop).kind))
      return Failure{"Statement number " + std::to_string(loop) + " is no loop."};
    const std::string name = std::to_string(loop);
    const std::string entries = measures.addCounter(name + ".entries");
    const std::string iterations = measures.addCounter(name + ".iterations");
    const std::string longest = measures.addCounter(name + ".longest");
    const std::string current = draft.name("current" + name);
    draft.declare(draft.highp() + "int " + current + ";");
    countCuts(draft, conditions, loop, measures.addCounter(name + ".cut"));
    putAround(draft.edits, shader, loop, entries + "++; " + current + " = 0;", "");
    putAtBodyStart(draft.edits, shader, statementAt(shader, loop).children.back(),
                   iterations + "++; " + current + "++; if (" + current + " > " + longest + ") " + longest +
                       " = " + current + ";");
  }
  return measures.finish();
}

std::string nameOf(const Counted& counted) {
  constexpr const char* kKinds[] = {"runs.", "taken.", "entered.", "fetched."};
  return kKinds[static_cast<int>(counted.kind)] + std::to_string(counted.id);
}

Result<AttachmentShader> instrumentCount(const Shader& shader, const std::vector<Counted>& asked,
                                         const Target& target) {
  Draft draft(shader);
  Conditions conditions(draft);
  Measures measures(draft, target);
  if (asked.empty()) {
    const std::string steps = measures.addCounter("steps");
    for (std::size_t i = 0; i < shader.statements.size(); ++i)
      if (isCounted(shader.statements[i])) countRuns(draft, conditions, static_cast<StatementId>(i), steps);
  }
  const std::vector<TextureFetch> fetches = textureFetches(shader);
  std::map<Counted, std::string> counters;
  for (const Counted& counted : asked) {
    const std::string reason = whyNotCounted(shader, fetches, counted);
    if (!reason.empty()) return Failure{reason};
    if (!counters.contains(counted)) counters[counted] = measures.addCounter(nameOf(counted));
  }
  for (const auto& [counted, counter] : counters) count(draft, conditions, fetches, counted, counter);
  return measures.finish();
}

std::optional<ShaderClock> shaderClock(const Target& target) {
  if (target.shader_clock) return ShaderClock{"GL_ARB_shader_clock", "clock2x32ARB"};
  if (target.realtime_clock) return ShaderClock{"GL_EXT_shader_realtime_clock", "clockRealtime2x32EXT"};
  return {};
}

namespace {

// The GLSL statements of the two readings of a thread, whose difference is then added to the measures.
struct Readings {
  std::string start, end, failure;
};

Readings addReadings(Draft& draft, Measures& measures, const Target& target) {
  if (draft.es()) return {"", "", "GLSL ES has no shader clock; use another method of profiling."};
  const std::optional<ShaderClock> clock = shaderClock(target);
  if (!clock)
    return {
        "", "",
        "This driver has neither GL_ARB_shader_clock nor GL_EXT_shader_realtime_clock; use another method of "
        "profiling."};
  draft.require(clock->extension);
  const std::string start = draft.name("start"), end = draft.name("end"), now = clock->function + "()";
  // Below 1.30 there is no uint: the low words differ by the ticks modulo 2^32, which an int holds as well.
  if (draft.shader().version < 130) {
    draft.declare("int " + start + ", " + end + ";");
    measures.add("low", end + " - " + start);
    measures.add("high", "0");
    measures.add("start_high", "0");
    return {"  " + start + " = int(" + now + ".x);\n", "  " + end + " = int(" + now + ".x);\n", ""};
  }
  draft.declare(draft.highp() + "uvec2 " + start + ", " + end + ";");
  measures.add("low", end + ".x - " + start + ".x");
  measures.add("high", end + ".y - " + start + ".y - (" + end + ".x < " + start + ".x ? 1u : 0u)");
  measures.add("start_high", start + ".y");
  return {"  " + start + " = " + now + ";\n", "  " + end + " = " + now + ";\n", ""};
}

}  // namespace

Result<AttachmentShader> instrumentClock(const Shader& shader, const Target& target) {
  Draft draft(shader);
  Measures measures(draft, target);
  const Readings readings = addReadings(draft, measures, target);
  if (!readings.failure.empty()) return Failure{readings.failure};
  return measures.finish(readings.start, readings.end);
}

Result<KnownWork> instrumentKnownWork(const Shader& shader, const Target& target, bool clocked) {
  Draft draft(shader);
  Measures measures(draft, target);
  Readings readings;
  if (clocked) readings = addReadings(draft, measures, target);
  if (!readings.failure.empty()) return Failure{readings.failure};
  const std::string work = draft.name("work"), x = draft.name("x"), i = draft.name("i");
  const std::string precision = draft.highp();
  draft.declare("uniform " + precision + "int " + work + ";\n" + precision + "float " + x + ";");
  measures.add("result", "int(" + x + " * 1000.0)");  // so that no compiler leaves the chain out
  auto instead = measures.finishInstead(readings.start + "  " + x + " = 0.3;\n  for (int " + i + " = 0; " +
                                        i + " < " + work + "; ++" + i + ") " + x + " = 3.7 * " + x +
                                        " * (1.0 - " + x + ");\n" + readings.end);
  if (auto* failure = std::get_if<Failure>(&instead)) return *failure;
  return KnownWork{std::move(std::get<AttachmentShader>(instead)), work};
}

}  // namespace shadestep::instrumenter
