// The choice among the methods.
#include "profiler/profile.h"

namespace shadestep::profiler {
namespace {

Profile byMethod(const std::string& method, session::Session& session, const ProfileOptions& options) {
  if (method == "count") return profileCount(session, options);
  if (method == "clock") return profileClock(session, options);
  if (method == "isolate") return profileIsolate(session, options);
  if (method == "tiles") return profileTiles(session, options);
  return profileAuto(session, options);
}

}  // namespace

namespace {

// Why the stage has no text to instrument; empty if it has.
std::string withoutSource(session::Session& session) {
  try {
    session.shader();
    return {};
  } catch (const session::Error& error) {
    if (error.outcome() != session::Outcome::cannot_debug) throw;
    return error.what();
  }
}

}  // namespace

Profile profileAuto(session::Session& session, const ProfileOptions& options) {
  std::vector<std::string> reasons;
  if (const std::string reason = withoutSource(session);
      !reason.empty() && session.stage() == session::Stage::fragment) {
    Profile profile = profileTiles(session, options);
    profile.notes.push_back("Not by pixel or line: " + reason + ".");
    return profile;
  }
  for (Profile (*const method)(session::Session&, const ProfileOptions&) : {profileClock, profileIsolate}) {
    try {
      Profile profile = method(session, options);
      profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
      return profile;
    } catch (const session::Error& error) {
      if (error.outcome() != session::Outcome::cannot_debug) throw;
      reasons.push_back(std::string(method == profileClock ? "Not clock: " : "Not isolate: ") + error.what() +
                        ".");
    }
  }
  Profile profile = profileCount(session, options);
  profile.notes.insert(profile.notes.end(), reasons.begin(), reasons.end());
  return profile;
}

namespace {

// The clock, and each thread by itself; the pictures and lines are the clock's.
Profile withNeighbours(session::Session& session, const ProfileOptions& options) {
  Profile clock = profileClock(session, options);
  if (clock.interrupted) return clock;
  ProfileOptions alone = options;
  alone.lines = false;
  const Profile isolate = profileIsolate(session, alone);
  clock.check.merge(isolate.check);
  clock.interrupted = isolate.interrupted;
  clock.seconds += isolate.seconds;
  clock.neighbours = neighbourCost({clock.map, clock.uncertainty, clock.yardstick},
                                   {isolate.map, isolate.uncertainty, isolate.yardstick}, clock.diverging);
  CostMap counted = clock.map;
  counted.cost = clock.statements;
  const Halves exact;
  NeighbourCost& paid = *clock.neighbours;
  const auto agree = [&](const Ranked& a, const Ranked& b, RankAgreement& same, RankAgreement& all) {
    same = agreementWhereSame(a, b, clock.diverging, clock.grain);
    all = agreementByDearest(a, b, clock.grain);
  };
  const Ranked by_clock{clock.map, clock.halves};
  const Ranked alone_each{isolate.map, isolate.halves};
  agree(by_clock, alone_each, paid.same.clock_isolate, paid.all.clock_isolate);
  if (!counted.cost.empty()) {
    agree(by_clock, {counted, exact}, paid.same.clock_count, paid.all.clock_count);
    agree(alone_each, {counted, exact}, paid.same.isolate_count, paid.all.isolate_count);
  }
  clock.notes.push_back(
      "What a pixel pays for its neighbours: its ticks less those that its thread alone would take, by "
      "isolate of " +
      std::to_string(isolate.measured) + " of " + std::to_string(isolate.covered) + " pixels. " +
      (clock.neighbours->without_divergence > 0 ? "Nanoseconds count as ticks as they do in the " +
                                                      std::to_string(clock.neighbours->without_divergence) +
                                                      " measured pixels of groups that do not diverge."
                                                : "No group is without divergence: nanoseconds count as "
                                                  "ticks as they do for known work, whose caches and "
                                                  "instructions may be others than the shader's."));
  return clock;
}

}  // namespace

// What textures are read is asked first: it takes one draw, and a long measurement must not be lost for its
// refusal.
Profile profileBy(const std::string& method, session::Session& session, const ProfileOptions& options) {
  if (options.neighbours &&
      (session.stage() != session::Stage::fragment || (method != "clock" && method != "auto")))
    throw session::Error(
        session::Outcome::usage,
        "only the clock measures threads among their neighbours, and fragments only; give --neighbours with "
        "--method clock and --stage fragment");
  const bool fragments = session.stage() == session::Stage::fragment;
  if (options.roi && !fragments)
    throw session::Error(session::Outcome::usage, std::string("--roi chooses pixels; threads of ") +
                                                      session::stageName(session.stage()) +
                                                      " shaders have none");
  std::optional<TextureAccesses> textures;
  if (options.textures) textures = mapTextures(session, options.roi);
  Profile profile =
      options.neighbours ? withNeighbours(session, options) : byMethod(method, session, options);
  if (!fragments)
    profile.notes.push_back(
        "One cell of the map is one thread, row by row from the lower left in the order of threads.csv.");
  if (textures) profile.check.merge(textures->check);
  profile.textures = std::move(textures);
  return profile;
}

}  // namespace shadestep::profiler
