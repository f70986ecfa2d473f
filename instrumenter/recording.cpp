// Every step of chosen threads, appended to a storage buffer in one draw.
//
// Each statement gets a record behind it, each condition one right after its evaluation. A record's id says
// which one it is and so what words follow; ids are given in the order of the text.
#include <algorithm>
#include <set>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/condition.h"
#include "instrumenter/constructs/fragment_outputs.h"
#include "instrumenter/constructs/function.h"
#include "instrumenter/constructs/jump.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/constructs/plain_copy.h"
#include "instrumenter/constructs/statement.h"
#include "instrumenter/helpers/helpers.h"
#include "instrumenter/instrumenter.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Function;
using frontend::FunctionId;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Storage;
using frontend::Type;
using frontend::Variable;
using frontend::VariableId;

namespace {

struct Item {
  std::string name;        // as shown to the user
  std::string expression;  // as it reads in the instrumented text
  Type type;
};

class Recorder {
 public:
  explicit Recorder(Draft& draft) : draft_(draft), shader_(draft.shader()), conditions_(draft) {}

  void recordFunctions();
  void recordStatements();
  std::vector<RecordLayout> takeRecords() { return std::move(records_); }

 private:
  void recordStatement(StatementId id);
  void recordCondition(StatementId id);
  void recordReturn(StatementId id, const std::string& before);

  // The expression that appends a record. Values without words or with too many are left out.
  std::string record(Event event, FunctionId function, StatementId statement, const std::vector<Item>& items);

  std::vector<Item> changed(const std::vector<VariableId>& changes, const std::vector<VariableId>& scope,
                            const std::vector<frontend::Declarator>& declared) const;
  std::vector<Item> changedByLoopHead(const Statement& loop) const;
  std::vector<Item> changedInFlight(FunctionId callee) const;
  std::vector<Item> parameters(const Function& function, bool Variable::*direction) const;
  bool names(const Statement& statement, VariableId id) const;
  Item item(VariableId id) const;

  Draft& draft_;
  const Shader& shader_;
  Conditions conditions_;
  std::vector<RecordLayout> records_;
};

void Recorder::recordFunctions() {
  for (std::size_t i = 0; i < shader_.functions.size(); ++i) {
    const Function& function = shader_.functions[i];
    if (function.body == frontend::kNone) continue;
    const auto id = static_cast<FunctionId>(i);
    std::vector<Item> entering = parameters(function, &Variable::parameter_in);
    const std::vector<Item> more = changedInFlight(id);
    entering.insert(entering.end(), more.begin(), more.end());
    putAtBodyStart(draft_.edits, shader_, function.body,
                   record(Event::function_enter, id, function.body, entering) + ";");
    const std::vector<StatementId>& children = statementAt(shader_, function.body).children;
    if (!children.empty() && isJump(statementAt(shader_, children.back()).kind)) continue;
    putAtBodyEnd(
        draft_.edits, shader_, function.body,
        record(Event::function_leave, id, function.body, parameters(function, &Variable::parameter_out)) +
            ";");
  }
}

// Statements stand in token order, a parent before its children, as the edits need them.
void Recorder::recordStatements() {
  for (std::size_t i = 0; i < shader_.statements.size(); ++i) {
    const auto id = static_cast<StatementId>(i);
    const Statement& statement = shader_.statements[i];
    const bool apart = statement.function != frontend::kNone && statement.kind != StatementKind::block &&
                       statement.kind != StatementKind::case_label && !isForInit(shader_, id);
    if (apart) recordStatement(id);
  }
}

void Recorder::recordStatement(StatementId id) {
  const Statement& statement = statementAt(shader_, id);
  std::string before, after;
  if (!statement.calls.empty() || isLoop(statement.kind))
    before = record(Event::before, statement.function, id, {}) + ";";
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
      before += record(Event::jump, statement.function, id, {}) + "; " + draft_.name("end(2);");
      break;
    case StatementKind::break_:
    case StatementKind::continue_:
      before += record(Event::jump, statement.function, id, {}) + ";";
      break;
    default:
      after = record(Event::statement, statement.function, id,
                     changed(statement.changes, statement.scope, statement.declarators)) +
              ";";
  }
  putAround(draft_.edits, shader_, id, before, after);
  if (hasCondition(statement.kind)) recordCondition(id);
  if (isLoop(statement.kind))
    putAtBodyStart(draft_.edits, shader_, statement.children.back(),
                   record(Event::iteration, statement.function, id, {}) + ";");
}

