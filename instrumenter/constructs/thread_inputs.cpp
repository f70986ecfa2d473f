#include "instrumenter/constructs/thread_inputs.h"

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

#include "instrumenter/constructs/declaration.h"
#include "instrumenter/measures.h"

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
constexpr BuiltIn kFragmentBuiltIns[] = {
    {"gl_FragCoord", Basic::float_, 4},      {"gl_FrontFacing", Basic::bool_, 1},
    {"gl_PointCoord", Basic::float_, 2},     {"gl_Color", Basic::float_, 4},
    {"gl_SecondaryColor", Basic::float_, 4}, {"gl_FogFragCoord", Basic::float_, 1},
    {"gl_PrimitiveID", Basic::int_, 1},      {"gl_Layer", Basic::int_, 1},
    {"gl_ViewportIndex", Basic::int_, 1},
};
constexpr BuiltIn kVertexBuiltIns[] = {
    {"gl_VertexID", Basic::int_, 1},         {"gl_InstanceID", Basic::int_, 1},
    {"gl_InstanceIDARB", Basic::int_, 1},    {"gl_BaseVertex", Basic::int_, 1},
    {"gl_BaseVertexARB", Basic::int_, 1},    {"gl_BaseInstance", Basic::int_, 1},
    {"gl_BaseInstanceARB", Basic::int_, 1},  {"gl_DrawID", Basic::int_, 1},
    {"gl_DrawIDARB", Basic::int_, 1},        {"gl_Vertex", Basic::float_, 4},
    {"gl_Normal", Basic::float_, 3},         {"gl_Color", Basic::float_, 4},
    {"gl_SecondaryColor", Basic::float_, 4}, {"gl_FogCoord", Basic::float_, 1},
    {"gl_MultiTexCoord0", Basic::float_, 4}, {"gl_MultiTexCoord1", Basic::float_, 4},
    {"gl_MultiTexCoord2", Basic::float_, 4}, {"gl_MultiTexCoord3", Basic::float_, 4},
    {"gl_MultiTexCoord4", Basic::float_, 4}, {"gl_MultiTexCoord5", Basic::float_, 4},
    {"gl_MultiTexCoord6", Basic::float_, 4}, {"gl_MultiTexCoord7", Basic::float_, 4},
};
constexpr BuiltIn kComputeBuiltIns[] = {
    {"gl_GlobalInvocationID", Basic::uint_, 3},
    {"gl_LocalInvocationID", Basic::uint_, 3},
    {"gl_WorkGroupID", Basic::uint_, 3},
    {"gl_LocalInvocationIndex", Basic::uint_, 1},
};
// Built-in inputs of fragments that are arrays: what an element is.
constexpr BuiltIn kArrays[] = {
    {"gl_TexCoord", Basic::float_, 4},
    {"gl_ClipDistance", Basic::float_, 1},
    {"gl_CullDistance", Basic::float_, 1},
};

std::span<const BuiltIn> builtIns(frontend::Stage stage) {
  switch (stage) {
    case frontend::Stage::vertex:
      return kVertexBuiltIns;
    case frontend::Stage::compute:
      return kComputeBuiltIns;
    default:
      return kFragmentBuiltIns;
  }
}

const BuiltIn* find(std::span<const BuiltIn> among, const std::string& name) {
  const auto found = std::find_if(among.begin(), among.end(),
                                  [&name](const BuiltIn& candidate) { return name == candidate.name; });
  return found == among.end() ? nullptr : &*found;
}

const BuiltIn* builtInArray(const Shader& shader, const std::string& name) {
  return shader.stage == frontend::Stage::fragment ? find(kArrays, name) : nullptr;
}

// interpolateAtCentroid, interpolateAtSample, interpolateAtOffset
bool isInterpolation(const std::string& name) {
  constexpr std::string_view kBefore = "interpolateAt";
  if (!name.starts_with(kBefore)) return false;
  const std::string_view where = std::string_view(name).substr(kBefore.size());
  return where == "Centroid" || where == "Sample" || where == "Offset";
}

const Token& at(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)];
}

TokenIndex tokenCount(const Shader& shader) {
  return static_cast<TokenIndex>(shader.tokens.size());
}

