#include "instrumenter/read_samplers.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Call;
using frontend::Function;
using frontend::FunctionId;
using frontend::Shader;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;
using frontend::Type;
using frontend::Variable;
using frontend::VariableId;

namespace {

constexpr int kMostElements = 64;  // of an array of samplers

const std::string& textAt(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

std::string written(const Shader& shader, TokenRange range) {
  std::string text;
  for (TokenIndex i = range.first; i <= range.last; ++i)
    text += (text.empty() ? "" : " ") + textAt(shader, i);
  return text;
}

bool isNumber(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

// Evaluating it a second time changes nothing.
bool isHarmless(const Shader& shader, TokenRange range) {
  static const std::set<std::string> changing = {
      "=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "<<=", ">>=", "^=", "("};
  for (TokenIndex i = range.first; i <= range.last; ++i)
    if (changing.contains(textAt(shader, i))) return false;
  return true;
}

ReadSamplers::Meaning unknown(std::string reason) {
  ReadSamplers::Meaning meaning;
  meaning.reason = std::move(reason);
  return meaning;
}

FunctionId idOf(const Shader& shader, const Function& function) {
  return static_cast<FunctionId>(&function - shader.functions.data());
}

// The functions that a call of this one may run, itself included.
std::set<FunctionId> reachedFrom(const Shader& shader, FunctionId function) {
  std::set<FunctionId> reached = {function};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Call& call : shader.calls)
      if (reached.contains(call.caller)) reached.insert(call.callee);
  }
  return reached;
}

}  // namespace

std::optional<SamplerKind> samplerKind(const std::string& opaque_name) {
  const std::size_t at = opaque_name.find("sampler");
  if (at == std::string::npos || at > 1) return {};
  const std::string what = opaque_name.substr(at + 7);
  SamplerKind kind;
  kind.shadow = what.ends_with("Shadow");
  const std::string shape = kind.shadow ? what.substr(0, what.size() - 6) : what;
  static const std::map<std::string, SamplerKind> shapes = {
      {"1D", {1}},
      {"2D", {2}},
      {"3D", {3}},
      {"1DArray", {1, true}},
      {"2DArray", {2, true}},
      {"Cube", {2, false, true}},
      {"CubeArray", {2, true, true}},
      {"2DRect", {2, false, false, true}},
      {"Buffer", {1, false, false, false, true}},
      {"2DMS", {2, false, false, false, false, true}},
      {"2DMSArray", {2, true, false, false, false, true}},
  };
  const auto found = shapes.find(shape);
  if (found == shapes.end()) return {};
  const bool shadow = kind.shadow;
  kind = found->second;
  kind.shadow = shadow;
  return kind;
}

ReadSamplers::Meaning ReadSamplers::meaningOf(TokenRange expression, const Function& function) {
  const Shader& shader = draft_.shader();
  const std::string& name = textAt(shader, expression.first);
  for (const VariableId id : function.parameters)
    if (id != frontend::kNone && shader.variables[static_cast<std::size_t>(id)].name == name)
      return parameterMeaning(expression, id, function);
  for (const Variable& variable : shader.variables)
    if (variable.name == name && variable.storage == frontend::Storage::uniform)
      return uniformMeaning(expression, variable);
  return unknown("'" + written(shader, expression) + "' is no sampler that can be followed");
}

// name, then .member and [index] in any order; at most one index is no number.
ReadSamplers::Meaning ReadSamplers::uniformMeaning(TokenRange expression, const Variable& variable) {
  const Shader& shader = draft_.shader();
  const std::string shown = "'" + written(shader, expression) + "'";
  Type type = variable.type;
  std::string before = variable.name;  // of the index that chooses; all of the name where there is none
  std::string after;
  Meaning meaning;
  const auto extend = [&](const std::string& text) { (meaning.count > 1 ? after : before) += text; };
  for (TokenIndex i = expression.first + 1; i <= expression.last; ++i) {
    if (textAt(shader, i) == "." && type.members && !type.isArray()) {
      ++i;
      const auto& members = type.members->members;
      const auto member = std::find_if(members.begin(), members.end(),
                                       [&](const auto& one) { return one.name == textAt(shader, i); });
      if (member == members.end()) return unknown(shown + " is no sampler that can be followed");
      extend("." + member->name);
      type = Type(member->type);
    } else if (textAt(shader, i) == "[" && type.isArray()) {
      const TokenIndex close = matchingBracket(shader, i);
      const TokenRange index{i + 1, close - 1};
      const int size = type.array.front();
      type = type.element();
      if (index.first == index.last && isNumber(textAt(shader, index.first))) {
        extend("[" + textAt(shader, index.first) + "]");
      } else {
        if (meaning.count > 1 || size < 1 || size > kMostElements || !isHarmless(shader, index))
          return unknown("which element of its array " + shown + " is cannot be followed");
        meaning.index = "int(" + written(shader, index) + ")";
        meaning.count = size;
      }
      i = close;
    } else {
      return unknown(shown + " is no sampler that can be followed");
    }
  }
  const std::optional<SamplerKind> kind = samplerKind(type.opaque_name);
  if (!kind) return unknown(shown + " is no sampler whose texels can be counted");
  if (type.isArray()) return unknown(shown + " is an array");
  meaning.kind = *kind;
  meaning.opaque_name = type.opaque_name;
  std::vector<std::string> uniforms;
  if (meaning.index.empty()) {
    uniforms.push_back(before);
  } else {
    for (int i = 0; i < meaning.count; ++i)
      uniforms.push_back(before + "[" + std::to_string(i) + "]" + after);
  }
  meaning.first = add(uniforms, *kind);
  return meaning;
}

ReadSamplers::Meaning ReadSamplers::parameterMeaning(TokenRange expression, VariableId id,
                                                     const Function& function) {
  const Shader& shader = draft_.shader();
  const Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  const std::optional<SamplerKind> kind = samplerKind(variable.type.opaque_name);
  if (expression.first != expression.last || !kind || variable.type.isArray())
    return unknown("'" + written(shader, expression) + "' is part of a parameter");
  const auto parameter = static_cast<std::size_t>(
      std::find(function.parameters.begin(), function.parameters.end(), id) - function.parameters.begin());
  if (!parameters_.contains(id)) {
    parameters_[id] = {};
    const std::string reason = whyUntold(function, parameter);
    parameters_[id].reason = reason;
  }
  if (!parameters_[id].reason.empty()) return unknown(parameters_[id].reason);
  Meaning meaning;
  meaning.kind = *kind;
  meaning.opaque_name = variable.type.opaque_name;
  meaning.parameter = id;
  return meaning;
}

// Asks all calls of the function what they give to the parameter.
std::string ReadSamplers::whyUntold(const Function& function, std::size_t parameter) {
  const Shader& shader = draft_.shader();
  const VariableId id = function.parameters[parameter];
  const std::string name = "'" + shader.variables[static_cast<std::size_t>(id)].name + "'";
  if (shader.traits.uses_subroutines)
    return "who calls the function with the parameter " + name + " is not known";
  const FunctionId called = idOf(shader, function);
  for (std::size_t i = 0; i < shader.calls.size(); ++i) {
    const Call& call = shader.calls[i];
    if (call.callee != called) continue;
    if (call.caller == frontend::kNone || parameter >= call.arguments.size())
      return "who calls the function with the parameter " + name + " is not known";
    // Its arguments would tell the function something else before it runs.
    for (const Call& inner : shader.calls) {
      const bool within = inner.name > call.name && inner.close < call.close;
      if (within && reachedFrom(shader, inner.callee).contains(called))
        return "a call with the parameter " + name + " holds another call of the same function";
    }
    Meaning given =
        meaningOf(call.arguments[parameter], shader.functions[static_cast<std::size_t>(call.caller)]);
    if (!given.reason.empty()) return given.reason;
    parameters_[id].by[static_cast<frontend::CallId>(i)] = std::move(given);
  }
  return "";
}

int ReadSamplers::add(const std::vector<std::string>& uniforms, const SamplerKind& kind) {
  const auto [known, fresh] = known_.try_emplace(uniforms, static_cast<int>(samplers_.size()));
  if (fresh)
    for (const std::string& uniform : uniforms) samplers_.push_back({uniform, kind});
  return known->second;
}

std::string ReadSamplers::word(const Meaning& meaning, int first_word) const {
  if (meaning.parameter != frontend::kNone) return draft_.name("sampler" + std::to_string(meaning.parameter));
  const std::string first = std::to_string(first_word + kSlotWords * meaning.first);
  if (meaning.index.empty()) return first;
  return draft_.name("element(") + first + ", " + meaning.index + ", " + std::to_string(meaning.count) + ")";
}

// Before its call a function is told what its parameters are. GLSL has no recursion: they stay so until it is
// left.
std::vector<ReadSamplers::Wrap> ReadSamplers::declare(int first_word) {
  const Shader& shader = draft_.shader();
  std::map<frontend::CallId, std::string> told;
  for (const auto& [id, parameter] : parameters_) {
    if (!parameter.reason.empty()) continue;
    const std::string name = draft_.name("sampler" + std::to_string(id));
    draft_.declare(draft_.highp() + "int " + name + ";");
    for (const auto& [call, given] : parameter.by)
      told[call] += name + " = " + word(given, first_word) + ", ";
  }
  std::vector<Wrap> wraps;
  for (const auto& [id, text] : told) {
    const Call& call = shader.calls[static_cast<std::size_t>(id)];
    wraps.push_back({{call.name, call.close}, "(" + text, ")"});
  }
  return wraps;
}

}  // namespace shadestep::instrumenter
