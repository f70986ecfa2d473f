#include "session/fragment_origin.h"

#include "session/draw_primitives.h"

namespace shadestep::session {
namespace {

FragmentOrigin primitiveAt(Session& session, int x, int y) {
  const DrawFacts& facts = session.facts();
  if (x < 0 || y < 0 || x >= facts.width || y >= facts.height)
    throw Error(Outcome::nothing_matches, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                              " is outside the target of " + std::to_string(facts.width) +
                                              " x " + std::to_string(facts.height) + " pixels");
  const ThreadValues values = primitivesOnPixels(session);
  const std::optional<std::size_t> pixel = values.find(pixelName(x, y));
  if (!pixel || !values.reachedAt(*pixel) || (values.marks[*pixel] & instrumenter::kDiscarded) != 0)
    throw Error(Outcome::nothing_matches,
                "the draw shows no fragment on pixel " + std::to_string(x) + "," + std::to_string(y));
  FragmentOrigin origin;
  origin.primitive = static_cast<std::int32_t>(*values.values.at(0).at(*pixel));
  addPrimitiveCheck(origin.check, values.check);
  return origin;
}

void fromPatch(Session& session, FragmentOrigin& origin) {
  instrumenter::Probe probe;
  const frontend::Shader& shader = session.shader();
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const ThreadValues threads = valuesAt(session, probe);
  addPrimitiveCheck(origin.check, threads.check);
  for (std::size_t i = 0; i < threads.marks.size(); ++i) {
    if (static_cast<std::int32_t>(*threads.identity.at(0).at(i)) == origin.primitive)
      origin.threads.push_back({{"primitive", origin.primitive},
                                {"vertex", static_cast<std::int32_t>(*threads.identity.at(1).at(i))}});
  }
}

}  // namespace

FragmentOrigin originOf(Session& session, int x, int y, Stage stage) {
  session.shader(stage);  // throws if there is none
  FragmentOrigin origin = primitiveAt(session, x, y);
  if (stage == Stage::tess_eval)
    throw Error(Outcome::cannot_debug,
                "the fragment comes from patch " + std::to_string(origin.primitive) +
                    ", but which of its generated vertices made it is not known; --primitive " +
                    std::to_string(origin.primitive) + " --vertex N shows one");
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
