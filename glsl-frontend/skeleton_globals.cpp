// What stands at file scope: functions, blocks, global declarations.
#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend::skeleton {

void Parser::externalDeclaration() {
  if (accept(";")) return;
  if (is("precision")) return precisionStatement();
  const Position start = at_;
  const DeclarationHead head = declarationHead();
  if (is(";")) {  // struct S { ... };  layout(...) in;
    ++at_;
  } else if (!head.has_type && isName() && is("{", 1)) {
    interfaceBlock(head.qualifiers);
  } else if (!head.has_type && head.qualifiers.any) {
    redeclaredNames();
  } else if (head.has_type && isName() && is("(", 1)) {
    function(head, start);
  } else if (head.qualifiers.subroutine && head.qualifiers.uniform && !head.type.empty()) {
    subroutineUniforms(head, start);
  } else if (head.has_type) {
    declarators(head.qualifiers, ";");
    expect(";");
  } else {
    fail("'" + text() + "' starts no declaration");
  }
}

void Parser::skipTo(std::string_view end) {
  while (!is(end)) {
    if (atEnd()) fail("");
    ++at_;
  }
  expect(end);
}

// invariant a, b;
void Parser::redeclaredNames() {
  while (!is(";")) {
    if (!isName() && !is(",")) fail("'" + text() + "' does not fit into a declaration");
    if (isBuiltinName(text())) redeclareBuiltin(text());
    if (isName()) resolve(current());
    ++at_;
  }
  expect(";");
}

void Parser::interfaceBlock(const Qualifiers& qualifiers) {
  const bool is_builtin = isBuiltinName(text());
  at_ += 2;
  std::vector<TokenIndex> names;
  while (!accept("}")) {
    const std::vector<TokenIndex> line = members();
    names.insert(names.end(), line.begin(), line.end());
  }
  if (isName()) {
    const TokenIndex instance = current();
    ++at_;
    arrayDimensions();
    declare(qualifiers, instance);
  } else {
    for (TokenIndex name : names) {
      if (is_builtin)
        redeclareBuiltin(tokens_[static_cast<std::size_t>(name)].text);
      else
        declare(qualifiers, name);
    }
  }
  expect(";");
}

void Parser::function(const DeclarationHead& head, Position start) {
  const TokenIndex name_token = current();
  const std::string name = text();
  function_names_.insert(name);
  out_.declared_names.push_back(name);
  bind(name, kNone);
  ++at_;
  expect("(");
  const Position parameter_start = at_;

  Scope scope(*this);
  const std::size_t first_variable = out_.variables.size();
  const std::size_t builtins = out_.builtins.size();
  function_ = static_cast<FunctionId>(out_.functions.size());  // parameters are no globals
  std::vector<VariableId> parameters;
  const std::string key = name + "(" + parameterList(parameters) + ")";
  const TokenRange parameter_tokens = range(parameter_start, at_ - 2);
  const TokenRange header = range(start, at_ - 1);
  function_ = functionOf(name, key);
  if (accept(";")) {
    if (out_.builtins.size() == builtins) {  // a prototype's parameters mean nothing
      out_.variables.resize(first_variable);
      unresolve(header);
    }
    functionRef().prototypes.push_back({header.first, previous()});
    if (functionRef().parameters.empty()) functionRef().parameters.assign(parameters.size(), kNone);
    if (head.qualifiers.subroutine) noteSubroutine(head, name, parameter_tokens);
  } else {
    Function& defined = functionRef();
    defined.header = header;
    defined.name_token = name_token;
    defined.parameters = parameters;
    out_.definitions.push_back(function_);
    if (head.qualifiers.subroutine) noteSubroutine(head, name, parameter_tokens);
    const StatementId body = block(kNone, parameters);
    functionRef().body = body;
  }
  function_ = kNone;
  statement_ = kNone;
}

void Parser::unresolve(const TokenRange& tokens) {
  for (TokenIndex i = tokens.first; i <= tokens.last; ++i) {
    VariableId& variable = out_.resolved[static_cast<std::size_t>(i)];
    if (variable >= static_cast<VariableId>(out_.variables.size())) variable = kNone;
  }
}

// The function of this name and these parameter types; a new one where there is none.
FunctionId Parser::functionOf(const std::string& name, const std::string& key) {
  const auto [found, fresh] =
      functions_by_key_.try_emplace(key, static_cast<FunctionId>(out_.functions.size()));
  if (fresh) {
    Function added;
    added.name = name;
    added.is_main = key == "main()";
    out_.functions.push_back(std::move(added));
    out_.parameter_texts.push_back(key);
  }
  return found->second;
}

// Up to and with the ')'. Returns the parameters' types as text.
std::string Parser::parameterList(std::vector<VariableId>& parameters) {
  std::string types;
  if (is("void") && is(")", 1)) ++at_;
  while (!accept(")")) {
    if (!types.empty()) expect(",");
    types += (types.empty() ? "" : ",") + parameter(parameters);
  }
  return types;
}

std::string Parser::parameter(std::vector<VariableId>& parameters) {
  Qualifiers qualifiers;
  while (qualifierStartsHere()) qualifier(qualifiers);
  std::string type = qualifiers.is_unsigned ? "uint" : text();
  if (isImage(type)) image_parameters_.insert(type);
  if (!isName()) fail("a parameter's type was expected before '" + text() + "'");
  ++at_;
  std::string dimensions = dimensionTexts();
  if (!isName()) {
    parameters.push_back(kNone);
    return type + dimensions;
  }
  const TokenIndex name = current();
  ++at_;
  dimensions = dimensionTexts() + dimensions;
  const VariableId variable =
      newVariable(tokens_[static_cast<std::size_t>(name)].text, Storage::parameter, name);
  Variable& declared = out_.variables[static_cast<std::size_t>(variable)];
  declared.parameter_out = qualifiers.out || qualifiers.inout;
  declared.parameter_in = !qualifiers.out;
  bind(declared.name, variable);
  parameters.push_back(variable);
  return type + dimensions;
}

std::string Parser::dimensionTexts() {
  const Position start = at_;
  arrayDimensions();
  std::string texts;
  for (Position i = start; i < at_; ++i) texts += tokens_[static_cast<std::size_t>(tokenAt(i))].text;
  return texts;
}

}  // namespace shadestep::frontend::skeleton
