#include "profiler/profile_parts.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "profiler/statistics.h"

namespace shadestep::profiler {
namespace {

using frontend::StatementId;
using frontend::StatementKind;

// Statements that run, as opposed to those that only hold others.
std::vector<StatementId> countedStatements(const frontend::Shader& shader) {
  std::vector<StatementId> result;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const StatementKind kind = shader.statements[i].kind;
    if (kind != StatementKind::block && kind != StatementKind::case_label)
      result.push_back(static_cast<StatementId>(i));
  }
  return result;
}

using Hits = std::map<StatementId, std::uint64_t>;

// Counts one batch of statements with one draw. False, with nothing done, if the draw buffers do not hold so
// many.
bool countBatch(session::Session& session, const std::vector<StatementId>& batch, const CostMap& map,
                Hits& hits, session::Check& check) {
  const auto result =
      instrumenter::instrumentCount(session.shader(session::Stage::fragment), batch, session.target());
  if (std::holds_alternative<instrumenter::Failure>(result) && batch.size() > 1) return false;
  const session::Captured captured = session.capture(orThrow(result));
  check.merge(captured.execution.check);
  // Each captured field is named after its statement.
  for (const instrumenter::Field& field : captured.layout.fields) {
    std::uint64_t& sum = hits[std::stoi(field.name)];
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        if (map.state[map.index(x, y)] == PixelState::measured)
          sum += instrumenter::decode(captured.layout, field, captured.threads.at(x, y)).words.at(0);
  }
  return true;
}

}  // namespace

const char* methodName(Method method) {
  switch (method) {
    case Method::count:
      return "count";
    case Method::clock:
      return "clock";
    case Method::isolate:
      return "isolate";
  }
  return "";
}

CostMap coveredPixels(const session::Captured& captured, const ProfileOptions& options) {
  CostMap map(captured.threads.width, captured.threads.height);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if ((!options.roi || options.roi->contains(x, y)) &&
          (instrumenter::decodeMark(captured.layout, captured.threads.at(x, y)) & instrumenter::kLaunched) !=
              0)
        map.state[map.index(x, y)] = PixelState::measured;
  if (std::find(map.state.begin(), map.state.end(), PixelState::measured) == map.state.end())
    throw session::Error(session::Outcome::nothing_matches,
                         options.roi
                             ? "no fragment of this draw is visible inside --roi; the draw's target is " +
                                   std::to_string(map.width) + " x " + std::to_string(map.height) + " pixels"
                             : "no fragment of this draw is visible, so there is nothing to profile");
  return map;
}

std::vector<LineCost> countLines(session::Session& session, const CostMap& map, session::Check& check) {
  const frontend::Shader& shader = session.shader(session::Stage::fragment);
  const std::vector<StatementId> statements = countedStatements(shader);
  // A word per statement and one for the mark; carriers that take more per number are found out by asking.
  const instrumenter::Target target = session.target();
  std::size_t fit =
      static_cast<std::size_t>(std::max(1, 4 * (target.max_draw_buffers - target.used_draw_buffers) - 1));
  Hits hits;
  for (std::size_t first = 0; first < statements.size();) {
    const std::size_t end = std::min(first + fit, statements.size());
    const std::vector<StatementId> batch(statements.begin() + static_cast<std::ptrdiff_t>(first),
                                         statements.begin() + static_cast<std::ptrdiff_t>(end));
    if (countBatch(session, batch, map, hits, check))
      first = end;
    else
      fit = batch.size() / 2;
  }
  std::map<int, std::uint64_t> by_line;
  for (const auto& [id, n] : hits) by_line[shader.statements[static_cast<std::size_t>(id)].place.line] += n;
  std::vector<LineCost> lines;
  for (const auto& [line, n] : by_line) lines.push_back({line, n, std::nullopt});
  return lines;
}

void summarize(Profile& profile) {
  const std::vector<double> costs = profile.map.costs();
  profile.covered = costs.size();
  profile.measured = profile.map.costs(true).size();
  profile.total = std::accumulate(costs.begin(), costs.end(), 0.0);
  profile.median = median(costs);
  profile.p95 = quantile(costs, 0.95);
}

void shareByHits(std::vector<LineCost>& lines) {
  std::uint64_t all = 0;
  for (const LineCost& line : lines) all += line.hits;
  for (LineCost& line : lines)
    line.share = all > 0 ? static_cast<double>(line.hits) / static_cast<double>(all) : 0;
}

}  // namespace shadestep::profiler
