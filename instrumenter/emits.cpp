// What a geometry shader emits: every vertex with the values of the outputs, appended to a list, in one pass
// over the program's own emits (thesis 7.1.3 needs two, of transform feedback).
//
// EmitVertex() becomes sd_emit_vertex(), which lists the vertex and then emits it; EmitStreamVertex(1)
// becomes (sd_emit(1), EmitStreamVertex(1)); EndPrimitive and EndStreamPrimitive likewise.
#include <algorithm>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/declaration.h"
#include "instrumenter/storage.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::TokenIndex;
using frontend::Type;

namespace {

const char* const kEmitFieldNames[kEmitFields] = {"thread", "stream", "strip", "vertices"};

const std::string& textAt(const Shader& shader, TokenIndex i) {
  return shader.tokens[static_cast<std::size_t>(i)].text;
}

std::string argumentOf(const Shader& shader, TokenIndex open, TokenIndex close) {
  std::string text;
  for (TokenIndex i = open + 1; i < close; ++i) text += textAt(shader, i) + " ";
  return text;
}

void replaceEmits(Draft& draft) {
  const Shader& shader = draft.shader();
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i) {
    if (textAt(shader, i + 1) != "(") continue;
    const std::string& name = textAt(shader, i);
    if (name == "EmitVertex") draft.edits.replace(i, draft.name("emit_vertex"));
    if (name == "EndPrimitive") draft.edits.replace(i, draft.name("end_primitive"));
    const bool emits = name == "EmitStreamVertex";
    const TokenIndex close = matchingBracket(shader, i + 1);
    if ((!emits && name != "EndStreamPrimitive") || close == frontend::kNone) continue;
    draft.edits.wrap(
        {i, close},
        "(" + draft.name(emits ? "emit(" : "end_strip(") + argumentOf(shader, i + 1, close) + "), ", ")");
  }
}

std::string countersOf(const Draft& draft) {
  return "int " + draft.name("thread") + ", " + draft.name("vertices") + ";\nint " + draft.name("strips") +
         "[4];\nint " + draft.name("emit(int stream);\nint ") + draft.name("end_strip(int stream);\nvoid ") +
         draft.name("emit_vertex();\nvoid ") + draft.name("end_primitive();");
}

}  // namespace

Result<EmitsShader> instrumentEmits(const Shader& shader, const Target& target) {
  Draft draft(shader);
  std::string reason = noStorage(shader, target);
  if (!reason.empty()) return Failure{"What a geometry shader emits is listed by " + reason + "."};
  Attachments attachments(draft, target);
  if (!attachments.failure().empty()) return Failure{attachments.failure()};

  EmitsShader emits;
  Type number;
  number.basic = frontend::Basic::int_;
  for (const char* name : kEmitFieldNames) attachments.add(name, number);
  const std::string thread = draft.name("thread"), vertices = draft.name("vertices");
  const std::string strips = draft.name("strips");
  std::vector<std::string> values = {thread, "stream", strips + "[stream]", vertices};
  for (const frontend::VariableId id : stageOutputs(shader)) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    if (frontend::wordCount(variable.type) > 0 && attachments.add(variable.name, variable.type))
      values.push_back(variable.name);
    else
      emits.left_out.push_back(variable.name);
  }
  attachments.declare();
  draft.declare(countersOf(draft));
  const std::vector<std::string> at_end = {thread, "0", "0", vertices};
  attachments.frame("  " + thread + " = atomicAdd(" + draft.name("started") + ", 1);\n  " + vertices +
                        " = 0;\n  for (int i = 0; i < 4; ++i) " + strips + "[i] = 0;\n",
                    "  " + attachments.assign(kLaunched, at_end) + ";\n");
  draft.append("int " + draft.name("emit(int stream) {\n  ") +
               attachments.assign(kLaunched | kReached, values) + ";\n" + attachments.write() +
               "  return ++" + vertices + ";\n}");
  draft.append("int " + draft.name("end_strip(int stream) { return ++") + strips + "[stream]; }");
  draft.append("void " + draft.name("emit_vertex() { ") + draft.name("emit(0); EmitVertex(); }"));
  draft.append("void " + draft.name("end_primitive() { ") + draft.name("end_strip(0); EndPrimitive(); }"));
  replaceEmits(draft);

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  emits.text = std::move(std::get<std::string>(text));
  emits.layout = attachments.layout();
  return emits;
}

EmitLimits emitLimits(const Shader& shader) {
  EmitLimits limits;
  const auto count = static_cast<TokenIndex>(shader.tokens.size());
  for (TokenIndex i = 0; i + 1 < count; ++i) {
    if (textAt(shader, i) != "layout" || textAt(shader, i + 1) != "(") continue;
    const TokenIndex close = matchingBracket(shader, i + 1);
    if (close == frontend::kNone || close + 1 >= count || textAt(shader, close + 1) != "out") continue;
    for (TokenIndex k = i + 2; k < close; ++k) {
      const std::string& word = textAt(shader, k);
      if (word == "points" || word == "line_strip" || word == "triangle_strip") limits.primitive = word;
      if (word != "max_vertices" || k + 2 >= close) continue;
      const std::string& number = textAt(shader, k + 2);
      const bool alone = k + 3 == close || textAt(shader, k + 3) == ",";
      const bool digits = number.size() < 6 && std::all_of(number.begin(), number.end(),
                                                           [](char c) { return c >= '0' && c <= '9'; });
      if (alone && digits && number.front() != '0') limits.max_vertices = std::stoi(number);
    }
  }
  return limits;
}

}  // namespace shadestep::instrumenter
