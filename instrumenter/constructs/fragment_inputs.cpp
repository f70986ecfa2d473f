#include "instrumenter/constructs/fragment_inputs.h"

#include <algorithm>
#include <set>

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Shader;
using frontend::Storage;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenRange;
using frontend::Type;
using frontend::Variable;

namespace {

struct BuiltIn {
  const char* name;
  Basic basic;
  int rows;
};
// Built-in inputs that have one value in a fragment of a single-sampled target.
constexpr BuiltIn kBuiltIns[] = {
    {"gl_FragCoord", Basic::float_, 4},      {"gl_FrontFacing", Basic::bool_, 1},
    {"gl_PointCoord", Basic::float_, 2},     {"gl_Color", Basic::float_, 4},
    {"gl_SecondaryColor", Basic::float_, 4}, {"gl_FogFragCoord", Basic::float_, 1},
    {"gl_PrimitiveID", Basic::int_, 1},      {"gl_Layer", Basic::int_, 1},
    {"gl_ViewportIndex", Basic::int_, 1},
};
constexpr const char* kTexCoord = "gl_TexCoord";

const Token& at(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)];
}

TokenIndex tokenCount(const Shader& shader) {
  return static_cast<TokenIndex>(shader.tokens.size());
}

bool isInputQualifier(const std::string& text) {
  return text == "in" || text == "varying";
}

// Does the declaration around a built-in's name declare it again (`in vec4 gl_FragCoord;`)?
bool isRedeclaration(const Shader& shader, TokenIndex name) {
  for (const frontend::Function& function : shader.functions) {
    if (function.body == frontend::kNone) continue;
    const TokenRange body = shader.statements[static_cast<std::size_t>(function.body)].tokens;
    if (function.header.first <= name && name <= body.last) return false;
  }
  Variable variable;
  variable.declared = name;
  for (TokenIndex i = globalDeclaration(shader, variable).first; i < name; ++i)
    if (isInputQualifier(at(shader, i).text)) return true;
  return false;
}

// gl_TexCoord [ 1 ] -> "1"; empty if the index is anything but a literal.
std::string literalIndex(const Shader& shader, TokenIndex name) {
  const bool literal = name + 3 < tokenCount(shader) && at(shader, name + 1).text == "[" &&
                       at(shader, name + 2).kind == frontend::TokenKind::number &&
                       at(shader, name + 3).text == "]";
  return literal ? at(shader, name + 2).text : "";
}

Type typeOf(Basic basic, int rows) {
  Type type;
  type.basic = basic;
  type.rows = rows;
  return type;
}

std::string unsupported(const Shader& shader, const Variable& input) {
  const TokenRange declaration = globalDeclaration(shader, input);
  for (TokenIndex i = declaration.first; i <= declaration.last; ++i)
    if (at(shader, i).text == "{") return "'" + input.name + "' belongs to an input block";
  if (input.type.basic == Basic::struct_) return "'" + input.name + "' is a structure";
  return "";
}

bool isUserInput(const Variable& variable) {
  return variable.storage == Storage::in && variable.declared != frontend::kNone;
}

// flat in vec3 p, q;  ->  uniform vec3 p, q;
void makeUniform(Draft& draft, const Variable& input) {
  static const std::set<std::string> interpolation = {"flat",   "smooth",    "noperspective", "centroid",
                                                      "sample", "invariant", "precise"};
  const Shader& shader = draft.shader();
  for (TokenIndex i = globalDeclaration(shader, input).first; i < input.declared; ++i) {
    const std::string& text = at(shader, i).text;
    if (text == ",") return;  // the first name of the list has done it
    if (isInputQualifier(text)) draft.edits.replace(i, "uniform");
    if (interpolation.contains(text)) draft.edits.remove(i);
    if (text != "layout") continue;
    const TokenIndex close = matchingBracket(shader, i + 1);
    for (; i <= close; ++i) draft.edits.remove(i);
    --i;
  }
}

}  // namespace

Result<std::vector<IsolatedInput>> fragmentInputs(const Draft& draft) {
  const Shader& shader = draft.shader();
  std::vector<IsolatedInput> inputs;
  for (const Variable& variable : shader.variables) {
    if (!isUserInput(variable) || !variable.read) continue;
    const std::string reason = unsupported(shader, variable);
    if (!reason.empty()) return Failure{"The inputs cannot be turned into uniforms yet: " + reason + "."};
    inputs.push_back({variable.name, variable.name, variable.type});
  }

  std::set<std::string> seen;
  for (TokenIndex i = 0; i < tokenCount(shader); ++i) {
    const std::string& text = at(shader, i).text;
    if (text.starts_with("interpolateAt"))
      return Failure{"The inputs cannot be turned into uniforms: '" + text + "' needs a real input."};
    if (text == "gl_ClipDistance" || text == "gl_CullDistance")
      return Failure{"The inputs cannot be turned into uniforms yet: '" + text + "' is an array."};
    if (text == kTexCoord && !isRedeclaration(shader, i)) {
      const std::string index = literalIndex(shader, i);
      if (index.empty())
        return Failure{
            "The inputs cannot be turned into uniforms yet: gl_TexCoord is used without a literal index."};
      if (seen.insert(text + index).second)
        inputs.push_back(
            {text + "[" + index + "]", draft.name("TexCoord" + index), typeOf(Basic::float_, 4)});
    }
    const auto* built_in = std::find_if(std::begin(kBuiltIns), std::end(kBuiltIns),
                                        [&text](const BuiltIn& candidate) { return text == candidate.name; });
    if (built_in == std::end(kBuiltIns) || isRedeclaration(shader, i) || !seen.insert(text).second) continue;
    inputs.push_back({text, draft.name(text.substr(3)), typeOf(built_in->basic, built_in->rows)});
  }
  return inputs;
}

void replaceInputs(Draft& draft, const std::vector<IsolatedInput>& inputs) {
  const Shader& shader = draft.shader();
  for (const Variable& variable : shader.variables)
    if (isUserInput(variable)) makeUniform(draft, variable);
  for (const IsolatedInput& input : inputs) {
    if (input.input == input.uniform) continue;
    const std::string precision = input.type.basic == Basic::bool_ ? "" : draft.highp();
    draft.declare("uniform " + precision + frontend::glslName(input.type) + " " + input.uniform + ";");
  }

  for (TokenIndex i = 0; i < tokenCount(shader); ++i) {
    const Token& token = at(shader, i);
    const std::string watch =
        token.text == kTexCoord ? token.text + "[" + literalIndex(shader, i) + "]" : token.text;
    const auto input = std::find_if(inputs.begin(), inputs.end(), [&watch](const IsolatedInput& candidate) {
      return candidate.input == watch && candidate.input != candidate.uniform;
    });
    if ((input != inputs.end() || token.text == kTexCoord) && isRedeclaration(shader, i)) {
      Variable variable;
      variable.declared = i;
      const TokenRange declaration = globalDeclaration(shader, variable);
      for (TokenIndex dropped = declaration.first; dropped <= declaration.last; ++dropped)
        draft.edits.remove(dropped);
      i = declaration.last;
    } else if (input != inputs.end()) {
      draft.edits.replace(i, input->uniform);
      if (token.text == kTexCoord)
        for (TokenIndex index = i + 1; index <= i + 3; ++index) draft.edits.remove(index);
    }
  }
}

}  // namespace shadestep::instrumenter
