#include "session/thread_run.h"

#include <algorithm>
#include <map>

#include "session/probed_run.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::FunctionId;
using frontend::kNone;
using frontend::Shader;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::VariableId;
using instrumenter::Event;
using instrumenter::Record;
using instrumenter::RecordLayout;
using instrumenter::Value;

bool isLoop(StatementKind kind) {
  return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
}

// Turns records into steps. It keeps what the records leave out because it follows from their order: the call
// stack, the loops that the thread is in, and the last known value of every variable.
class Follower {
 public:
  Follower(const Shader& shader, const instrumenter::RecordingLayout& layout)
      : shader_(shader), layout_(layout) {}

  std::vector<Step> follow(const instrumenter::ThreadRecording& thread) {
    for (const Record& record : thread.records) take(record);
    return std::move(steps_);
  }

 private:
  struct Loop {
    StatementId statement = kNone;
    int iteration = -1;
  };
  struct Frame {
    FunctionId function = kNone;
    std::vector<Loop> loops;
    std::map<VariableId, Value> known;
  };

  const frontend::Statement& statement(StatementId id) const {
    return shader_.statements[static_cast<std::size_t>(id)];
  }
  const frontend::Function& function(FunctionId id) const {
    return shader_.functions[static_cast<std::size_t>(id)];
  }

  bool encloses(StatementId outer, StatementId inner) const {
    while (inner != kNone && inner != outer) inner = statement(inner).parent;
    return inner == outer;
  }

  void leaveLoopsAround(StatementId id) {
    auto& loops = stack_.back().loops;
    while (!loops.empty() && !encloses(loops.back().statement, id)) loops.pop_back();
  }

  std::vector<int> iterations() const {
    std::vector<int> result;
    for (const Frame& frame : stack_) {
      for (const Loop& loop : frame.loops) result.push_back(std::max(loop.iteration, 0));
    }
    return result;
  }

  // The variable that a field's name means at the step.
  VariableId variableOf(const RecordLayout& layout, const std::string& name) const {
    const auto named = [&](VariableId id) {
      return id != kNone && shader_.variables[static_cast<std::size_t>(id)].name == name;
    };
    if (layout.statement != kNone) {
      const frontend::Statement& at = statement(layout.statement);
      for (const auto& declarator : at.declarators) {
        if (named(declarator.variable)) return declarator.variable;
      }
      if (at.init != kNone) {
        for (const auto& declarator : statement(at.init).declarators) {
          if (named(declarator.variable)) return declarator.variable;
        }
      }
      const auto found = std::find_if(at.scope.rbegin(), at.scope.rend(), named);
      if (found != at.scope.rend()) return *found;
    }
    return kNone;
  }

  // Remembers a value; true if it is new or different.
  bool changes(const RecordLayout& layout, const std::string& name, const Value& value) {
    const VariableId variable = variableOf(layout, name);
    if (variable == kNone) return true;
    const frontend::Storage storage = shader_.variables[static_cast<std::size_t>(variable)].storage;
    const bool is_local = storage == frontend::Storage::local || storage == frontend::Storage::parameter;
    auto& known = is_local ? stack_.back().known : globals_;
    const auto [at, is_new] = known.try_emplace(variable, value);
    if (is_new) return true;
    if (at->second == value) return false;
    at->second = value;
    return true;
  }

  Step& push(Step::Kind kind, const RecordLayout& layout) {
    Step step;
    step.kind = kind;
    step.statement = layout.statement;
    const FunctionId in = layout.function != kNone ? layout.function : stack_.back().function;
    step.function = function(in).name;
    step.depth = static_cast<int>(stack_.size()) - 1;
    step.iteration = iterations();
    const bool at_function = kind == Step::Kind::enter || kind == Step::Kind::leave;
    if (layout.statement != kNone && !at_function) {
      step.line = statement(layout.statement).place.line;
      step.column = statement(layout.statement).place.column;
    } else if (const frontend::TokenIndex name = function(in).name_token; name != kNone) {
      const frontend::Place place = shader_.tokens[static_cast<std::size_t>(name)].place;
      step.line = place.line;
      step.column = place.column;
    }
    steps_.push_back(std::move(step));
    return steps_.back();
  }