bool isInputQualifier(const std::string& text) {
  return text == "in" || text == "varying" || text == "attribute";
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

// Built-in arrays that one index at least is no literal of stand in their whole, if the size is known.
const Variable* wholeArray(const Shader& shader, const std::string& name) {
  bool computed = false;
  for (TokenIndex i = 0; i < tokenCount(shader); ++i)
    computed = computed ||
               (at(shader, i).text == name && !isRedeclaration(shader, i) && literalIndex(shader, i).empty());
  if (!computed) return nullptr;
  const auto found =
      std::find_if(shader.variables.begin(), shader.variables.end(), [&](const Variable& variable) {
        return variable.name == name && variable.type.isArray() && variable.type.array.front() > 0;
      });
  return found == shader.variables.end() ? nullptr : &*found;
}

Type typeOf(Basic basic, int rows) {
  Type type;
  type.basic = basic;
  type.rows = rows;
  return type;
}

bool isUserInput(const Variable& variable) {
  return variable.storage == Storage::in && variable.declared != frontend::kNone;
}

// Takes away what an ordinary variable cannot have; returns where the `in` stood.
TokenIndex stripQualifiers(Draft& draft, TokenRange range) {
  static const std::set<std::string> qualifiers = {"flat",   "smooth",    "noperspective", "centroid",
                                                   "sample", "invariant", "precise"};
  const Shader& shader = draft.shader();
  TokenIndex input = frontend::kNone;
  for (TokenIndex i = range.first; i <= range.last; ++i) {
    const std::string& text = at(shader, i).text;
    if (qualifiers.contains(text)) draft.edits.remove(i);
    if (isInputQualifier(text)) {
      draft.edits.remove(i);
      input = i;
    }
    if (text != "layout") continue;
    const TokenIndex close = matchingBracket(shader, i + 1);
    for (; i <= close; ++i) draft.edits.remove(i);
    --i;
  }
  return input;
}

TokenRange blockDeclaration(const Shader& shader, TokenIndex open) {
  TokenIndex first = open - 1;
  const auto ends = [&shader](TokenIndex i) {
    return at(shader, i).kind == frontend::TokenKind::directive || at(shader, i).text == ";" ||
           at(shader, i).text == "}";
  };
  while (first > 0 && !ends(first - 1)) --first;
  return {first, matchingBracket(shader, open) + 1};
}

// in Block { ... } block;  or  in Block { ... };  with the brace at `open`
void openBlock(Draft& draft, TokenRange declaration, TokenIndex open) {
  const Shader& shader = draft.shader();
  const TokenIndex close = matchingBracket(shader, open);
  const bool nameless = at(shader, close + 1).text == ";";
  for (TokenIndex i = declaration.first; i < open - 1; ++i)
    if (!nameless && isInputQualifier(at(shader, i).text))
      draft.edits.replace(i, "struct");
    else
      draft.edits.remove(i);
  stripQualifiers(draft, {open + 1, close - 1});
  if (nameless)
    for (const TokenIndex i : {open - 1, open, close, close + 1}) draft.edits.remove(i);
}

void makeVariable(Draft& draft, const Variable& input) {
  const Shader& shader = draft.shader();
  if (const TokenIndex open = openingBrace(shader, input.declared); open != frontend::kNone)
    return openBlock(draft, blockDeclaration(shader, open), open);
  const TokenRange declaration = globalDeclaration(shader, input);
  for (TokenIndex i = declaration.first; i <= declaration.last; ++i) {
    if (at(shader, i).text == "struct") break;  // a structure that is declared in passing
    if (at(shader, i).text == "{") return openBlock(draft, declaration, i);
  }
  TokenIndex end = declaration.first;  // of the qualifiers and the type: the first declared name
  while (end < input.declared && at(shader, end).text != "," && at(shader, end).text != "struct") ++end;
  stripQualifiers(draft, {declaration.first, end - 1});
}

// What an input is at the centroid and at a sample, in a target with one sample, and near by: continued
// linearly.
void declareInterpolation(Draft& draft) {
  const Shader& shader = draft.shader();
  if (std::none_of(shader.tokens.begin(), shader.tokens.end(),
                   [](const Token& token) { return isInterpolation(token.text); }))
    return;
  const std::string precision = draft.highp();
  for (const char* const name : {"float", "vec2", "vec3", "vec4"}) {
    const std::string type = precision + name;
    draft.declare(type + " " + draft.name("AtCentroid") + "(" + type + " v) { return v; }\n" + type + " " +
                  draft.name("AtSample") + "(" + type + " v, " + precision +
                  "int sample_number) { return v; }\n" + type + " " + draft.name("AtOffset") + "(" + type +
                  " v, " + precision + "vec2 o) { return v + o.x * dFdx(v) + o.y * dFdy(v); }");
  }
}

}  // namespace

