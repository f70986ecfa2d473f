#include "instrumenter/recorder.h"

#include <algorithm>
#include <set>

#include "instrumenter/constructs/declaration.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/jump.h"
#include "instrumenter/constructs/loop_bounds.h"
#include "instrumenter/constructs/operators.h"
#include "instrumenter/constructs/statement.h"
#include "instrumenter/constructs/written_place.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Call;
using frontend::CallId;
using frontend::Declarator;
using frontend::Function;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Storage;
using frontend::Type;
using frontend::Variable;

namespace {

bool isRecordable(const Type& type) {
  const int words = frontend::wordCount(type);
  return words > 0 && words <= kWidestRecorded;
}

// Memory that other threads write to as well: of a control shader's outputs too each thread has its part.
bool isShared(const Shader& shader, const Variable& variable) {
  const bool of_patch =
      shader.stage == frontend::Stage::tess_control &&
      ((variable.storage == Storage::out && variable.type.isArray()) || variable.name == "gl_out");
  return of_patch || variable.storage == Storage::buffer || variable.storage == Storage::shared;
}

}  // namespace

// ---- functions

void Recorder::recordFunctions() {
  for (std::size_t i = 0; i < shader_.functions.size(); ++i) {
    const Function& function = shader_.functions[i];
    if (function.body == frontend::kNone) continue;
    std::vector<Item> entering = parameters(function, &Variable::parameter_in);
    const std::vector<Item> more = changedInFlight(static_cast<FunctionId>(i));
    entering.insert(entering.end(), more.begin(), more.end());
    putAtBodyStart(draft_.edits, shader_, function.body,
                   record(Event::function_enter, function.body, entering) + ";");
    const std::vector<StatementId>& children = statementAt(shader_, function.body).children;
    if (!children.empty() && isJump(statementAt(shader_, children.back()).kind)) continue;
    putAtBodyEnd(
        draft_.edits, shader_, function.body,
        record(Event::function_leave, function.body, parameters(function, &Variable::parameter_out)) + ";");
  }
}

std::vector<Item> Recorder::parameters(const Function& function, bool Variable::*direction) const {
  std::vector<Item> items;
  for (const VariableId id : function.parameters)
    if (id != frontend::kNone && shader_.variables[static_cast<std::size_t>(id)].*direction)
      items.push_back(item(id));
  return items;
}

// ---- statements

// Statements stand in token order, a parent before its children, as the edits need them.
void Recorder::recordStatements() {
  for (std::size_t i = 0; i < shader_.statements.size(); ++i) {
    const auto id = static_cast<StatementId>(i);
    const Statement& statement = shader_.statements[i];
    const bool apart = statement.function != frontend::kNone && statement.kind != StatementKind::block &&
                       statement.kind != StatementKind::case_label && !isForInit(shader_, id);
    if (!apart) continue;
    recordStatement(id);
    if (statement.init != frontend::kNone) recordInside(statement.init);
    recordInside(id);
  }
}

void Recorder::recordStatement(StatementId id) {
  const Statement& statement = statementAt(shader_, id);
  std::string before, after;
  if (!statement.calls.empty() || isLoop(statement.kind)) before = record(Event::before, id, {}) + ";";
  switch (statement.kind) {
    case StatementKind::if_:
    case StatementKind::for_:
    case StatementKind::while_:
    case StatementKind::do_while:
    case StatementKind::switch_:
      break;
    case StatementKind::return_:
      return recordReturn(id, before);
    case StatementKind::discard:
    case StatementKind::break_:
    case StatementKind::continue_:
      before += record(Event::jump, id, {}) + ";";
      break;
    default:
      after = record(Event::statement, id, changedBy(statement)) + ";";
  }
  putAround(draft_.edits, shader_, id, before, after);
  if (hasCondition(statement.kind)) recordCondition(id);
  if (isLoop(statement.kind))
    putAtBodyStart(draft_.edits, shader_, statement.children.back(), record(Event::iteration, id, {}) + ";");
  if (statement.kind == StatementKind::declaration) recordDeclarators(id);
}

void Recorder::recordCondition(StatementId id) {
  const Statement& statement = statementAt(shader_, id);
  std::vector<Item> items = {{"", conditions_.outcome(id), outcomeType(shader_, id)}};
  const std::vector<Item> more = statement.kind == StatementKind::for_
                                     ? changedByLoopHead(statement)
                                     : changed(statement.changes, statement.scope, {});
  const VariableId declared = frontend::declaredByCondition(shader_, id);
  if (declared == frontend::kNone) {
    items.insert(items.end(), more.begin(), more.end());
  } else {
    // Its name means something else until its value is there, which is the outcome.
    const std::string name = item(declared).name;
    std::copy_if(more.begin(), more.end(), std::back_inserter(items),
                 [&](const Item& one) { return one.name != name; });
    items.push_back({name, conditions_.outcome(id), outcomeType(shader_, id)});
  }
  std::string after = record(Event::condition, id, items);
  if (mayBeGuessed(shader_, id))
    after += ", " + hideBound(conditions_.outcome(id), draft_.name("invocation") + " < 0");
  conditions_.putAfter(draft_.edits, id, after);
}

