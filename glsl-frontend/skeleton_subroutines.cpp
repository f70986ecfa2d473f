// Subroutines (GLSL 4.00, 6.1.2), which glslang does not know. It gets to see a subroutine type as a
// prototype, a function of that type as a plain function, and a subroutine uniform as the prototype of a
// function.
#include <algorithm>

#include "glsl-frontend/skeleton_parser.h"

namespace shadestep::frontend::skeleton {

void Parser::hideFromGlslang(const TokenRange& tokens) {
  for (TokenIndex i = tokens.first; i <= tokens.last; ++i) out_.analysed_as[i] = "";
}

// At `subroutine`, which may be followed by the types that a function implements.
void Parser::subroutineQualifier(Qualifiers& qualifiers) {
  const Position start = at_++;
  qualifiers.any = qualifiers.subroutine = true;
  if (is("(")) {
    for (const Position end = at_ + closing(0); at_ <= end; ++at_) {
      if (isName()) qualifiers.implements.push_back(text());
    }
  }
  hideFromGlslang(range(start, at_ - 1));
}

// After the parameters of a declaration that `subroutine` stands before.
void Parser::noteSubroutine(const DeclarationHead& head, const std::string& name,
                            const TokenRange& parameters) {
  if (head.qualifiers.implements.empty()) {
    const int count = static_cast<int>(functionRef().parameters.size());
    subroutine_types_[name] = {textOf(head.type), textOf(parameters), count};
  }
  for (const std::string& type : head.qualifiers.implements) {
    std::vector<FunctionId>& functions = implementations_[type];
    if (std::find(functions.begin(), functions.end(), function_) == functions.end())
      functions.push_back(function_);
  }
}

// `subroutine uniform Type a, b[2];`, from the first name on.
void Parser::subroutineUniforms(const DeclarationHead& head, Position start) {
  const std::string& type_name = tokens_[static_cast<std::size_t>(head.type.first)].text;
  const auto type = subroutine_types_.find(type_name);
  if (type == subroutine_types_.end()) fail("'" + type_name + "' is no subroutine type");
  const std::string& result = type->second.result;
  hideFromGlslang(range(start, at_ - 1));
  out_.analysed_as[head.type.first] = result;
  do {
    if (!isName()) fail("a name was expected before '" + text() + "'");
    const TokenIndex name = current();
    ++at_;
    const Position dimensions = at_;
    std::string parameters = type->second.count > 0 ? type->second.parameters : "";
    bool array = false;
    for (; accept("["); expect("]")) {
      expression({"]"});
      array = true;
      parameters = "int" + (parameters.empty() ? "" : "," + parameters);
    }
    hideFromGlslang(range(dimensions, at_ - 1));
    out_.analysed_as[name] = tokens_[static_cast<std::size_t>(name)].text + "(" + parameters + ")";
    if (is(",")) out_.analysed_as[current()] = ";" + result;
    newSubroutineUniform(tokens_[static_cast<std::size_t>(name)].text, type_name, type->second, array);
  } while (accept(","));
  expect(";");
}

void Parser::newSubroutineUniform(const std::string& name, const std::string& type_name,
                                  const SubroutineType& type, bool array) {
  function_names_.insert(name);
  out_.declared_names.push_back(name);
  bind(name, kNone);
  if (array) subroutine_arrays_.insert(name);
  const FunctionId id = functionOf(name, name + "(" + type.parameters + ")");
  out_.functions[static_cast<std::size_t>(id)].parameters.assign(static_cast<std::size_t>(type.count), kNone);
  subroutine_uniforms_.emplace_back(id, type_name);
}

// name[i][j](x) is name(i, j, x) for glslang. At a ']' that has closed `bracket`.
void Parser::closeSubroutineIndex(const OpenBracket& bracket, std::vector<OpenBracket>& open) {
  out_.analysed_as[bracket.token] = bracket.first_index ? "(" : ",";
  out_.analysed_as[current()] = "";
  if (!is("(", 1) && !is("[", 1)) return;
  ++at_;
  OpenBracket next{kNone, at_ + 1, bracket.subroutines, current(), false};
  if (is("(")) {
    out_.analysed_as[current()] = is(")", 1) ? "" : ",";
    next.call = newCall(bracket.subroutines);
    next.subroutines = kNone;
  }
  open.push_back(next);
}

void Parser::findCandidates() {
  for (const auto& [id, type] : subroutine_uniforms_) {
    out_.functions[static_cast<std::size_t>(id)].candidates = implementations_[type];
  }
}

std::string Parser::textOf(const TokenRange& tokens) const {
  std::string text;
  for (TokenIndex i = tokens.first; i <= tokens.last; ++i) {
    text += (text.empty() ? "" : " ") + tokens_[static_cast<std::size_t>(i)].text;
  }
  return text;
}

}  // namespace shadestep::frontend::skeleton