bool readsInputsElsewhere(const Shader& shader) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [](const Token& token) { return token.text == "interpolateAtOffset"; });
}

Result<std::vector<ThreadInput>> threadInputs(const Draft& draft) {
  const Shader& shader = draft.shader();
  std::vector<ThreadInput> inputs;
  for (const Variable& variable : shader.variables) {
    if (!isUserInput(variable) || !variable.read) continue;
    inputs.push_back({variable.name, variable.name, variable.type});
  }

  std::set<std::string> seen;
  for (TokenIndex i = 0; i < tokenCount(shader); ++i) {
    const std::string& text = at(shader, i).text;
    const BuiltIn* const array = builtInArray(shader, text);
    if (array != nullptr && !isRedeclaration(shader, i)) {
      if (const Variable* const whole = wholeArray(shader, text)) {
        if (seen.insert(text).second) inputs.push_back({text, draft.name(text.substr(3)), whole->type});
        continue;
      }
      const std::string index = literalIndex(shader, i);
      if (index.empty())
        return Failure{"The inputs cannot be replaced yet: " + text +
                       " is used without a literal index or a size."};
      if (seen.insert(text + index).second)
        inputs.push_back({text + "[" + index + "]", draft.name(text.substr(3) + index),
                          typeOf(array->basic, array->rows)});
    }
    const BuiltIn* const built_in = find(builtIns(shader.stage), text);
    if (built_in == nullptr || isRedeclaration(shader, i) || !seen.insert(text).second) continue;
    inputs.push_back({text, draft.name(text.substr(3)), typeOf(built_in->basic, built_in->rows)});
  }
  return inputs;
}

void replaceInputs(Draft& draft, const std::vector<ThreadInput>& inputs) {
  const Shader& shader = draft.shader();
  for (const Variable& variable : shader.variables)
    if (isUserInput(variable)) makeVariable(draft, variable);
  for (const ThreadInput& input : inputs) {
    if (input.input == input.variable) continue;
    const std::string precision = input.type.basic == Basic::bool_ ? "" : draft.highp();
    // The size behind the name: GLSL 1.10 takes it nowhere else.
    const bool array = input.type.isArray();
    const std::string size = array ? "[" + std::to_string(input.type.array.front()) + "]" : "";
    draft.declare(precision + frontend::glslName(array ? input.type.element() : input.type) + " " +
                  input.variable + size + ";");
  }

  declareInterpolation(draft);

  for (TokenIndex i = 0; i < tokenCount(shader); ++i) {
    const Token& token = at(shader, i);
    if (isInterpolation(token.text))
      draft.edits.replace(i, draft.name(token.text.substr(std::string_view("interpolate").size())));
    const bool array = builtInArray(shader, token.text) != nullptr;
    const bool element = array && wholeArray(shader, token.text) == nullptr;
    const std::string watch = element ? token.text + "[" + literalIndex(shader, i) + "]" : token.text;
    const auto input = std::find_if(inputs.begin(), inputs.end(), [&watch](const ThreadInput& candidate) {
      return candidate.input == watch && candidate.input != candidate.variable;
    });
    if ((input != inputs.end() || array) && isRedeclaration(shader, i)) {
      Variable variable;
      variable.declared = i;
      const TokenRange declaration = globalDeclaration(shader, variable);
      for (TokenIndex dropped = declaration.first; dropped <= declaration.last; ++dropped)
        draft.edits.remove(dropped);
      i = declaration.last;
    } else if (input != inputs.end()) {
      draft.edits.replace(i, input->variable);
      if (element)
        for (TokenIndex index = i + 1; index <= i + 3; ++index) draft.edits.remove(index);
    }
  }
}

}  // namespace shadestep::instrumenter