void Recorder::recordCondition(StatementId id) {
  const Statement& statement = statementAt(shader_, id);
  std::vector<Item> items = {{"", conditions_.outcome(id), outcomeType(shader_, id)}};
  const std::vector<Item> more = statement.kind == StatementKind::for_
                                     ? changedByLoopHead(statement)
                                     : changed(statement.changes, statement.scope, {});
  items.insert(items.end(), more.begin(), more.end());
  conditions_.putAfter(draft_.edits, id, record(Event::condition, statement.function, id, items));
}

void Recorder::recordReturn(StatementId id, const std::string& before) {
  const Statement& statement = statementAt(shader_, id);
  const std::vector<Item> more = changed(statement.changes, statement.scope, {});
  if (statement.expression.empty()) {
    const std::string text = record(Event::return_, statement.function, id, more) + ";";
    return putAround(draft_.edits, shader_, id, before + text, "");
  }
  std::vector<Item> items = {
      {"return", returnedValue(draft_), functionAt(shader_, statement.function).return_type}};
  items.insert(items.end(), more.begin(), more.end());
  putIntoReturn(draft_.edits, draft_, id, before, record(Event::return_, statement.function, id, items));
}

std::string Recorder::record(Event event, FunctionId function, StatementId statement,
                             const std::vector<Item>& items) {
  RecordLayout layout;
  layout.event = event;
  layout.statement = statement;
  layout.function = function;
  const std::string words = draft_.name("words"), at = draft_.name("at");
  std::string writes;
  for (const Item& item : items) {
    const int count = frontend::wordCount(item.type);
    if (count == 0 || count > kWidestRecorded) continue;
    layout.fields.push_back(Field{item.name, item.type, layout.words});
    for (const std::string& word : intWords(draft_, item.expression, item.type)) {
      writes +=
          words + "[" + at + (layout.words > 0 ? " + " + std::to_string(layout.words) : "") + "] = " + word;
      writes += ", ";
      ++layout.words;
    }
  }
  records_.push_back(layout);
  const std::string start =
      draft_.name("record(") + std::to_string(records_.size()) + ", " + std::to_string(layout.words) + ")";
  return writes.empty() ? start : "(" + start + " && (" + writes + "true))";
}

// What was changed and can be named behind the statement, then what it declared. A declared name hides a
// changed variable of the same name; memory that other threads write to is no value of this thread's.
std::vector<Item> Recorder::changed(const std::vector<VariableId>& changes,
                                    const std::vector<VariableId>& scope,
                                    const std::vector<frontend::Declarator>& declared) const {
  std::set<std::string> hidden;
  for (const frontend::Declarator& declarator : declared)
    if (declarator.variable != frontend::kNone) hidden.insert(item(declarator.variable).name);

  const std::set<VariableId> changing(changes.begin(), changes.end());
  std::vector<Item> items;
  for (const VariableId id : scope) {
    const Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
    const bool shared = variable.storage == Storage::buffer || variable.storage == Storage::shared;
    if (changing.contains(id) && !shared && !hidden.contains(variable.name)) items.push_back(item(id));
  }
  for (const frontend::Declarator& declarator : declared)
    if (declarator.variable != frontend::kNone) items.push_back(item(declarator.variable));
  return items;
}

