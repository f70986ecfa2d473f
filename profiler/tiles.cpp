// Method `tiles`: the program's own draw, restricted to one tile of its target after the other.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "profiler/clock_ticks.h"
#include "profiler/profile_parts.h"
#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

constexpr int kSmallestTile = 16;  // pixels per side
constexpr int kLargestTile = 512;
constexpr std::size_t kMostTiles = 1024;
constexpr double kAddsUp = 0.25;  // how far the tiles together may be from the whole draw, relative

Region regionOf(session::Session& session, const ProfileOptions& options) {
  const session::DrawFacts& facts = session.facts();
  const Region all{0, 0, facts.width, facts.height};
  if (!options.roi) return all;
  const int x = std::clamp(options.roi->x, 0, all.width);
  const int y = std::clamp(options.roi->y, 0, all.height);
  const Region region{x, y, std::min(options.roi->x + options.roi->width, all.width) - x,
                      std::min(options.roi->y + options.roi->height, all.height) - y};
  if (region.width > 0 && region.height > 0) return region;
  throw session::Error(session::Outcome::nothing_matches,
                       "--roi lies outside of the draw's target, which is " + std::to_string(all.width) +
                           " x " + std::to_string(all.height) + " pixels");
}

// The parts of the region on a grid that begins at the target's corner.
std::vector<session::Box> tilesOf(const Region& region, int side) {
  std::vector<session::Box> tiles;
  for (int top = region.y / side * side; top < region.y + region.height; top += side)
    for (int left = region.x / side * side; left < region.x + region.width; left += side) {
      const int x = std::max(left, region.x);
      const int y = std::max(top, region.y);
      tiles.push_back({x, y, std::min(left + side, region.x + region.width) - x,
                       std::min(top + side, region.y + region.height) - y});
    }
  return tiles;
}

// Rounds of the empty box, the whole region and all tiles, in this order: raw times in ns.
struct Rounds {
  std::vector<std::vector<double>> cpu, wall;
};

void addRound(session::Session& session, const Region& region, const std::vector<session::Box>& tiles,
              Rounds& rounds) {
  const session::Box empty;
  const session::Box whole{region.x, region.y, region.width, region.height};
  // The first draw after a pause takes longer: it is not looked at.
  const session::BoxTimes all = session.timeBoxes({empty, whole}, 1);
  std::vector<session::Box> boxes = {empty, empty};
  boxes.insert(boxes.end(), tiles.begin(), tiles.end());
  const session::BoxTimes each = session.timeBoxes(boxes, 1);
  const auto row = [&](const auto& whole_times, const auto& times) {
    std::vector<double> result = {static_cast<double>(times[1].count()),
                                  static_cast<double>(whole_times[1].count())};
    for (std::size_t i = 2; i < times.size(); ++i) result.push_back(static_cast<double>(times[i].count()));
    return result;
  };
  rounds.cpu.push_back(row(all.cpu_times, each.cpu_times));
  rounds.wall.push_back(row(all.times, each.times));
}

// Seconds that a draw of nothing is waited for.
double emptySeconds(session::Session& session) {
  const session::BoxTimes times = session.timeBoxes({{}, {}}, 1);
  return std::chrono::duration<double>(times.times[1]).count();
}

// What the tiles take beyond the empty box, and whether the timer deserves trust.
struct TileCosts {
  std::vector<double> cost, uncertainty, even, odd;
  double empty = 0;    // ns
  double adds_up = 0;  // all tiles over the whole draw
  bool trusted() const { return std::abs(adds_up - 1) <= kAddsUp; }
};

TileCosts costsOf(const std::vector<std::vector<double>>& rounds) {
  const Passes passes = combinePasses(rounds);
  TileCosts result;
  result.empty = passes.cost[0];
  double sum = 0;
  for (std::size_t i = 2; i < passes.cost.size(); ++i) {
    result.cost.push_back(std::max(0.0, passes.cost[i] - passes.cost[0]));
    result.uncertainty.push_back(std::hypot(passes.uncertainty[i], passes.uncertainty[0]));
    result.even.push_back(std::max(0.0, passes.halves.even[i] - passes.halves.even[0]));
    result.odd.push_back(std::max(0.0, passes.halves.odd[i] - passes.halves.odd[0]));
    sum += passes.cost[i] - passes.cost[0];
  }
  const double whole = passes.cost[1] - passes.cost[0];
  result.adds_up = whole > 0 ? sum / whole : 0;
  return result;
}