  void addChanges(Step& step, const RecordLayout& layout, const Record& record, std::size_t first, bool all) {
    for (std::size_t i = first; i < layout.fields.size(); ++i) {
      const bool differs = changes(layout, layout.fields[i].name, record.values[i]);
      const VariableId variable = variableOf(layout, layout.fields[i].name);
      const bool is_global =
          variable != kNone &&
          shader_.variables[static_cast<std::size_t>(variable)].storage == frontend::Storage::global;
      if (differs || (all && !is_global)) step.changed.push_back({layout.fields[i].name, record.values[i]});
    }
  }

  void take(const Record& record) {
    const RecordLayout& layout = layout_.records[static_cast<std::size_t>(record.layout)];
    if (layout.event == Event::function_enter) {
      stack_.push_back({layout.function, {}, {}});
      if (layout.function == shader_.main) return;
      addChanges(push(Step::Kind::enter, layout), layout, record, 0, true);
      return;
    }
    if (stack_.empty()) return;
    if (layout.statement != kNone) leaveLoopsAround(layout.statement);

    switch (layout.event) {
      case Event::before:
        if (isLoop(statement(layout.statement).kind)) {
          auto& loops = stack_.back().loops;
          if (!loops.empty() && loops.back().statement == layout.statement) loops.pop_back();
          loops.push_back({layout.statement, -1});
        } else {
          push(Step::Kind::call, layout);
        }
        break;
      case Event::iteration:
        if (!stack_.back().loops.empty()) ++stack_.back().loops.back().iteration;
        break;
      case Event::condition: {
        Step& step = push(Step::Kind::condition, layout);
        // A for or while asks before its body begins: the condition belongs to the iteration that it admits.
        const StatementKind kind = statement(layout.statement).kind;
        if ((kind == StatementKind::for_ || kind == StatementKind::while_) && !step.iteration.empty()) {
          step.iteration.back() = stack_.back().loops.back().iteration + 1;
        }
        if (!layout.fields.empty()) step.outcome = formatValue(record.values[0]);
        addChanges(step, layout, record, 1, false);
        break;
      }
      case Event::statement: {
        const bool declares = statement(layout.statement).kind == StatementKind::declaration;
        addChanges(push(Step::Kind::statement, layout), layout, record, 0, declares);
        break;
      }
      case Event::return_: {
        Step& step = push(Step::Kind::return_, layout);
        const bool has_value = !layout.fields.empty() && layout.fields[0].name == "return";
        if (has_value) step.changed.push_back({"return", record.values[0]});
        addChanges(step, layout, record, has_value ? 1 : 0, false);
        stack_.pop_back();
        break;
      }
      case Event::function_leave:
        if (layout.function != shader_.main)
          addChanges(push(Step::Kind::leave, layout), layout, record, 0, false);
        stack_.pop_back();
        break;
      case Event::jump:
        push(Step::Kind::jump, layout);
        break;
      case Event::function_enter:
        break;
    }
  }

  const Shader& shader_;
  const instrumenter::RecordingLayout& layout_;
  std::vector<Step> steps_;
  std::vector<Frame> stack_;
  std::map<VariableId, Value> globals_;
};

}  // namespace

std::vector<Step> stepsOf(const frontend::Shader& shader, const instrumenter::RecordingLayout& layout,
                          const instrumenter::ThreadRecording& thread) {
  return Follower(shader, layout).follow(thread);
}

const char* kindName(Step::Kind kind) {
  switch (kind) {
    case Step::Kind::statement:
      return "statement";
    case Step::Kind::condition:
      return "condition";
    case Step::Kind::call:
      return "call";
    case Step::Kind::enter:
      return "enter";
    case Step::Kind::leave:
      return "leave";
    case Step::Kind::return_:
      return "return";
    case Step::Kind::jump:
      return "jump";
  }
  return "?";
}

std::vector<ThreadRun::Output> outputsAt(const Execution& execution, int x, int y) {
  const std::size_t pixel = (static_cast<std::size_t>(y) * static_cast<std::size_t>(execution.width) +
                             static_cast<std::size_t>(x)) *
                            4;
  std::vector<ThreadRun::Output> outputs;
  for (const ColorOutput& output : execution.outputs) {
    const auto first = output.words.begin() + static_cast<std::ptrdiff_t>(pixel);
    outputs.push_back({output.draw_buffer, {output.type, {first, first + 4}}});
  }
  return outputs;
}