// A `for` has no place for records of its init and increment: they go with the next evaluation of the
// condition.
std::vector<Item> Recorder::changedByLoopHead(const Statement& loop) const {
  std::vector<VariableId> changes = loop.changes;
  changes.insert(changes.end(), loop.init_changes.begin(), loop.init_changes.end());
  changes.insert(changes.end(), loop.increment_changes.begin(), loop.increment_changes.end());
  std::vector<frontend::Declarator> declared;
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

std::vector<Item> Recorder::parameters(const Function& function, bool Variable::*direction) const {
  std::vector<Item> items;
  for (const VariableId id : function.parameters)
    if (id != frontend::kNone && shader_.variables[static_cast<std::size_t>(id)].*direction)
      items.push_back(item(id));
  return items;
}

Item Recorder::item(VariableId id) const {
  const Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
  return {variable.name, withoutFragColor(variable.name), variable.type};
}

// The extensions that a recording needs below these versions make keywords of what may be a name there.
std::string newKeyword(const Shader& shader) {
  if (isEs(shader)) return "";
  for (const std::string& name : frontend::identifiers(shader)) {
    if ((name == "buffer" && shader.version < 430) || (name == "layout" && shader.version < 140)) return name;
  }
  return "";
}

std::string impossible(const Shader& shader, const Target& target) {
  const bool es = isEs(shader);
  if (const std::string name = newKeyword(shader); !name.empty())
    return "Recording needs extensions that make '" + name +
           "' a keyword, and the shader uses it as a name; look at single steps instead.";
  if (es && shader.version < 310)
    return "Recording needs storage buffers, which GLSL ES has from 3.10 on; look at single steps instead.";
  if (!target.storage_buffers)
    return "Recording needs storage buffers in fragment shaders (OpenGL 4.3 or "
           "GL_ARB_shader_storage_buffer_object), which this driver lacks; look at single steps instead.";
  if (!es && shader.version < 330 && !target.bit_encoding)
    return "Recording a shader below GLSL 3.30 needs GL_ARB_shader_bit_encoding, which this driver lacks; "
           "look at "
           "single steps instead.";
  return "";
}

// In ES the text alone gives a block its binding, and four are there at least: the last that the text does
// not name.
std::string recordingDeclarations(const Draft& draft) {
  std::string text = draft.adapt(helpers::k_recording_declarations);
  if (!draft.es()) return text;
  const std::vector<frontend::Token>& tokens = draft.shader().tokens;
  const auto isTaken = [&](int binding) {
    for (std::size_t i = 2; i < tokens.size(); ++i) {
      if (tokens[i].text == std::to_string(binding) && tokens[i - 1].text == "=" &&
          tokens[i - 2].text == "binding")
        return true;
    }
    return false;
  };
  int binding = 3;
  while (binding > 0 && isTaken(binding)) --binding;
  const std::string_view before = "layout(std430";
  return text.insert(text.find(before) + before.size(), ", binding = " + std::to_string(binding));
}

}  // namespace

Result<RecordingShader> instrumentRecording(const Shader& shader, const Target& target) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  std::string reason = attachments.failure();
  if (reason.empty()) reason = impossible(shader, target);
  if (!reason.empty()) return Failure{reason};

  // 1. Extensions and declarations that everything below uses.
  if (!draft.es() && shader.version < 430) draft.require("GL_ARB_shader_storage_buffer_object");
  if (!draft.es() && shader.version < 140)
    draft.require("GL_ARB_uniform_buffer_object");  // makes `layout` a keyword
  prepareWords(draft);
  draft.declare(recordingDeclarations(draft));
  Type invocation;
  invocation.basic = frontend::Basic::uint_;
  attachments.add("invocation", invocation);
  attachments.declare();
  draft.append(draft.adapt(helpers::k_recording_functions));
  // 2. The frame: a thread starts and ends in the new main; where nothing is recorded it runs the plain copy.
  //    (The functions behind subroutine uniforms cannot be told apart that way.)
  const std::string count = draft.name("invocation");
  std::string before = "  " + draft.name("begin();\n");
  if (!shader.traits.uses_subroutines)
    before = "  if (!" + draft.name("begin()") + ") " + copyPlain(draft) + "(); else\n";
  wrapMain(draft, before,
           "  " + draft.name("end(1);\n") + "  " + attachments.assign(kLaunched | kReached, {count}) + ";\n" +
               attachments.write());
  // 3. Functions before statements: their records enclose those of their statements.
  Recorder recorder(draft);
  recorder.recordFunctions();
  recorder.recordStatements();

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  RecordingLayout layout;
  layout.block = draft.name("Record");
  layout.pixel_uniform = draft.name("pixel");
  layout.records = recorder.takeRecords();
  layout.attachment = attachments.layout();
  return RecordingShader{std::move(std::get<std::string>(text)), std::move(layout)};
}

}  // namespace shadestep::instrumenter
