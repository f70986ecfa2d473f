#include "profiler/work.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "profiler/cost_fit.h"

namespace shadestep::profiler {
namespace {

using frontend::StatementKind;
using instrumenter::Counted;
using Plane = std::vector<std::uint32_t>;

constexpr std::size_t kMostRows = 20000;  // of the fit

const frontend::Statement& statementOf(const frontend::Shader& shader, const Counts::Site& site) {
  return shader.statements[static_cast<std::size_t>(site.what.id)];
}

double operations(const frontend::Shader& shader, frontend::TokenRange range) {
  static const std::set<std::string_view> dear = {"sqrt", "inversesqrt", "pow",  "exp",       "exp2",
                                                  "log",  "log2",        "sin",  "cos",       "tan",
                                                  "asin", "acos",        "atan", "normalize", "inverse"};
  double sum = 0;
  for (frontend::TokenIndex i = range.first; i <= range.last; ++i) {
    const frontend::Token& token = shader.tokens[static_cast<std::size_t>(i)];
    const bool called = static_cast<std::size_t>(i) + 1 < shader.tokens.size() &&
                        shader.tokens[static_cast<std::size_t>(i) + 1].text == "(";
    if (token.kind == frontend::TokenKind::identifier && called)
      sum += token.text.starts_with("tex") || token.text.starts_with("shadow") ? 20
             : dear.contains(token.text)                                       ? 8
                                                                               : 3;
    else if (token.kind == frontend::TokenKind::punctuator &&
             std::string_view("+-*/%<>=!&|^").find(token.text.front()) != std::string_view::npos)
      sum += 1;
  }
  return sum;
}

// What is counted for a row: the most of any of its threads where a group runs in step.
double counted(const Plane& plane, const std::vector<std::size_t>& row) {
  std::uint32_t most = 0;
  for (const std::size_t pixel : row) most = std::max(most, plane[pixel]);
  return most;
}

struct Group {
  double operations = 0;  // of all its statements
  double cost = 0;        // found by the fit, for all of them
};

// Shares of lines by a fit. The statements of one plane are one column.
void fitLines(const Counts& counts, const std::vector<double>& weight, Profile& profile,
              std::map<int, double>& cost_of_line, const frontend::Shader& shader) {
  std::map<std::size_t, Group> groups;
  for (const Counts::Site& site : counts.sites)
    if (site.what.kind == Counted::Kind::runs)
      groups[site.plane].operations += weight[static_cast<std::size_t>(site.what.id)];

  // Each group gives one row of the fit: its threads take as long as what any of them does.
  const std::vector<std::vector<std::size_t>> rows = groupsOf(profile.map, profile.grain);
  std::vector<const std::vector<std::size_t>*> fitted;
  for (const auto& row : rows)
    if (profile.map.state[row.front()] == PixelState::measured) fitted.push_back(&row);
  if (fitted.empty()) return;
  const std::size_t step = (fitted.size() + kMostRows - 1) / kMostRows;
  std::vector<double> cost;
  std::vector<std::vector<double>> columns(groups.size());
  for (std::size_t r = 0; r < fitted.size(); r += step) {
    double sum = 0;
    for (const std::size_t pixel : *fitted[r]) sum += profile.map.cost[pixel];
    cost.push_back(sum / static_cast<double>(fitted[r]->size()));
    std::size_t column = 0;
    for (const auto& [plane, group] : groups)
      columns[column++].push_back(counted(counts.planes[plane], *fitted[r]));
  }
  std::vector<double> prior;
  for (const auto& [plane, group] : groups) prior.push_back(group.operations);
  const CostFit fit = fitCosts(columns, cost, prior);

  double all = fit.start * static_cast<double>(rows.size());
  std::size_t column = 0;
  for (auto& [plane, group] : groups) {
    double times = 0;
    for (const auto& row : rows) times += counted(counts.planes[plane], row);
    group.cost = fit.costs[column++] * times;
    all += group.cost;
  }
  profile.fit =
      LineFit{fit.r2, all > 0 ? fit.start * static_cast<double>(rows.size()) / all : 0, cost.size()};
  for (const Counts::Site& site : counts.sites) {
    if (site.what.kind != Counted::Kind::runs || !(all > 0)) continue;
    const Group& group = groups[site.plane];
    cost_of_line[statementOf(shader, site).place.line] +=
        group.cost / all * weight[static_cast<std::size_t>(site.what.id)] / group.operations;
  }
}

const char* kindName(StatementKind kind) {
  switch (kind) {
    case StatementKind::for_:
      return "for";
    case StatementKind::while_:
      return "while";
    case StatementKind::do_while:
      return "do";
    default:
      return "if";
  }
}

void describeBranches(const frontend::Shader& shader, const Counts& counts, Profile& profile) {
  for (const Counts::Site& site : counts.sites) {
    if (site.what.kind != Counted::Kind::taken) continue;
    const frontend::Statement& statement = statementOf(shader, site);
    const Counts::Site* runs = counts.find({Counted::Kind::runs, site.what.id});
    BranchCost branch;
    branch.line = statement.place.line;
    branch.column = statement.place.column;
    branch.kind = kindName(statement.kind);
    branch.evaluated = counts.total(*runs);
    branch.taken = counts.total(site);
    branch.active_share = activeShare(counts.planes[runs->plane], profile.map, profile.grain);
    branch.taken_share = activeShare(counts.planes[site.plane], profile.map, profile.grain);
    profile.branches.push_back(std::move(branch));
  }
}

void findCriticalPath(LoopCost& loop, int width) {
  const session::LoopReport& report = loop.report;
  const std::uint64_t few = std::max<std::uint64_t>(report.threads / 100, 1);
  std::size_t from = 0;
  while (from < report.active.size() && report.active[from] > few) ++from;
  if (from == report.active.size()) return;  // all leave together
  loop.critical_from = static_cast<std::uint32_t>(from);
  loop.critical_threads = report.active[from];
  std::vector<std::size_t> pixels(report.longest.size());
  std::iota(pixels.begin(), pixels.end(), std::size_t{0});
  std::erase_if(pixels, [&](std::size_t pixel) { return report.longest[pixel] <= from; });
  std::stable_sort(pixels.begin(), pixels.end(),
                   [&](std::size_t a, std::size_t b) { return report.longest[a] > report.longest[b]; });
  if (pixels.size() > 16) pixels.resize(16);
  for (const std::size_t pixel : pixels)
    loop.critical.emplace_back(static_cast<int>(pixel % static_cast<std::size_t>(width)),
                               static_cast<int>(pixel / static_cast<std::size_t>(width)));
}

}  // namespace

std::vector<double> operationCounts(const frontend::Shader& shader) {
  std::vector<double> counts;
  for (const frontend::Statement& statement : shader.statements) {
    // What holds other statements is its condition and increment only.
    const bool whole = statement.children.empty() && statement.init == frontend::kNone &&
                       statement.kind != StatementKind::if_ && statement.kind != StatementKind::switch_;
    counts.push_back(
        1 + (whole ? operations(shader, statement.tokens)
                   : operations(shader, statement.expression) + operations(shader, statement.increment)));
  }
  return counts;
}

void describeWork(const frontend::Shader& shader, const Counts& counts, Profile& profile) {
  std::map<int, LineCost> lines;
  for (const Counts::Site& site : counts.sites) {
    if (site.what.kind != Counted::Kind::runs) continue;
    LineCost& line = lines[statementOf(shader, site).place.line];
    if (line.line == 0) line.together = site.plane;
    line.line = statementOf(shader, site).place.line;
    line.hits += counts.total(site);
  }
  if (profile.method == Method::count) {
    std::uint64_t all = 0;
    for (const auto& [number, line] : lines) all += line.hits;
    for (auto& [number, line] : lines)
      line.share = all > 0 ? static_cast<double>(line.hits) / static_cast<double>(all) : 0;
  } else {
    std::map<int, double> costs;
    fitLines(counts, operationCounts(shader), profile, costs, shader);
    for (const auto& [number, cost] : costs) lines[number].share = cost;
  }
  for (const auto& [number, line] : lines) profile.lines.push_back(line);

  profile.statements.assign(profile.map.cost.size(), 0);
  for (const Counts::Site& site : counts.sites)
    if (site.what.kind == Counted::Kind::runs)
      for (std::size_t i = 0; i < profile.statements.size(); ++i)
        profile.statements[i] += counts.planes[site.plane][i];
  profile.diverging = divergingPixels(counts, profile.map, profile.grain);
  describeBranches(shader, counts, profile);
  const std::vector<instrumenter::TextureFetch> fetches = instrumenter::textureFetches(shader);
  for (const Counts::Site& site : counts.sites) {
    const auto id = static_cast<std::size_t>(site.what.id);
    if (site.what.kind == Counted::Kind::entered) {
      const frontend::Function& function = shader.functions[id];
      profile.functions.push_back({function.name,
                                   shader.tokens[static_cast<std::size_t>(function.name_token)].place.line,
                                   counts.total(site)});
    } else if (site.what.kind == Counted::Kind::fetched) {
      const instrumenter::TextureFetch& fetch = fetches[id];
      profile.samplers.push_back({fetch.sampler, fetch.function,
                                  shader.tokens[static_cast<std::size_t>(fetch.name)].place.line,
                                  counts.total(site)});
    }
  }
}

void describeLoops(session::Session& session, Profile& profile) {
  const frontend::Shader& shader = session.shader();
  const bool any = std::any_of(shader.statements.begin(), shader.statements.end(), [](const auto& statement) {
    return statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
           statement.kind == StatementKind::do_while;
  });
  if (!any) return;
  std::vector<std::uint8_t> profiled;
  for (const PixelState state : profile.map.state) profiled.push_back(state != PixelState::none ? 1 : 0);
  session::LoopsReport report = session::profileLoops(session, 0, profiled);
  profile.check.merge(report.check);
  for (session::LoopReport& one : report.loops) {
    LoopCost loop;
    loop.report = std::move(one);
    // A list of threads may end before the map's last row does.
    loop.report.iterations.resize(profile.map.cost.size());
    loop.report.longest.resize(profile.map.cost.size());
    loop.active_share = activeShare(loop.report.iterations, profile.map, profile.grain);
    findCriticalPath(loop, profile.map.width);
    if (loop.report.cut > 0)
      profile.notes.push_back(
          "The driver ended the loop at line " + std::to_string(loop.report.line) + " in " +
          std::to_string(loop.report.cut) +
          " threads although its condition still held: counts and costs are those of what ran, "
          "another driver would go on.");
    profile.loops.push_back(std::move(loop));
  }
}

}  // namespace shadestep::profiler