void Recorder::recordReturn(StatementId id, const std::string& before) {
  const Statement& statement = statementAt(shader_, id);
  const std::vector<Item> more = changed(statement.changes, statement.scope, {});
  if (statement.expression.empty()) {
    const std::string text = record(Event::return_, id, more) + ";";
    return putAround(draft_.edits, shader_, id, before + text, "");
  }
  std::vector<Item> items = {
      {"return", returnedValue(draft_), functionAt(shader_, statement.function).return_type}};
  items.insert(items.end(), more.begin(), more.end());
  putIntoReturn(draft_.edits, draft_, id, before, record(Event::return_, id, items));
}

// ---- inside of statements

// The declarators of one declaration are steps of their own where their initializers do more than to give the
// value (thesis 7.1.4 splits such declarations): what was declared so far is recorded at the start of the
// next initializer.
void Recorder::recordDeclarators(StatementId id) {
  const Statement& statement = statementAt(shader_, id);
  const bool side_effects =
      !statement.calls.empty() || statement.changes.size() > statement.declarators.size();
  if (!side_effects) return;
  std::vector<Declarator> declared;
  bool initialized = false;
  for (const Declarator& declarator : statement.declarators) {
    const bool can_hold =
        !declarator.initializer.empty() && declarator.variable != frontend::kNone &&
        shader_.tokens[static_cast<std::size_t>(declarator.initializer.first)].text != "{" &&
        fitsIntoSequence(shader_, item(declarator.variable).type);
    if (initialized && can_hold) {
      RecordLayout layout;
      layout.event = Event::declarator;
      layout.statement = id;
      layout.function = statement.function;
      layout.token = declared.back().tokens.first;
      draft_.edits.wrap(declarator.initializer,
                        "(" + record(layout, changed(statement.changes, statement.scope, declared)) + ", ",
                        ")");
      initialized = false;
    }
    initialized = initialized || !declarator.initializer.empty();
    declared.push_back(declarator);
  }
}

// Which operands ran, and which of several calls of one function comes next.
void Recorder::recordInside(StatementId id) {
  RecordLayout layout;
  layout.event = Event::choice;
  layout.statement = id;
  layout.function = statementAt(shader_, id).function;
  Type outcome;
  outcome.basic = frontend::Basic::bool_;
  for (const frontend::TokenRange& range : ownExpressions(shader_, id))
    for (const Choice& choice : choicesIn(shader_, range)) {
      layout.token = choice.at;
      putAfterDecision(draft_.edits, draft_, choice, record(layout, {{"", choiceOutcome(draft_, choice.at), outcome}}));
    }
  if (!isForInit(shader_, id)) recordCalls(id);
}

void Recorder::recordCalls(StatementId id) {
  RecordLayout layout;
  layout.event = Event::call;
  layout.statement = id;
  layout.function = statementAt(shader_, id).function;
  for (const CallId call_id : unclearCalls(id)) {
    const Call& call = shader_.calls[static_cast<std::size_t>(call_id)];
    layout.call = call_id;
    layout.token = call.name;
    draft_.edits.wrap({call.name, call.close}, "(" + record(layout, {}) + ", ", ")");
  }
}

// The calls that the order of records does not tell: those of a loop's head, and several of one function.
std::vector<CallId> Recorder::unclearCalls(StatementId id) const {
  const Statement& statement = statementAt(shader_, id);
  if (statement.kind == StatementKind::opaque) return {};
  std::vector<CallId> calls = statement.calls;
  if (statement.init != frontend::kNone) {
    const std::vector<CallId>& first = statementAt(shader_, statement.init).calls;
    calls.insert(calls.begin(), first.begin(), first.end());
  }
  std::vector<CallId> unclear;
  for (const CallId call_id : calls) {
    const Call& call = shader_.calls[static_cast<std::size_t>(call_id)];
    const Function& callee = functionAt(shader_, call.callee);
    const auto same = [&](CallId other) {
      return shader_.calls[static_cast<std::size_t>(other)].callee == call.callee;
    };
    const bool clear = !isLoop(statement.kind) && std::count_if(calls.begin(), calls.end(), same) == 1;
    if (!clear && callee.body != frontend::kNone && fitsIntoSequence(shader_, callee.return_type))
      unclear.push_back(call_id);
  }
  return unclear;
}

// ---- records

std::string Recorder::record(Event event, StatementId statement, const std::vector<Item>& items) {
  RecordLayout layout;
  layout.event = event;
  layout.statement = statement;
  layout.function = statementAt(shader_, statement).function;
  return record(std::move(layout), items);
}

std::string Recorder::record(RecordLayout layout, const std::vector<Item>& items) {
  const std::string words = draft_.name("words"), at = draft_.name("at");
  std::string writes;
  for (const Item& item : items) {
    if (!isRecordable(item.type)) {
      if (frontend::wordCount(item.type) > 0) layout.left_out.push_back(item.name);
      continue;
    }
    layout.fields.push_back(Field{item.name, item.type, layout.words});
    for (const std::string& word : intWords(draft_, item.expression, item.type)) {
      writes +=
          words + "[" + at + (layout.words > 0 ? " + " + std::to_string(layout.words) : "") + "] = " + word;
      writes += ", ";
      ++layout.words;
    }
  }
  const std::string size = std::to_string(layout.words);
  records_.push_back(std::move(layout));
  const std::string start = draft_.name("record(") + std::to_string(records_.size()) + ", " + size + ")";
  return writes.empty() ? start : "(" + start + " && (" + writes + "true))";
}