void fillMap(const std::vector<session::Box>& tiles, const TileCosts& costs, Profile& profile) {
  CostMap& map = profile.map;
  profile.uncertainty.assign(map.cost.size(), 0);
  profile.halves = {std::vector<double>(map.cost.size()), std::vector<double>(map.cost.size())};
  std::vector<double> spreads;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const session::Box& tile = tiles[t];
    const double pixels = static_cast<double>(tile.width) * tile.height;
    for (int y = tile.y; y < tile.y + tile.height; ++y)
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        const std::size_t i = map.index(x, y);
        map.state[i] = PixelState::measured;
        map.cost[i] = costs.cost[t] / pixels;
        profile.uncertainty[i] = costs.uncertainty[t] / pixels;
        profile.halves.even[i] = costs.even[t] / pixels;
        profile.halves.odd[i] = costs.odd[t] / pixels;
      }
    if (costs.cost[t] > 0) spreads.push_back(std::abs(costs.even[t] - costs.odd[t]) / costs.cost[t] / 2);
  }
  profile.spread = spreads.empty() ? 0 : median(std::move(spreads));
}

std::string percent(double share) {
  return std::to_string(std::lround(100 * share)) + "%";
}

}  // namespace

Profile profileTiles(session::Session& session, const ProfileOptions& options) {
  if (session.stage() != session::Stage::fragment)
    throw session::Error(session::Outcome::usage,
                         "--method tiles measures what the draw takes in parts of its target, not threads of "
                         "one stage; give --stage fragment");
  const Stopwatch stopwatch;
  const Region region = regionOf(session, options);
  const auto wanted = static_cast<std::size_t>(std::max(options.repeats, 2));
  Profile profile;
  profile.method = Method::tiles;
  profile.unit = "ns";
  profile.map = CostMap(session.facts().width, session.facts().height);

  const double empty_draw = emptySeconds(session);
  // Tiles too small to be timed do not add up to the draw; nor do those of a timer that is no good.
  std::string tried;
  for (int side = kSmallestTile; side <= kLargestTile; side *= 2) {
    const std::vector<session::Box> tiles = tilesOf(region, side);
    // What the number of tiles adds: a draw of each.
    const double added = static_cast<double>(wanted) * empty_draw * static_cast<double>(tiles.size());
    const bool fewer_possible = side < kLargestTile && tiles.size() > 4;
    if (tiles.size() > kMostTiles || (added > options.budget && fewer_possible)) continue;
    Rounds rounds;
    while (rounds.wall.size() < wanted) {
      addRound(session, region, tiles, rounds);
      profile.interrupted = options.stop && options.stop();
      if (options.progress)
        options.progress(static_cast<double>(rounds.wall.size()) / static_cast<double>(wanted + 1));
      if (profile.interrupted && rounds.wall.size() >= 2) break;
    }
    for (const bool cpu : {true, false}) {
      const TileCosts costs = costsOf(cpu ? rounds.cpu : rounds.wall);
      profile.timer = cpu ? "CPU time" : "wall clock";
      if (!costs.trusted()) {
        tried += (tried.empty() ? "" : ", ") + percent(costs.adds_up) + " by " + profile.timer + " at " +
                 std::to_string(side);
        continue;
      }
      fillMap(tiles, costs, profile);
      profile.grain = {side, side};
      profile.passes = static_cast<int>(rounds.wall.size());
      profile.check.reason = "nothing is instrumented, the draws are the program's own";
      profile.notes.push_back("The program's own draw, restricted to tiles of " + std::to_string(side) +
                              " x " + std::to_string(side) + " pixels by the scissor test: " + profile.timer +
                              ", lower quartile of " + std::to_string(profile.passes) +
                              " draws of each. The pixels of a tile share its cost evenly.");
      profile.notes.push_back("Together the tiles take " + percent(costs.adds_up) +
                              " of what the draw takes.");
      profile.notes.push_back(
          "What a draw takes whatever falls into the tile (vertices, set-up) is not in the "
          "map: " +
          std::to_string(std::lround(costs.empty / 1000)) + " us.");
      summarize(profile);
      profile.seconds = stopwatch.seconds();
      if (options.progress) options.progress(1);
      return profile;
    }
    if (profile.interrupted) break;
  }
  throw session::Error(session::Outcome::cannot_debug,
                       "the times of the draw's tiles do not add up to that of the draw (" + tried +
                           " pixels): it is too short to be timed, or too much else runs on this machine");
}

}  // namespace shadestep::profiler
