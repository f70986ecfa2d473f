// From a fragment back to what made it.
//
//   EmitVertex();    ->    sd_emit_vertex();    which sets the flat output, counts, and emits
#include "instrumenter/origin.h"

#include <algorithm>

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/declaration.h"
#include "instrumenter/constructs/geometry_output.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/storage.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Shader;
using frontend::Stage;
using frontend::TokenIndex;
using frontend::Type;

namespace {

Type typeOf(Basic basic, int rows) {
  Type type;
  type.basic = basic;
  type.rows = rows;
  return type;
}

// Of the output and input that carry it: in neither shader.
std::string freshName(const Shader& one, const Shader& other) {
  const auto taken = [](const Shader& shader, const std::string& name) {
    const std::vector<std::string> used = frontend::identifiers(shader);
    return std::find(used.begin(), used.end(), name) != used.end();
  };
  std::string name = "sd_origin";
  while (taken(one, name) || taken(other, name)) name += "0";
  return name;
}

bool hasFlatInputs(const Shader& shader) {
  return shader.version >= (isEs(shader) ? 300 : 130);
}

std::string declared(const Draft& draft, const std::string& direction, const std::string& name) {
  return "flat " + direction + " " + draft.highp() + "ivec4 " + name + ";";
}

enum class Fragments { shown, all };

// `name`: of the input that tells it, "" = gl_PrimitiveID does.
Result<AttachmentShader> showOrigin(const Shader& fragment, const std::string& name, Fragments which,
                                    const Target& target) {
  Draft draft(fragment);
  Attachments attachments(draft, target);
  if (!attachments.failure().empty()) return Failure{attachments.failure()};
  if (!attachments.add("origin", typeOf(Basic::int_, 4)))
    return Failure{"Who made a fragment does not fit into " + attachments.place() + "."};
  if (!name.empty()) draft.declare(declared(draft, "in", name));
  attachments.declare();
  const std::string start =
      "  " +
      attachments.assign(kLaunched | kReached, {name.empty() ? "ivec4(gl_PrimitiveID, 0, 0, 0)" : name}) +
      ";\n";
  if (which == Fragments::shown)
    attachments.frame(start, "");
  else if (!attachments.frameListed(start))
    return Failure{"Fragments that the draw does not show are told by " + noStorage(fragment, target) + "."};
  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  return AttachmentShader{std::move(std::get<std::string>(text)), attachments.layout()};
}

// EmitStreamVertex(0) becomes (sd_mark(), EmitStreamVertex(0)).
void markEmits(Draft& draft, const std::string& mark) {
  const Shader& shader = draft.shader();
  for (TokenIndex i = 0; i + 1 < static_cast<TokenIndex>(shader.tokens.size()); ++i) {
    const bool emits = shader.tokens[static_cast<std::size_t>(i)].text == "EmitStreamVertex" &&
                       shader.tokens[static_cast<std::size_t>(i) + 1].text == "(";
    const TokenIndex close = emits ? matchingBracket(shader, i + 1) : frontend::kNone;
    if (close != frontend::kNone) draft.edits.wrap({i, close}, "(" + mark + "(), ", ")");
  }
}

void tellRun(Draft& draft, const std::string& name, const Target& target) {
  const std::vector<Identity> identity = identityOf(draft.shader(), target);
  const std::string invocation = identity.size() > 1 ? identity[1].expression : "0";
  const std::string emitted = draft.name("emitted"), mark = draft.name("mark");
  const std::string emit = draft.name("emit_vertex");
  draft.declare("int " + emitted + ";\nint " + mark + "();\nvoid " + emit + "();");
  wrapMain(draft, "  " + emitted + " = 0;\n", "");
  draft.append("int " + mark + "() {\n  " + name + " = ivec4(" + identity[0].expression + ", " + invocation +
               ", " + emitted + ", 0);\n  return ++" + emitted + ";\n}");
  draft.append("void " + emit + "() { " + mark + "(); EmitVertex(); }");
  replaceCalls(draft, "EmitVertex", emit);
  markEmits(draft, mark);
}

void tellCoordinates(Draft& draft, const std::string& name) {
  prepareWords(draft);
  const auto bits = [&draft](const std::string& coordinate) {
    return intWords(draft, coordinate, typeOf(Basic::float_, 1)).front();
  };
  wrapMain(draft,
           "  " + name + " = ivec4(gl_PrimitiveID, " + bits("gl_TessCoord.x") + ", " +
               bits("gl_TessCoord.y") + ", 0);\n",
           "");
}

Result<OriginShaders> told(const Shader& fragment, const Shader& before, Fragments which,
                           const Target& target) {
  if (!hasFlatInputs(fragment))
    return Failure{"A fragment shader of GLSL " + std::to_string(fragment.version) +
                   " has no flat inputs, by which it could be told who made a fragment."};
  const std::string name = freshName(fragment, before);
  auto shown = showOrigin(fragment, name, which, target);
  if (auto* failure = std::get_if<Failure>(&shown)) return *failure;

  Draft draft(before);
  draft.declare(declared(draft, "out", name));
  if (before.stage == Stage::geometry)
    tellRun(draft, name, target);
  else
    tellCoordinates(draft, name);
  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  return OriginShaders{std::move(std::get<AttachmentShader>(shown)), std::move(std::get<std::string>(text))};
}

}  // namespace

Result<OriginShaders> instrumentOrigin(const Shader& fragment, const Shader& before, const Target& target) {
  return told(fragment, before, Fragments::shown, target);
}

Result<OriginShaders> listOrigins(const Shader& fragment, const Shader* before, const Target& target) {
  if (before != nullptr) return told(fragment, *before, Fragments::all, target);
  auto listed = showOrigin(fragment, "", Fragments::all, target);
  if (auto* failure = std::get_if<Failure>(&listed)) return *failure;
  return OriginShaders{std::move(std::get<AttachmentShader>(listed)), ""};
}

int generatedVertices(const Shader& evaluation) {
  int vertices = 3;
  for (const LayoutQualifier& one : layoutsOf(evaluation, "in")) {
    const std::string& name = evaluation.tokens[static_cast<std::size_t>(one.name)].text;
    if (name == "point_mode") return 1;
    if (name == "isolines") vertices = 2;
  }
  return vertices;
}

}  // namespace shadestep::instrumenter
