// Shaders as text literals, and what analyse() makes of them, as text again.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "glsl-frontend/shader.h"
#include "glsl-frontend/validate.h"

namespace shadestep::frontend {

// Analyses a fragment shader that must be taken, and holds it against the invariants.
inline Shader analysed(const std::string& text, const PreprocessorFacts& facts = {},
                       Stage stage = Stage::fragment) {
  const Analysis analysis = analyse(stage, {text}, facts);
  EXPECT_EQ(analysis.error, "") << text;
  if (!analysis.shader) return {};
  for (const std::string& violation : violations(*analysis.shader))
    ADD_FAILURE() << violation << "\n" << text;
  return *analysis.shader;
}

// void main() { BODY } after the globals.
inline Shader analysedMain(const std::string& body, const std::string& globals = "") {
  return analysed(globals + "void main() {\n" + body + "\n}\n");
}

inline std::string text(const Shader& shader, const TokenRange& range) {
  std::string result;
  for (TokenIndex i = range.first; i <= range.last; ++i) {
    result += (result.empty() ? "" : " ") + shader.tokens[static_cast<std::size_t>(i)].text;
  }
  return result;
}

inline const Variable& variable(const Shader& shader, VariableId id) {
  return shader.variables[static_cast<std::size_t>(id)];
}

inline std::vector<std::string> names(const Shader& shader, const std::vector<VariableId>& ids) {
  std::vector<std::string> result;
  for (VariableId id : ids) result.push_back(variable(shader, id).name);
  return result;
}

inline const char* name(StatementKind kind) {
  static const char* const kNames[] = {"block",   "expression", "declaration", "if",    "for",
                                       "while",   "do",         "switch",      "case",  "return",
                                       "discard", "break",      "continue",    "opaque"};
  return kNames[static_cast<int>(kind)];
}

// The statement tree from `id` on: "for(declaration block(expression break))".
inline std::string tree(const Shader& shader, StatementId id) {
  const Statement& statement = shader.statements[static_cast<std::size_t>(id)];
  std::string inner;
  if (statement.init != kNone) inner += tree(shader, statement.init);
  for (StatementId child : statement.children) inner += (inner.empty() ? "" : " ") + tree(shader, child);
  return name(statement.kind) + (inner.empty() ? "" : "(" + inner + ")");
}

inline const Function& mainOf(const Shader& shader) {
  return shader.functions[static_cast<std::size_t>(shader.main)];
}

// The only statement that starts with this text.
inline StatementId find(const Shader& shader, const std::string& start) {
  StatementId found = kNone;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    if (shader.statements[i].kind == StatementKind::block) continue;
    if (text(shader, shader.statements[i].tokens).rfind(start, 0) != 0) continue;
    if (found == kNone) found = static_cast<StatementId>(i);
  }
  EXPECT_NE(found, kNone) << "no statement starts with " << start;
  return found;
}

inline const Statement& statement(const Shader& shader, const std::string& start) {
  return shader.statements[static_cast<std::size_t>(find(shader, start))];
}

inline const Variable* findVariable(const Shader& shader, const std::string& name) {
  for (const Variable& candidate : shader.variables) {
    if (candidate.name == name) return &candidate;
  }
  ADD_FAILURE() << "no variable " << name;
  return nullptr;
}

}  // namespace shadestep::frontend