// Which fragment the pixel shows is written to the attachment by the fragment itself.
int visibleThread(const Session::Recorded& recorded, int x, int y) {
  const instrumenter::AttachmentLayout& attachment = recorded.layout.attachment;
  const std::uint32_t* words = recorded.visible.at(x, y);
  if (instrumenter::decodeMark(attachment, words) == 0) return -1;
  const std::uint32_t shown = instrumenter::decode(attachment, attachment.fields.at(0), words).words.at(0);
  const auto& threads = recorded.recording.threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    if (threads[i].invocation == shown) return static_cast<int>(i);
  }
  return -1;
}

PixelHits hitsOn(const Session::Recorded& recorded, int x, int y) {
  PixelHits hits;
  hits.count = static_cast<int>(recorded.recording.threads.size());
  hits.visible = visibleThread(recorded, x, y);
  for (const auto& thread : recorded.recording.threads) hits.discarded.push_back(thread.discarded);
  return hits;
}

int pickHit(const PixelHits& hits, int x, int y, int hit) {
  if (hit >= hits.count) {
    throw Error(Outcome::nothing_matches,
                "no hit " + std::to_string(hit) + " on pixel " + std::to_string(x) + "," + std::to_string(y) +
                    ", which has " + std::to_string(hits.count) + ": 0 to " + std::to_string(hits.count - 1));
  }
  return hit >= 0 ? hit : hits.visible >= 0 ? hits.visible : hits.count - 1;
}

namespace {

void requireInside(Session& session, int x, int y) {
  const DrawFacts& facts = session.facts();
  if (x >= 0 && y >= 0 && x < facts.width && y < facts.height) return;
  throw Error(Outcome::nothing_matches, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                            " is outside the target of " + std::to_string(facts.width) +
                                            " x " + std::to_string(facts.height) + " pixels");
}

Session::Recorded recordPixel(Session& session, const Session::PreparedRecording& prepared, int x, int y) {
  Session::Recorded recorded = session.record(prepared, x, y, 1, 1);
  if (!recorded.recording.threads.empty()) return recorded;
  const DrawFacts& facts = session.facts();
  throw Error(Outcome::nothing_matches,
              "the draw has no fragment on pixel " + std::to_string(x) + "," + std::to_string(y) +
                  " (viewport " + std::to_string(facts.viewport[0]) + "," +
                  std::to_string(facts.viewport[1]) + " " + std::to_string(facts.viewport[2]) + " x " +
                  std::to_string(facts.viewport[3]) + "); pick one that it covers");
}

}  // namespace

Session::Recorded recordPixel(Session& session, int x, int y) {
  requireInside(session, x, y);
  return recordPixel(session, session.prepareRecording(), x, y);
}

ThreadRun followPixel(Session& session, int x, int y, int hit) {
  requireInside(session, x, y);
  std::optional<Session::PreparedRecording> prepared;
  try {
    prepared.emplace(session.prepareRecording());
  } catch (const Error& error) {
    // No storage buffers in this driver or dialect, or none left: the visible fragment can be followed all
    // the same.
    if (error.outcome() != Outcome::cannot_debug || hit > 0) throw;
  }
  if (!prepared) return followPixelByProbes(session, x, y);
  const Session::Recorded recorded = recordPixel(session, *prepared, x, y);
  const PixelHits hits = hitsOn(recorded, x, y);
  const int chosen = pickHit(hits, x, y, hit);

  const instrumenter::ThreadRecording& thread = recorded.recording.threads[static_cast<std::size_t>(chosen)];
  ThreadRun run;
  run.x = x;
  run.y = y;
  run.hit = chosen;
  run.hits = hits.count;
  run.visible_hit = hits.visible;
  run.visible = chosen == hits.visible;
  run.discarded = thread.discarded;
  run.steps = stepsOf(session.shader(Stage::fragment), recorded.layout, thread);
  run.outputs = outputsAt(recorded.execution, x, y);
  run.check = recorded.execution.check;
  return run;
}

}  // namespace shadestep::session
