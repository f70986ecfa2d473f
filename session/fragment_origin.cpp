#include "session/fragment_origin.h"

#include <algorithm>
#include <cstdlib>

#include "instrumenter/origin.h"
#include "session/draw_primitives.h"
#include "session/generated_primitives.h"
#include "session/verify_samples.h"

namespace shadestep::session {
namespace {

constexpr const char* kFirstVertex = "36429";  // GL_FIRST_VERTEX_CONVENTION

std::size_t pixelOf(Session& session, int x, int y) {
  const DrawFacts& facts = session.facts();
  if (x >= 0 && y >= 0 && x < facts.width && y < facts.height)
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(facts.width) + static_cast<std::size_t>(x);
  throw Error(Outcome::nothing_matches, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                            " is outside the target of " + std::to_string(facts.width) +
                                            " x " + std::to_string(facts.height) + " pixels");
}

// The first value of the visible fragment on the pixel.
const std::uint32_t* shownAt(Session& session, const ThreadValues& values, std::size_t pixel) {
  if (values.reachedAt(pixel) && (values.marks[pixel] & instrumenter::kDiscarded) == 0)
    return values.values.at(0).at(pixel);
  const auto width = static_cast<std::size_t>(session.facts().width);
  throw Error(Outcome::nothing_matches, "the draw shows no fragment on pixel " +
                                            std::to_string(pixel % width) + "," +
                                            std::to_string(pixel / width));
}

bool firstVertexProvokes(Session& session) {
  const auto state = session.glState();
  return std::any_of(state.begin(), state.end(), [](const auto& one) {
    return one.first == "GL_PROVOKING_VERTEX" && one.second == kFirstVertex;
  });
}

// The vertices that a run emitted are told apart by their order, of which the provoking one is the first or
// the last (OpenGL 4.6, table 13.2).
void readRun(Session& session, const std::uint32_t* told, FragmentOrigin& origin) {
  const std::string made = instrumenter::emitLimits(session.shader(Stage::geometry)).primitive;
  const int count = made == "points" ? 1 : made == "line_strip" ? 2 : 3;
  const auto provoking = static_cast<std::int32_t>(told[2]);
  const int first = firstVertexProvokes(session) ? provoking : provoking - (count - 1);
  if (made.empty() || first < 0) cannotTell("the geometry shader's output is not known");
  origin.invocation = static_cast<std::int32_t>(told[1]);
  for (int i = 0; i < count; ++i) origin.emitted.push_back(first + i);
}

FragmentOrigin primitiveAt(Session& session, std::size_t pixel) {
  const ThreadValues values = primitivesOnPixels(session);
  const std::uint32_t* told = shownAt(session, values, pixel);
  FragmentOrigin origin;
  origin.primitive = static_cast<std::int32_t>(told[0]);
  if (hasStage(session, Stage::geometry)) readRun(session, told, origin);
  addPrimitiveCheck(origin.check, values.check);
  return origin;
}

// All threads of the selected stage, at their start.
ThreadValues threadsOf(Session& session, FragmentOrigin& origin) {
  instrumenter::Probe probe;
  const frontend::Shader& shader = session.shader();
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  ThreadValues threads = valuesAt(session, probe);
  addPrimitiveCheck(origin.check, threads.check);
  return threads;
}

void fromPatch(Session& session, FragmentOrigin& origin) {
  const ThreadValues threads = threadsOf(session, origin);
  for (std::size_t i = 0; i < threads.marks.size(); ++i) {
    if (static_cast<std::int32_t>(*threads.identity.at(0).at(i)) == origin.primitive)
      origin.threads.push_back({{"primitive", origin.primitive},
                                {"vertex", static_cast<std::int32_t>(*threads.identity.at(1).at(i))}});
  }
}

// Behind tessellation several runs may have one number.
FragmentOrigin fromRun(Session& session, std::size_t pixel) {
  if (!drawsOnce(session.stop()))
    cannotTell("the draw has several instances, or is several draws, whose primitives have the same numbers");
  const ThreadValues values = originsOnPixels(session, Stage::geometry);
  const std::uint32_t* told = shownAt(session, values, pixel);
  FragmentOrigin origin;
  origin.primitive = static_cast<std::int32_t>(told[0]);
  readRun(session, told, origin);
  addPrimitiveCheck(origin.check, values.check);
  session.select(Stage::geometry);
  session.requireCapturable();
  const ThreadValues threads = threadsOf(session, origin);
  int same = 0;
  for (std::size_t i = 0; i < threads.marks.size(); ++i) {
    const ThreadName name = nameOf(threads, i);
    const auto is = [&](const char* part, int number) {
      return std::all_of(name.begin(), name.end(),
                         [&](const auto& one) { return one.first != part || one.second == number; });
    };
    same += is("primitive", origin.primitive) && is("invocation", origin.invocation) ? 1 : 0;
  }
  if (same != 1) cannotTell("several runs of the geometry shader have the same numbers");
  origin.threads = {{{"primitive", origin.primitive}, {"invocation", origin.invocation}}};
  return origin;
}

// The fragment tells the first and the last vertex of its primitive, in two draws: no two triangles of a
// patch have the same edge in the same direction.
FragmentOrigin fromGenerated(Session& session, std::size_t pixel) {
  if (hasStage(session, Stage::geometry))
    cannotTell("a geometry shader follows; --stage geometry shows its run");
  if (!drawsOnce(session.stop()))
    cannotTell("the draw has several instances, or is several draws, whose patches have the same numbers");
  if (session.facts().es) cannotTell("OpenGL ES does not let choose the provoking vertex");
  FragmentOrigin origin;
  GeneratedVertex ends[2];
  for (const Provoking provoking : {Provoking::first, Provoking::last}) {
    const ThreadValues values = originsOnPixels(session, Stage::tess_eval, provoking);
    const std::uint32_t* told = shownAt(session, values, pixel);
    ends[provoking == Provoking::last] = {static_cast<std::int32_t>(told[0]), told[1], told[2]};
    addPrimitiveCheck(origin.check, values.check);
  }
  origin.primitive = ends[0].patch;
  const GeneratedPrimitives generated(session);
  addPrimitiveCheck(origin.check, generated.check());
  const std::vector<GeneratedVertex> vertices = generated.between(ends[0], ends[1]);
  const ThreadValues threads = threadsOf(session, origin);
  for (const GeneratedVertex& vertex : vertices) {
    std::size_t i = 0;
    const auto is = [&](std::size_t part, std::uint32_t word) {
      return *threads.identity.at(part).at(i) == word;
    };
    while (i < threads.marks.size() &&
           !(is(0, static_cast<std::uint32_t>(vertex.patch)) && is(1, vertex.u) && is(2, vertex.v)))
      ++i;
    if (i == threads.marks.size()) cannotTell("the draw does not repeat its generated vertices exactly");
    origin.threads.push_back(nameOf(threads, i));
  }
  return origin;
}

}  // namespace

FragmentOrigin originOf(Session& session, int x, int y, Stage stage) {
  session.shader(stage);  // throws if there is none
  const std::size_t pixel = pixelOf(session, x, y);
  if (stage == Stage::geometry) return fromRun(session, pixel);
  if (stage == Stage::tess_eval) return fromGenerated(session, pixel);
  FragmentOrigin origin = primitiveAt(session, pixel);
  if (stage == Stage::vertex) {
    const DrawPrimitives drawn(session);
    addPrimitiveCheck(origin.check, drawn.check());
    origin.threads = drawn.verticesOf(origin.primitive);
    return origin;
  }
  session.select(stage);
  session.requireCapturable();
  fromPatch(session, origin);
  return origin;
}

}  // namespace shadestep::session
