#include "session/recorded_visits.h"

#include <algorithm>
#include <set>

namespace shadestep::session {
namespace {

using frontend::kNone;
using frontend::Shader;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::VariableId;
using instrumenter::Event;
using instrumenter::Probe;
using instrumenter::Record;
using instrumenter::RecordLayout;
using instrumenter::Value;

bool isLoop(StatementKind kind) {
  return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
}

// Follows a thread's records. Functions are never entered twice at once (GLSL has no recursion), so one table
// holds the variables of all of them: a variable is looked at only where it is in scope, and its declaration
// there was recorded again.
class Walk {
 public:
  Walk(const Shader& shader, const instrumenter::RecordingLayout& layout,
       const std::function<void(const Visit&)>& visit)
      : shader_(shader), layout_(layout), visit_(visit) {
    for (const RecordLayout& record : layout.records) {
      if (record.event == Event::before) announced_.insert(record.statement);
    }
  }

  void follow(const instrumenter::ThreadRecording& thread) {
    for (const Record& record : thread.records) take(record);
  }

 private:
  struct Loop {
    StatementId statement = kNone;
    int iteration = -1;
  };

  const frontend::Statement& statement(StatementId id) const {
    return shader_.statements[static_cast<std::size_t>(id)];
  }
  const frontend::Variable& variable(VariableId id) const {
    return shader_.variables[static_cast<std::size_t>(id)];
  }

  bool encloses(StatementId outer, StatementId inner) const {
    while (inner != kNone && inner != outer) inner = statement(inner).parent;
    return inner == outer;
  }

  void take(const Record& record) {
    const RecordLayout& layout = layout_.records[static_cast<std::size_t>(record.layout)];
    if (layout.event == Event::function_enter) {
      frames_.emplace_back();
      forgetResults(layout.function);
      learn(layout, record, 0);
      return;
    }
    if (frames_.empty()) return;
    std::vector<Loop>& loops = frames_.back();
    const StatementId at = layout.statement;
    while (!loops.empty() && !encloses(loops.back().statement, at)) loops.pop_back();

    switch (layout.event) {
      case Event::before:
        if (!loops.empty() && loops.back().statement == at) loops.pop_back();
        tell(at, Probe::When::before);
        if (isLoop(statement(at).kind)) loops.push_back({at, -1});
        break;
      case Event::iteration:
        if (!loops.empty()) ++loops.back().iteration;
        break;
      case Event::condition: {
        if (!announced_.contains(at)) tell(at, Probe::When::before);
        learn(layout, record, 1);
        // The condition of a for or while belongs to the iteration that it admits.
        const StatementKind kind = statement(at).kind;
        const bool admits = kind == StatementKind::for_ || kind == StatementKind::while_;
        if (admits && !loops.empty()) ++loops.back().iteration;
        tell(at, Probe::When::after, &record.values.at(0));
        if (admits && !loops.empty()) --loops.back().iteration;
        break;
      }
      case Event::statement:
        if (!announced_.contains(at) && begun_.erase(at) == 0) tell(at, Probe::When::before);
        learn(layout, record, 0);
        tell(at, Probe::When::after);
        break;
      case Event::return_:
        if (!announced_.contains(at)) tell(at, Probe::When::before);
        learn(layout, record, 0);
        frames_.pop_back();
        break;
      case Event::jump:
        if (!announced_.contains(at)) tell(at, Probe::When::before);
        break;
      case Event::function_leave:
        learn(layout, record, 0);
        frames_.pop_back();
        break;
      case Event::function_enter:
      case Event::call:
      case Event::choice:
        break;
      case Event::declarator:
        if (!announced_.contains(at) && begun_.insert(at).second) tell(at, Probe::When::before);
        for (std::size_t i = 0; i < layout.fields.size(); ++i) {
          const VariableId id = recordedVariable(shader_, layout, layout.fields[i].name);
          if (id != kNone) remember(layout, id, record.values.at(i));
        }
        break;
    }
  }

  void tell(StatementId at, Probe::When when, const Value* outcome = nullptr) {
    Visit visit;
    visit.statement = at;
    visit.when = when;
    for (const Loop& loop : frames_.back()) visit.iterations.push_back(loop.iteration);
    visit.known = &known_;
    visit.outcome = outcome;
    visit_(visit);
  }

  // Takes the values of a record; what the statement may have changed without a record of it becomes unknown.
  void learn(const RecordLayout& layout, const Record& record, std::size_t first) {
    std::set<VariableId> recorded;
    for (std::size_t i = first; i < layout.fields.size(); ++i) {
      const VariableId id = recordedVariable(shader_, layout, layout.fields[i].name);
      if (id == kNone) continue;
      recorded.insert(id);
      remember(layout, id, record.values.at(i));
    }
    if (layout.statement == kNone || layout.event == Event::function_enter) return;
    const frontend::Statement& at = statement(layout.statement);
    const auto forget = [&](VariableId id) {
      if (!recorded.contains(id)) known_.erase(id);
    };
    std::for_each(at.changes.begin(), at.changes.end(), forget);
    std::for_each(at.init_changes.begin(), at.init_changes.end(), forget);
    std::for_each(at.increment_changes.begin(), at.increment_changes.end(), forget);
    for (const frontend::Declarator& declarator : at.declarators) forget(declarator.variable);
  }

