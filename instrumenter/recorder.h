// The records of a recording: what each step of a thread appends, and where it does so.
//
// Each statement gets a record behind it, each condition one right after its evaluation. A record's id says
// which one it is and so what words follow; ids are given in the order in which records are made here.
#pragma once

#include <string>
#include <vector>

#include "instrumenter/constructs/condition.h"
#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

// A value in a record.
struct Item {
  std::string name;        // as shown to the user
  std::string expression;  // as it reads in the instrumented text
  frontend::Type type;
};

class Recorder {
 public:
  explicit Recorder(Draft& draft) : draft_(draft), shader_(draft.shader()), conditions_(draft) {}

  // Functions before statements: their records enclose those of their statements.
  void recordFunctions();
  void recordStatements();
  std::vector<RecordLayout> takeRecords() { return std::move(records_); }

 private:
  using FunctionId = frontend::FunctionId;
  using StatementId = frontend::StatementId;
  using VariableId = frontend::VariableId;

  void recordStatement(StatementId);
  void recordCondition(StatementId);
  void recordReturn(StatementId, const std::string& before);
  void recordDeclarators(StatementId);
  void recordInside(StatementId);
  void recordCalls(StatementId);
  std::vector<frontend::CallId> unclearCalls(StatementId) const;

  // The expression that appends a record. Values without words or with too many are left out.
  std::string record(Event, StatementId, const std::vector<Item>&);
  std::string record(RecordLayout, const std::vector<Item>&);

  std::vector<Item> changed(const std::vector<VariableId>& changes, const std::vector<VariableId>& scope,
                            const std::vector<frontend::Declarator>& declared) const;
  std::vector<Item> changedBy(const frontend::Statement&) const;
  std::vector<Item> changedByLoopHead(const frontend::Statement& loop) const;
  std::vector<Item> changedInFlight(FunctionId callee) const;
  bool names(const frontend::Statement&, VariableId) const;
  std::vector<Item> parameters(const frontend::Function&, bool frontend::Variable::*direction) const;
  Item item(VariableId) const;

  Draft& draft_;
  const frontend::Shader& shader_;
  Conditions conditions_;
  std::vector<RecordLayout> records_;
};

}  // namespace shadestep::instrumenter
