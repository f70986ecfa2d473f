// What a geometry shader emits: every vertex with the values of the outputs, in one pass over the program's
// own emits (thesis 7.1.3 needs two, of transform feedback).
//
// EmitVertex() becomes sd_emit_vertex(), which lists the vertex and then emits it; EmitStreamVertex(1)
// becomes (sd_emit(1), EmitStreamVertex(1)); EndPrimitive and EndStreamPrimitive likewise. Where there are no
// storage buffers, a point is emitted for each vertex, and one at the thread's end, and nothing of the
// shader's own: transform feedback lists them.
#include <algorithm>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/declaration.h"
#include "instrumenter/constructs/geometry_output.h"
#include "instrumenter/constructs/main.h"
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

// `points`: nothing of the shader's own is emitted.
void replaceEmits(Draft& draft, bool points) {
  const Shader& shader = draft.shader();
  replaceCalls(draft, "EmitVertex", draft.name("emit_vertex"));
  replaceCalls(draft, "EndPrimitive", draft.name("end_primitive"));
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i) {
    if (textAt(shader, i + 1) != "(") continue;
    const std::string& name = textAt(shader, i);
    const bool emits = name == "EmitStreamVertex";
    const TokenIndex close = matchingBracket(shader, i + 1);
    if ((!emits && name != "EndStreamPrimitive") || close == frontend::kNone) continue;
    const std::string own = draft.name(emits ? "emit" : "end_strip");
    if (points)
      draft.edits.replace(i, own);
    else
      draft.edits.wrap({i, close}, "(" + own + "(" + argumentOf(shader, i + 1, close) + "), ", ")");
  }
}

std::string countersOf(const Draft& draft) {
  return "int " + draft.name("thread") + ", " + draft.name("vertices") + ";\nint " + draft.name("strips") +
         "[4];\nint " + draft.name("emit(int stream);\nint ") + draft.name("end_strip(int stream);\nvoid ") +
         draft.name("emit_vertex();\nvoid ") + draft.name("end_primitive();");
}

// The most words of a point that may be emitted so often (OpenGL 4.6, table 23.60; the least that a driver
// offers).
int mostWords(int points) {
  constexpr int kTotalComponents = 1024;
  return kTotalComponents / points / 4 * 4;
}

}  // namespace

Result<EmitsShader> instrumentEmits(const Shader& shader, const Target& target) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  const bool points = attachments.feedback();
  const int most = emitLimits(shader).max_vertices;
  std::string reason = attachments.failure();
  if (!reason.empty()) return Failure{"What a geometry shader emits cannot be listed. " + reason};
  if (points && most < 0)
    return Failure{"What a geometry shader emits is listed by " + noStorage(shader, target) +
                   ", or for max_vertices that is a plain number."};

  EmitsShader emits;
  Type number;
  number.basic = frontend::Basic::int_;
  for (const char* name : kEmitFieldNames) attachments.add(name, number);
  const std::string thread = draft.name("thread"), vertices = draft.name("vertices");
  const std::string strips = draft.name("strips");
  std::vector<std::string> values = {thread, "stream", strips + "[stream]", vertices};
  for (const frontend::VariableId id : stageOutputs(shader)) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const int words = frontend::wordCount(variable.type);
    const bool too_many = points && attachments.layout().words + words > mostWords(most + 1);
    if (words > 0 && !too_many && attachments.add(variable.name, variable.type))
      values.push_back(variable.name);
    else
      emits.left_out.push_back(variable.name);
  }
  attachments.declare();
  draft.declare(countersOf(draft));
  const std::string start = points ? "0" : "atomicAdd(" + draft.name("started") + ", 1)";
  const std::string before = "  " + thread + " = " + start + ";\n  " + vertices +
                             " = 0;\n  for (int i = 0; i < 4; ++i) " + strips + "[i] = 0;\n";
  const std::string after = "  " + attachments.assign(kLaunched, {thread, "0", "0", vertices}) + ";\n";
  std::string list = attachments.assign(kLaunched | kReached, values) + ";\n" + attachments.write();
  if (points) {
    declarePoints(draft, most + 1);
    wrapMain(draft, before, after + attachments.write() + emitPoint());
    list = "if (" + vertices + " < " + std::to_string(most) + ") {\n  " + list + emitPoint() + "  }\n";
  } else {
    attachments.frame(before, after);
  }
  draft.append("int " + draft.name("emit(int stream) {\n  ") + list + "  return ++" + vertices + ";\n}");
  draft.append("int " + draft.name("end_strip(int stream) { return ++") + strips + "[stream]; }");
  const std::string emit = points ? "" : " EmitVertex();", end = points ? "" : " EndPrimitive();";
  draft.append("void " + draft.name("emit_vertex() { ") + draft.name("emit(0);") + emit + " }");
  draft.append("void " + draft.name("end_primitive() { ") + draft.name("end_strip(0);") + end + " }");
  replaceEmits(draft, points);

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  emits.text = std::move(std::get<std::string>(text));
  emits.layout = attachments.layout();
  return emits;
}

EmitLimits emitLimits(const Shader& shader) {
  EmitLimits limits;
  for (const LayoutQualifier& one : layoutsOf(shader, "out")) {
    const std::string& name = textAt(shader, one.name);
    if (name == "points" || name == "line_strip" || name == "triangle_strip") limits.primitive = name;
    if (name != "max_vertices" || one.value.first != one.value.last) continue;
    const std::string& number = textAt(shader, one.value.first);
    const bool digits = number.size() < 6 && std::all_of(number.begin(), number.end(),
                                                         [](char c) { return c >= '0' && c <= '9'; });
    if (digits && number.front() != '0') limits.max_vertices = std::stoi(number);
  }
  return limits;
}

}  // namespace shadestep::instrumenter
