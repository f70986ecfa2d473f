#include "session/fragment_origin.h"

#include <algorithm>

#include "session/thread_values.h"

namespace shadestep::session {
namespace {

using instrumenter::Probe;

[[noreturn]] void cannotTell(const std::string& reason) {
  throw Error(Outcome::cannot_debug, "which primitive made the fragment cannot be told: " + reason);
}

bool has(const DrawFacts& facts, Stage stage) {
  return std::any_of(facts.stages.begin(), facts.stages.end(),
                     [stage](const StageFacts& one) { return one.stage == stage; });
}

void requireTold(Session& session) {
  const DrawFacts& facts = session.facts();
  const DrawStop& stop = session.stop();
  if (has(facts, Stage::geometry))
    cannotTell("the program has a geometry shader; 'shadestep primitives' shows what it makes of each");
  if (!drawsOnce(stop))
    cannotTell("the draw has several instances, or is several draws, whose primitives have the same numbers");
  for (const auto& [name, value] : session.glState()) {
    const bool restarts = name == "GL_PRIMITIVE_RESTART" || name == "GL_PRIMITIVE_RESTART_FIXED_INDEX";
    if (restarts && value != "0" && stop.call.find("Elements") != std::string::npos)
      cannotTell("the draw restarts its primitives");
  }
}

void add(FragmentOrigin& origin, const Check& check) {
  if (check.compared_at_all && !check.identical())
    cannotTell("the instrumented draw differs from the program's own");
  origin.check.merge(check);
}

FragmentOrigin primitiveAt(Session& session, int x, int y) {
  session.select(Stage::fragment);
  session.requireCapturable();
  const frontend::Shader& shader = session.shader();
  if (shader.version < 150 || (shader.profile == "es" && shader.version < 320))
    cannotTell("its shader's GLSL " + std::to_string(shader.version) + " has no gl_PrimitiveID");
  const DrawFacts& facts = session.facts();
  if (x < 0 || y < 0 || x >= facts.width || y >= facts.height)
    throw Error(Outcome::nothing_matches, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                              " is outside the target of " + std::to_string(facts.width) +
                                              " x " + std::to_string(facts.height) + " pixels");
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  frontend::Type number;
  number.basic = frontend::Basic::int_;
  probe.watches.push_back({"gl_PrimitiveID", frontend::kNone, number});
  const ThreadValues values = valuesAt(session, probe);
  const auto pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(facts.width) + static_cast<std::size_t>(x);
  if (!values.reachedAt(pixel) || (values.marks[pixel] & instrumenter::kDiscarded) != 0)
    throw Error(Outcome::nothing_matches,
                "the draw shows no fragment on pixel " + std::to_string(x) + "," + std::to_string(y));
  FragmentOrigin origin;
  origin.primitive = static_cast<std::int32_t>(*values.values.at(0).at(pixel));
  add(origin, values.check);
  return origin;
}

// Where in the draw's sequence of vertices those of a primitive stand (OpenGL 4.6, 10.1).
std::vector<int> verticesOf(std::uint32_t mode, int p, int count) {
  switch (mode) {
    case 0x0:  // GL_POINTS
      return {p};
    case 0x1:  // GL_LINES
      return {2 * p, 2 * p + 1};
    case 0x2:  // GL_LINE_LOOP
      return {p, (p + 1) % std::max(count, 1)};
    case 0x3:  // GL_LINE_STRIP
      return {p, p + 1};
    case 0x4:  // GL_TRIANGLES
      return {3 * p, 3 * p + 1, 3 * p + 2};
    case 0x5:  // GL_TRIANGLE_STRIP
      return {p, p + 1, p + 2};
    case 0x6:  // GL_TRIANGLE_FAN
      return {0, p + 1, p + 2};
    default:
      cannotTell("only points, lines, triangles and patches are followed back to their vertices");
  }
}

// The vertices as the draw issues them, which those of a capture by transform feedback are.
void fromVertices(Session& session, FragmentOrigin& origin) {
  const frontend::Shader& shader = session.shader();
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  auto instrumented = instrumenter::instrumentSingle(shader, probe, session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) cannotTell(failure->reason);
  const Captured issued = session.capture(std::get<instrumenter::AttachmentShader>(instrumented));
  if (issued.layout.carrier == instrumenter::Carrier::list || issued.layout.identity.empty())
    cannotTell("this needs transform feedback, and gl_VertexID in the vertex shader");
  add(origin, issued.execution.check);
  for (const int number : verticesOf(session.stop().mode, origin.primitive, issued.threads.width())) {
    if (number >= issued.threads.width()) cannotTell("the draw has fewer vertices than its primitives need");
    ThreadName name;
    for (const instrumenter::Field& field : issued.layout.identity)
      name.emplace_back(
          field.name,
          static_cast<std::int32_t>(
              instrumenter::decode(issued.layout, field, issued.threads.at(number, 0).data()).words.at(0)));
    origin.threads.push_back(std::move(name));
  }
}

void fromPatch(Session& session, FragmentOrigin& origin) {
  Probe probe;
  const frontend::Shader& shader = session.shader();
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const ThreadValues threads = valuesAt(session, probe);
  add(origin, threads.check);
  for (std::size_t i = 0; i < threads.marks.size(); ++i) {
    if (static_cast<std::int32_t>(*threads.identity.at(0).at(i)) == origin.primitive)
      origin.threads.push_back({{"primitive", origin.primitive},
                                {"vertex", static_cast<std::int32_t>(*threads.identity.at(1).at(i))}});
  }
}

}  // namespace

FragmentOrigin originOf(Session& session, int x, int y, Stage stage) {
  requireTold(session);
  const bool patches = has(session.facts(), Stage::tess_eval);
  FragmentOrigin origin = primitiveAt(session, x, y);
  const std::string from = "the fragment comes from patch " + std::to_string(origin.primitive);
  if (patches && stage == Stage::vertex)
    throw Error(Outcome::cannot_debug,
                from + "; --stage tess-control shows its runs, with what the vertices gave them");
  if (stage == Stage::tess_eval)
    throw Error(Outcome::cannot_debug,
                from + ", but which of its generated vertices made it is not known; --primitive " +
                    std::to_string(origin.primitive) + " --vertex N shows one");
  session.select(stage);
  session.requireCapturable();
  if (stage == Stage::vertex)
    fromVertices(session, origin);
  else
    fromPatch(session, origin);
  return origin;
}

}  // namespace shadestep::session