  // What an earlier call put into its `out` parameters is not theirs in this one.
  void forgetResults(frontend::FunctionId function) {
    for (const VariableId id : shader_.functions[static_cast<std::size_t>(function)].parameters)
      if (id != kNone && !shader_.variables[static_cast<std::size_t>(id)].parameter_in) known_.erase(id);
  }

  void remember(const RecordLayout& layout, VariableId id, const Value& value) {
    const bool declared_empty = declaresWithoutValue(layout, id) || isPartOfUndefined(layout, id);
    const auto found = known_.find(id);
    KnownValue next{value, std::vector<bool>(value.words.size(), !declared_empty)};
    if (!declaresWithoutValue(layout, id) && found != known_.end() &&
        found->second.defined.size() == value.words.size()) {
      const KnownValue& last = found->second;
      for (std::size_t i = 0; i < value.words.size(); ++i) {
        next.defined[i] = last.defined[i] || last.value.words[i] != value.words[i];
      }
    }
    known_[id] = std::move(next);
  }

  bool declaresWithoutValue(const RecordLayout& layout, VariableId id) const {
    if (layout.event != Event::statement || layout.statement == kNone) return false;
    for (const frontend::Declarator& declarator : statement(layout.statement).declarators) {
      if (declarator.variable == id) return declarator.initializer.empty();
    }
    return false;
  }

  // Outputs and globals begin undefined; a statement that does not begin with `output =` may write a part of
  // one.
  bool isPartOfUndefined(const RecordLayout& layout, VariableId id) const {
    const frontend::Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
    const bool is_output =
        variable.storage == frontend::Storage::out || variable.storage == frontend::Storage::builtin;
    const bool is_global =
        variable.storage == frontend::Storage::global && !frontend::hasInitializer(shader_, id);
    if ((!is_output && !is_global) || layout.statement == kNone) return false;
    const frontend::TokenIndex first = statement(layout.statement).tokens.first;
    const auto text = [&](frontend::TokenIndex i) {
      return shader_.tokens[static_cast<std::size_t>(i)].text;
    };
    return text(first) != variable.name || text(first + 1) != "=";
  }

  const Shader& shader_;
  const instrumenter::RecordingLayout& layout_;
  const std::function<void(const Visit&)>& visit_;
  std::set<StatementId> announced_;  // have a record of their own before they run
  std::set<StatementId> begun_;      // declarations of which the first names are there
  std::vector<std::vector<Loop>> frames_;
  KnownValues known_;
};

}  // namespace

VariableId recordedVariable(const Shader& shader, const RecordLayout& layout, const std::string& name) {
  const auto named = [&](VariableId id) {
    return id != kNone && shader.variables[static_cast<std::size_t>(id)].name == name;
  };
  if (layout.event == Event::function_enter || layout.event == Event::function_leave) {
    const auto& parameters = shader.functions[static_cast<std::size_t>(layout.function)].parameters;
    const auto found = std::find_if(parameters.begin(), parameters.end(), named);
    if (found != parameters.end()) return *found;
  }
  if (layout.statement == kNone) return kNone;
  const frontend::Statement& at = shader.statements[static_cast<std::size_t>(layout.statement)];
  for (const auto& declarator : at.declarators) {
    if (named(declarator.variable)) return declarator.variable;
  }
  if (at.init != kNone) {
    for (const auto& declarator : shader.statements[static_cast<std::size_t>(at.init)].declarators) {
      if (named(declarator.variable)) return declarator.variable;
    }
  }
  if (layout.event == Event::condition) {
    const VariableId declared = frontend::declaredByCondition(shader, layout.statement);
    if (named(declared)) return declared;
  }
  const auto found = std::find_if(at.scope.rbegin(), at.scope.rend(), named);
  return found != at.scope.rend() ? *found : kNone;
}

void forEachVisit(const Shader& shader, const instrumenter::RecordingLayout& layout,
                  const instrumenter::ThreadRecording& thread,
                  const std::function<void(const Visit&)>& visit) {
  Walk(shader, layout, visit).follow(thread);
}

std::optional<LastVisit> lastVisit(const Shader& shader, const instrumenter::RecordingLayout& layout,
                                   const instrumenter::ThreadRecording& thread, const Probe& probe) {
  std::optional<LastVisit> last;
  forEachVisit(shader, layout, thread, [&](const Visit& visit) {
    if (visit.statement != probe.statement || visit.when != probe.when) return;
    const std::size_t given = std::min(probe.iterations.size(), visit.iterations.size());
    if (!std::equal(probe.iterations.begin(), probe.iterations.begin() + static_cast<std::ptrdiff_t>(given),
                    visit.iterations.begin())) {
      return;
    }
    last.emplace();
    last->known = *visit.known;
    if (visit.outcome != nullptr) last->outcome = *visit.outcome;
  });
  return last;
}

}  // namespace shadestep::session