// What was changed and can be named behind the statement, then what it declared. A declared name hides a
// changed variable of the same name; memory that other threads write to is no value of this thread's.
std::vector<Item> Recorder::changed(const std::vector<VariableId>& changes,
                                    const std::vector<VariableId>& scope,
                                    const std::vector<Declarator>& declared) const {
  std::set<std::string> hidden;
  for (const Declarator& declarator : declared)
    if (declarator.variable != frontend::kNone) hidden.insert(item(declarator.variable).name);

  const std::set<VariableId> changing(changes.begin(), changes.end());
  std::vector<Item> items;
  for (const VariableId id : scope) {
    const Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
    if (changing.contains(id) && !isShared(shader_, variable) && !hidden.contains(variable.name))
      items.push_back(item(id));
  }
  for (const Declarator& declarator : declared)
    if (declarator.variable != frontend::kNone) items.push_back(item(declarator.variable));
  return items;
}

// Of large arrays and of memory that all threads see, the written part alone.
std::vector<Item> Recorder::changedBy(const Statement& statement) const {
  std::vector<Item> items = changed(statement.changes, statement.scope, statement.declarators);
  const std::optional<WrittenPlace> place = writtenPlace(shader_, statement);
  if (!place || !isRecordable(place->type)) return items;
  const Variable& written = shader_.variables[static_cast<std::size_t>(place->variable)];
  if (!isShared(shader_, written) && isRecordable(written.type)) return items;
  std::erase_if(items, [&](const Item& one) { return one.name == written.name; });
  items.push_back({place->name, withoutFragColor(place->expression), place->type});
  return items;
}

// A `for` has no place for records of its init and increment: they go with the next evaluation of the
// condition.
std::vector<Item> Recorder::changedByLoopHead(const Statement& loop) const {
  std::vector<VariableId> changes = loop.changes;
  changes.insert(changes.end(), loop.init_changes.begin(), loop.init_changes.end());
  changes.insert(changes.end(), loop.increment_changes.begin(), loop.increment_changes.end());
  std::vector<Declarator> declared;
  if (loop.init != frontend::kNone) declared = statementAt(shader_, loop.init).declarators;
  return changed(changes, loop.scope, declared);
}

// What a statement has changed before it calls the function, `(g = 1, f())`, has no record yet when the
// function runs.
std::vector<Item> Recorder::changedInFlight(FunctionId callee) const {
  std::vector<VariableId> changes;
  for (const frontend::Call& call : shader_.calls) {
    if (call.callee != callee || call.statement == frontend::kNone) continue;
    const Statement& at = statementAt(shader_, call.statement);
    std::vector<VariableId> candidates = at.changes;
    candidates.insert(candidates.end(), at.init_changes.begin(), at.init_changes.end());
    candidates.insert(candidates.end(), at.increment_changes.begin(), at.increment_changes.end());
    for (const VariableId id : candidates)
      if (at.calls.size() > 1 || names(at, id)) changes.push_back(id);
  }
  const Function& function = functionAt(shader_, callee);
  std::vector<VariableId> scope = statementAt(shader_, function.body).scope;
  const auto isOwn = [&](VariableId id) {
    return std::find(function.parameters.begin(), function.parameters.end(), id) != function.parameters.end();
  };
  scope.erase(std::remove_if(scope.begin(), scope.end(), isOwn), scope.end());
  std::vector<Item> items = changed(changes, scope, {});
  const auto isHidden = [&](const Item& item) {
    return std::any_of(function.parameters.begin(), function.parameters.end(), [&](VariableId id) {
      return id != frontend::kNone && shader_.variables[static_cast<std::size_t>(id)].name == item.name;
    });
  };
  items.erase(std::remove_if(items.begin(), items.end(), isHidden), items.end());
  return items;
}

// Do the statement's own expressions contain the variable's name?
bool Recorder::names(const Statement& statement, VariableId id) const {
  const std::string& name = shader_.variables[static_cast<std::size_t>(id)].name;
  std::vector<frontend::TokenRange> own = {statement.expression, statement.increment};
  if (statement.kind == StatementKind::declaration || statement.kind == StatementKind::opaque)
    own.push_back(statement.tokens);
  if (statement.init != frontend::kNone) own.push_back(statementAt(shader_, statement.init).tokens);
  return std::any_of(own.begin(), own.end(), [&](const frontend::TokenRange& range) {
    for (frontend::TokenIndex i = range.first; i <= range.last; ++i)
      if (shader_.tokens[static_cast<std::size_t>(i)].text == name) return true;
    return false;
  });
}

Item Recorder::item(VariableId id) const {
  const Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
  return {variable.name, withoutFragColor(variable.name), variable.type};
}

}  // namespace shadestep::instrumenter
