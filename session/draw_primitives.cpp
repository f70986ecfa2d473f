#include "session/draw_primitives.h"

#include <algorithm>

#include "instrumenter/origin.h"
#include "session/discarded_threads.h"

namespace shadestep::session {
namespace {

using instrumenter::Probe;

constexpr std::uint32_t kPatches = 0xE;  // GL_PATCHES

// What draws with adjacency are made of is told by the geometry shader alone, which sees all of its vertices.
bool isFollowed(std::uint32_t mode, bool geometry) {
  return mode <= 0x6 || mode == kPatches || (geometry && mode >= 0xA && mode <= 0xC);
}

frontend::Type integer() {
  frontend::Type type;
  type.basic = frontend::Basic::int_;
  return type;
}

// At the start of main.
Probe startProbe(const frontend::Shader& shader, const std::string& watched) {
  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  if (!watched.empty()) probe.watches.push_back({watched, frontend::kNone, integer()});
  return probe;
}

// Vertices of a patch of the draw.
int patchVertices(Session& session) {
  session.select(hasStage(session, Stage::tess_control) ? Stage::tess_control : Stage::tess_eval);
  session.requireCapturable();
  const ThreadValues threads = valuesAt(session, startProbe(session.shader(), "gl_PatchVerticesIn"));
  for (std::size_t t = 0; t < threads.marks.size(); ++t)
    if (threads.reachedAt(t)) return static_cast<std::int32_t>(*threads.values.at(0).at(t));
  cannotTell("the draw runs no patch");
}

// Whether the fragments come through a geometry shader, which then has to tell their primitives; else
// gl_PrimitiveID does. Selects the fragment stage.
bool throughGeometry(Session& session) {
  requireNumberedPrimitives(session);
  session.select(Stage::fragment);
  session.requireCapturable();
  if (hasStage(session, Stage::geometry)) {
    if (hasStage(session, Stage::tess_eval))
      cannotTell("behind tessellation a geometry shader does not count the draw's primitives");
    return true;
  }
  const frontend::Shader& shader = session.shader();
  if (shader.version < 150 || (shader.profile == "es" && shader.version < 320))
    cannotTell("its shader's GLSL " + std::to_string(shader.version) + " has no gl_PrimitiveID");
  return false;
}

}  // namespace

void cannotTell(const std::string& reason) {
  throw Error(Outcome::cannot_debug, "which primitive made which fragment cannot be told: " + reason);
}

bool hasStage(Session& session, Stage stage) {
  const std::vector<StageFacts>& stages = session.facts().stages;
  return std::any_of(stages.begin(), stages.end(),
                     [stage](const StageFacts& one) { return one.stage == stage; });
}

void requireNumberedPrimitives(Session& session) {
  const DrawStop& stop = session.stop();
  if (!drawsOnce(stop))
    cannotTell("the draw has several instances, or is several draws, whose primitives have the same numbers");
  for (const auto& [name, value] : session.glState()) {
    const bool restarts = name == "GL_PRIMITIVE_RESTART" || name == "GL_PRIMITIVE_RESTART_FIXED_INDEX";
    if (restarts && value != "0" && stop.call.find("Elements") != std::string::npos)
      cannotTell("the draw restarts its primitives");
  }
}

ThreadValues originsOnPixels(Session& session, Stage before, Provoking provoking) {
  session.select(Stage::fragment);
  session.requireCapturable();
  auto instrumented =
      instrumenter::instrumentOrigin(session.shader(), session.shader(before), session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) cannotTell(failure->reason);
  const auto& shaders = std::get<instrumenter::OriginShaders>(instrumented);
  ExecuteOptions options;
  options.provoking = provoking;
  const Captured captured = session.capture(session.prepare(shaders.fragment, before, shaders.before),
                                            shaders.fragment.layout, options);
  ThreadValues threads;
  addPass(threads, captured.threads, captured.layout, captured.execution.check);
  return threads;
}

ThreadValues primitivesOnPixels(Session& session) {
  if (throughGeometry(session)) return originsOnPixels(session, Stage::geometry);
  return valuesAt(session, startProbe(session.shader(), "gl_PrimitiveID"));
}

PrimitiveFragments allFragments(Session& session) {
  const bool geometry = throughGeometry(session);
  if (severalPlanes(session.facts())) cannotTell("the target has several layers or samples");
  const frontend::Shader& shader = session.shader();
  auto instrumented = instrumenter::listOrigins(shader, geometry ? &session.shader(Stage::geometry) : nullptr,
                                                session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) cannotTell(failure->reason);
  const auto& shaders = std::get<instrumenter::OriginShaders>(instrumented);
  Captured captured;
  captured.layout = shaders.fragment.layout;
  const Prepared prepared = geometry ? session.prepare(shaders.fragment, Stage::geometry, shaders.before)
                                     : session.prepare(shaders.fragment);
  const instrumenter::DiscardedThreads listed = session.captureListed(prepared, {}, captured);
  if (listed.ended > listed.threads.size())
    cannotTell("the draw's " + std::to_string(listed.ended) + " fragments do not fit into memory");
  PrimitiveFragments result;
  result.check = captured.execution.check;
  const instrumenter::FieldDecoder decoder(captured.layout, captured.layout.fields.at(0));
  const bool from_top = countsRowsFromTop(shader);
  for (const instrumenter::DiscardedThread& thread : listed.threads) {
    std::uint32_t origin[4];
    decoder.decode(thread.words, origin);
    const int y = from_top ? session.facts().height - 1 - thread.y : thread.y;
    result.fragments.push_back({thread.x, y, static_cast<std::int32_t>(origin[0])});
  }
  return result;
}

void addPrimitiveCheck(Check& to, const Check& check) {
  if (check.compared_at_all && !check.identical())
    cannotTell("the instrumented draw differs from the program's own");
  to.merge(check);
}

// A capture by transform feedback lists the vertices as the draw issues them.
DrawPrimitives::DrawPrimitives(Session& session) : mode_(session.stop().mode) {
  requireNumberedPrimitives(session);
  const bool geometry = hasStage(session, Stage::geometry);
  if (geometry && mode_ == kPatches)
    cannotTell("behind tessellation a geometry shader does not count the draw's primitives");
  if (!isFollowed(mode_, geometry))
    cannotTell(
        "only points, lines, triangles and patches are followed to their vertices, and lists with "
        "adjacency through a geometry shader");
  if (mode_ == kPatches) patch_ = patchVertices(session);
  session.select(Stage::vertex);
  session.requireCapturable();
  auto instrumented =
      instrumenter::instrumentSingle(session.shader(), startProbe(session.shader(), ""), session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) cannotTell(failure->reason);
  const Captured issued = session.capture(std::get<instrumenter::AttachmentShader>(instrumented));
  if (issued.layout.carrier == instrumenter::Carrier::list || issued.layout.identity.empty())
    cannotTell("this needs transform feedback, and gl_VertexID in the vertex shader");
  addPass(vertices_, issued.threads, issued.layout, issued.execution.check);
  addPrimitiveCheck(vertices_.check, issued.execution.check);
}

std::size_t DrawPrimitives::count() const {
  const int vertices = vertices_.width;
  const auto primitives = [&] {
    switch (mode_) {
      case 0x0:  // GL_POINTS
      case 0x2:  // GL_LINE_LOOP
        return vertices;
      case 0x1:  // GL_LINES
        return vertices / 2;
      case 0x3:  // GL_LINE_STRIP
        return vertices - 1;
      case 0x4:  // GL_TRIANGLES
        return vertices / 3;
      case 0x5:  // GL_TRIANGLE_STRIP
      case 0x6:  // GL_TRIANGLE_FAN
        return vertices - 2;
      case 0xA:  // GL_LINES_ADJACENCY
        return vertices / 4;
      case 0xB:  // GL_LINE_STRIP_ADJACENCY
        return vertices - 3;
      case 0xC:  // GL_TRIANGLES_ADJACENCY
        return vertices / 6;
      default:
        return patch_ > 0 ? vertices / patch_ : 0;
    }
  };
  return static_cast<std::size_t>(std::max(primitives(), 0));
}

// Where in the draw's sequence of vertices those of a primitive stand (OpenGL 4.6, 10.1).
std::vector<int> DrawPrimitives::placesOf(int p) const {
  switch (mode_) {
    case 0x0:
      return {p};
    case 0x1:
      return {2 * p, 2 * p + 1};
    case 0x2:
      return {p, (p + 1) % std::max(vertices_.width, 1)};
    case 0x3:
      return {p, p + 1};
    case 0x4:
      return {3 * p, 3 * p + 1, 3 * p + 2};
    case 0x5:
      return {p, p + 1, p + 2};
    case 0x6:
      return {0, p + 1, p + 2};
    case 0xB:
      return {p, p + 1, p + 2, p + 3};
    default:
      break;
  }
  const int each = mode_ == 0xA ? 4 : mode_ == 0xC ? 6 : patch_;
  std::vector<int> places;
  for (int i = 0; i < each; ++i) places.push_back(p * each + i);
  return places;
}

std::vector<ThreadName> DrawPrimitives::verticesOf(int primitive) const {
  std::vector<ThreadName> names;
  for (const int place : placesOf(primitive)) {
    if (place >= vertices_.width) cannotTell("the draw has fewer vertices than its primitives need");
    ThreadName name;
    for (const WatchedValues& one : vertices_.identity)
      name.emplace_back(one.name, static_cast<std::int32_t>(*one.at(static_cast<std::size_t>(place))));
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<int> DrawPrimitives::primitivesWith(const ThreadName& vertex) const {
  const std::size_t first = requireThread(vertices_, vertex);
  std::vector<std::uint8_t> same(vertices_.marks.size(), 0);
  for (std::size_t t = 0; t < same.size(); ++t)
    same[t] = std::all_of(vertices_.identity.begin(), vertices_.identity.end(),
                          [&](const WatchedValues& one) { return *one.at(t) == *one.at(first); });
  std::vector<int> primitives;
  for (int p = 0; p < static_cast<int>(count()); ++p) {
    const std::vector<int> places = placesOf(p);
    if (std::any_of(places.begin(), places.end(),
                    [&](int place) { return same[static_cast<std::size_t>(place)] != 0; }))
      primitives.push_back(p);
  }
  return primitives;
}

}  // namespace shadestep::session
