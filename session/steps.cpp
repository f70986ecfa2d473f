// Records of a thread -> the steps that a person follows.
#include <algorithm>
#include <map>
#include <set>

#include "session/recorded_visits.h"
#include "session/thread_run.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::CallId;
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
    bool goes_on = false;  // nothing that was recorded ends it
    bool decides = false;  // its condition calls a function, about the iteration that follows
  };
  struct Frame {
    FunctionId function = kNone;
    std::vector<Loop> loops;
    std::map<VariableId, Value> known;
    // Of the statement that is being run:
    StatementId running = kNone;    // if it was announced
    std::vector<CallId> announced;  // calls not yet entered, the next one last
    std::vector<Step::Choice> choices;
    std::set<VariableId> declared;
  };

  const frontend::Statement& statement(StatementId id) const {
    return shader_.statements[static_cast<std::size_t>(id)];
  }
  const frontend::Function& function(FunctionId id) const {
    return shader_.functions[static_cast<std::size_t>(id)];
  }
  const frontend::Call& call(CallId id) const { return shader_.calls[static_cast<std::size_t>(id)]; }
  const frontend::Token& token(frontend::TokenIndex i) const {
    return shader_.tokens[static_cast<std::size_t>(i)];
  }

  // ---- loops

  bool encloses(StatementId outer, StatementId inner) const {
    while (inner != kNone && inner != outer) inner = statement(inner).parent;
    return inner == outer;
  }

  void leaveLoopsAround(StatementId id) {
    auto& loops = stack_.back().loops;
    while (!loops.empty() && !encloses(loops.back().statement, id)) leaveLoop();
  }

  void leaveLoop() {
    const Loop loop = stack_.back().loops.back();
    if (loop.goes_on) {
      RecordLayout at;
      at.statement = loop.statement;
      push(Step::Kind::cut, at);
    }
    stack_.back().loops.pop_back();
  }

  void noteBreak(StatementId id) {
    if (statement(id).kind != StatementKind::break_) return;
    StatementId target = statement(id).parent;
    while (target != kNone && !isLoop(statement(target).kind) &&
           statement(target).kind != StatementKind::switch_)
      target = statement(target).parent;
    for (Loop& loop : stack_.back().loops)
      if (loop.statement == target) loop.goes_on = false;
  }

  std::vector<int> iterations() const {
    std::vector<int> result;
    for (const Frame& frame : stack_) {
      for (const Loop& loop : frame.loops)
        result.push_back(loop.decides ? loop.iteration + 1 : std::max(loop.iteration, 0));
    }
    return result;
  }

  // ---- values

  // Remembers a value; true if it is new or different.
  bool changes(VariableId variable, const Value& value) {
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

  // True the first time in a declaration that it declares the variable.
  bool declares(const RecordLayout& layout, VariableId variable) {
    if (layout.event != Event::statement && layout.event != Event::declarator) return false;
    const auto& declarators = statement(layout.statement).declarators;
    const bool declared =
        std::any_of(declarators.begin(), declarators.end(),
                    [&](const frontend::Declarator& one) { return one.variable == variable; });
    return declared && variable != kNone && stack_.back().declared.insert(variable).second;
  }

  // All values, or those that changed and those that are declared.
  void addChanges(Step& step, const RecordLayout& layout, const Record& record, std::size_t first,
                  bool all = false) {
    for (std::size_t i = first; i < layout.fields.size(); ++i) {
      const VariableId variable = recordedVariable(shader_, layout, layout.fields[i].name);
      const bool differs = changes(variable, record.values[i]);
      const bool declared = declares(layout, variable);
      const bool is_global =
          variable != kNone &&
          shader_.variables[static_cast<std::size_t>(variable)].storage == frontend::Storage::global;
      if (differs || declared || (all && !is_global))
        step.changed.push_back({layout.fields[i].name, record.values[i]});
    }
    step.left_out = layout.left_out;
  }

  // ---- steps

  Step& push(Step::Kind kind, const RecordLayout& layout) {
    Step step;
    step.kind = kind;
    step.statement = layout.statement;
    const FunctionId in = layout.function != kNone ? layout.function : stack_.back().function;
    step.function = function(in).name;
    step.depth = static_cast<int>(stack_.size()) - 1;
    step.iteration = iterations();
    const bool at_function = kind == Step::Kind::enter || kind == Step::Kind::leave;
    frontend::Place place;
    if (layout.event == Event::declarator) {
      place = token(layout.token).place;
    } else if (layout.statement != kNone && !at_function) {
      place = statement(layout.statement).place;
    } else if (function(in).name_token != kNone) {
      place = token(function(in).name_token).place;
    }
    step.line = place.line;
    step.column = place.column;
    steps_.push_back(std::move(step));
    return steps_.back();
  }

  // A step that ends what the statement evaluates: the choices made on the way belong to it.
  Step& complete(Step::Kind kind, const RecordLayout& layout) {
    const bool called_nothing = !steps_.empty() && steps_.back().kind == Step::Kind::call &&
                                steps_.back().statement == layout.statement;
    if (called_nothing) steps_.pop_back();  // the operands with its calls did not run
    Step& step = push(kind, layout);
    step.choices = std::move(stack_.back().choices);
    stack_.back().choices.clear();
    stack_.back().running = kNone;
    stack_.back().announced.clear();
    return step;
  }

  // The call that leads into a function: the last one announced, or the only one of the statement.
  CallId callInto(FunctionId callee) {
    if (stack_.empty()) return kNone;
    Frame& caller = stack_.back();
    if (!caller.announced.empty() && call(caller.announced.back()).callee == callee) {
      const CallId id = caller.announced.back();
      caller.announced.pop_back();
      return id;
    }
    CallId only = kNone;
    if (caller.running == kNone) return only;
    for (const CallId id : statement(caller.running).calls) {
      if (call(id).callee != callee) continue;
      if (only != kNone) return kNone;
      only = id;
    }
    return only;
  }

  // A condition that is evaluated before the body belongs to the iteration that it admits, and so do its
  // calls.
  bool isInLoopCondition(CallId id) const {
    const StatementId loop = call(id).statement;
    if (loop == kNone || stack_.back().loops.empty() || stack_.back().loops.back().statement != loop)
      return false;
    const frontend::Statement& at = statement(loop);
    return at.kind != StatementKind::do_while && call(id).name >= at.expression.first &&
           call(id).name <= at.expression.last;
  }

  void enter(const RecordLayout& layout, const Record& record) {
    const CallId from = callInto(layout.function);
    if (from != kNone && isInLoopCondition(from)) stack_.back().loops.back().decides = true;
    stack_.push_back({layout.function, {}, {}, kNone, {}, {}, {}});
    if (layout.function == shader_.main) return;
    Step& step = push(Step::Kind::enter, layout);
    step.call = from;
    addChanges(step, layout, record, 0, true);
  }

  void decide(const RecordLayout& layout, const Record& record) {
    Step& step = complete(Step::Kind::condition, layout);
    // A for or while asks before its body begins: the condition belongs to the iteration that it admits.
    const StatementKind kind = statement(layout.statement).kind;
    auto& loops = stack_.back().loops;
    if ((kind == StatementKind::for_ || kind == StatementKind::while_) && !step.iteration.empty())
      step.iteration.back() = loops.back().iteration + 1;
    if (isLoop(kind) && !loops.empty()) loops.back().goes_on = record.values.at(0).words.at(0) != 0;
    step.outcome = formatValue(record.values.at(0));
    addChanges(step, layout, record, 1);
  }

  void choose(const RecordLayout& layout, const Record& record) {
    const frontend::Token& at = token(layout.token);
    stack_.back().choices.push_back({at.text == "?" ? "?:" : at.text, at.place.line, at.place.column,
                                     record.values.at(0).words.at(0) != 0});
  }

  void take(const Record& record) {
    const RecordLayout& layout = layout_.records[static_cast<std::size_t>(record.layout)];
    if (layout.event == Event::function_enter) return enter(layout, record);
    if (stack_.empty()) return;
    if (layout.statement != kNone) leaveLoopsAround(layout.statement);
    if (!stack_.back().loops.empty()) stack_.back().loops.back().decides = false;

    switch (layout.event) {
      case Event::before:
        if (isLoop(statement(layout.statement).kind)) {
          auto& loops = stack_.back().loops;
          if (!loops.empty() && loops.back().statement == layout.statement) leaveLoop();
          loops.push_back({layout.statement, -1, false});
        } else {
          stack_.back().running = layout.statement;
          push(Step::Kind::call, layout);
        }
        break;
      case Event::iteration:
        if (stack_.back().loops.empty()) break;
        ++stack_.back().loops.back().iteration;
        stack_.back().loops.back().goes_on = true;
        break;
      case Event::condition:
        decide(layout, record);
        break;
      case Event::declarator:
        addChanges(push(Step::Kind::declarator, layout), layout, record, 0);
        break;
      case Event::statement:
        addChanges(complete(Step::Kind::statement, layout), layout, record, 0);
        stack_.back().declared.clear();
        break;
      case Event::return_: {
        Step& step = complete(Step::Kind::return_, layout);
        const bool has_value = !layout.fields.empty() && layout.fields[0].name == "return";
        if (has_value) step.changed.push_back({"return", record.values[0]});
        addChanges(step, layout, record, has_value ? 1 : 0);
        stack_.pop_back();
        break;
      }
      case Event::function_leave:
        if (layout.function != shader_.main) addChanges(push(Step::Kind::leave, layout), layout, record, 0);
        stack_.pop_back();
        break;
      case Event::jump:
        push(Step::Kind::jump, layout);
        noteBreak(layout.statement);
        break;
      case Event::call:
        stack_.back().announced.push_back(layout.call);
        break;
      case Event::choice:
        choose(layout, record);
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

std::vector<Step> stepsOf(const Shader& shader, const instrumenter::RecordingLayout& layout,
                          const instrumenter::ThreadRecording& thread) {
  return Follower(shader, layout).follow(thread);
}

}  // namespace shadestep::session
