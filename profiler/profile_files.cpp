#include "profiler/profile_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "profiler/pictures/difference_map.h"
#include "profiler/pictures/files.h"
#include "profiler/pictures/heat_map.h"
#include "profiler/pictures/height_field.h"
#include "profiler/pictures/ticks.h"
#include "profiler/report/report.h"
#include "profiler/texture_files.h"

namespace shadestep::profiler {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value < 0 ? "-Infinity" : "Infinity";
  return value;
}

Json linesOf(const Profile& profile) {
  Json lines = Json::array();
  for (const LineCost& line : profile.lines) {
    Json entry{{"line", line.line}, {"hits", line.hits}};
    if (line.share) entry["share"] = number(*line.share);
    entry["together"] = line.together;
    lines.push_back(std::move(entry));
  }
  return lines;
}

Json branchesOf(const Profile& profile) {
  Json branches = Json::array();
  for (const BranchCost& branch : profile.branches)
    branches.push_back({{"line", branch.line},
                        {"column", branch.column},
                        {"kind", branch.kind},
                        {"evaluated", branch.evaluated},
                        {"taken", branch.taken},
                        {"active_share", number(branch.active_share)},
                        {"taken_share", number(branch.taken_share)}});
  return branches;
}

Json loopsOf(const Profile& profile) {
  Json loops = Json::array();
  for (const LoopCost& loop : profile.loops) {
    const session::LoopReport& report = loop.report;
    Json critical = Json::array();
    for (const auto& [x, y] : loop.critical) critical.push_back({x, y});
    loops.push_back(
        {{"line", report.line},
         {"threads", report.threads},
         {"active", report.active},
         {"left", report.left},
         {"max", report.max},
         {"mean", number(report.mean)},
         {"active_share", number(loop.active_share)},
         {"critical",
          {{"from", loop.critical_from}, {"threads", loop.critical_threads}, {"pixels", critical}}}});
  }
  return loops;
}

Json agreementOf(const RankAgreement& agreement) {
  return {{"rho", number(agreement.rho)}, {"most", number(agreement.most)}, {"groups", agreement.pixels}};
}

Json agreementOf(const NeighbourCost::Agreement& agreement) {
  return {{"clock_isolate", agreementOf(agreement.clock_isolate)},
          {"clock_count", agreementOf(agreement.clock_count)},
          {"isolate_count", agreementOf(agreement.isolate_count)}};
}

Json checkOf(const session::Check& check) {
  return {{"outputs", !check.compared_at_all ? "not compared"
                      : check.identical()    ? "identical"
                                             : "differ"},
          {"compared", check.compared},
          {"differing", check.differing},
          {"undefined", check.undefined},
          {"reason", check.reason.empty() ? Json(nullptr) : Json(check.reason)}};
}

std::string percent(double share) {
  return readable(100 * share, 2) + " %";
}

HeatMapText textFor(const Profile& profile, const std::string& what) {
  HeatMapText text;
  const bool fragments = profile.stage == session::Stage::fragment;
  text.title = std::string(fragments ? "Cost per pixel: " : "Cost per thread: ") + methodName(profile.method);
  text.subtitle = what;
  text.unit = profile.unit;
  std::string measured =
      readable(static_cast<double>(profile.covered), 12) + (fragments ? " pixels" : " threads");
  if (profile.reconstruction)
    measured += ", " + readable(static_cast<double>(profile.measured), 12) + " of them measured (" +
                percent(static_cast<double>(profile.measured) / static_cast<double>(profile.covered)) +
                "); the rest reconstructed, error " + percent(profile.reconstruction->error) +
                " (root mean square), with 95 % confidence below " +
                percent(profile.reconstruction->error_below) + ", by " +
                std::to_string(profile.reconstruction->held_out) + " held-out pixels";
  if (profile.passes > 1)
    measured += "; " + std::to_string(profile.passes) + " measurements each, reproducible to " +
                percent(profile.spread);
  text.notes.push_back(measured + ".");
  text.notes.insert(text.notes.end(), profile.notes.begin(), profile.notes.end());
  return text;
}

double rounded(double value) {
  return static_cast<double>(static_cast<float>(value));
}

void writeHeatExr(const Profile& profile, const std::string& path) {
  std::vector<double> cost;
  std::vector<double> measured;
  std::vector<double> uncertainty(profile.map.cost.size());
  for (std::size_t i = 0; i < profile.map.cost.size(); ++i) {
    cost.push_back(rounded(profile.map.cost[i]));
    measured.push_back(profile.map.state[i] == PixelState::measured        ? 1
                       : profile.map.state[i] == PixelState::reconstructed ? 0.5
                                                                           : 0);
    if (i < profile.uncertainty.size()) uncertainty[i] = rounded(profile.uncertainty[i]);
  }
  std::vector<ExrChannel> channels = {{"Y", cost}, {"measured", measured}, {"uncertainty", uncertainty}};
  const std::vector<double> diverging(profile.diverging.begin(), profile.diverging.end());
  if (!diverging.empty()) channels.push_back({"diverging", diverging});
  writeExr(path, profile.map.width, profile.map.height, channels);
}

Json comparisonOf(const Comparison& comparison) {
  Json lines = Json::array();
  for (const Comparison::Line& line : comparison.lines)
    lines.push_back({{"line", line.line},
                     {"line_before", line.line_before},
                     {"hits_before", line.hits_before},
                     {"hits", line.hits},
                     {"cost_before", number(line.cost_before)},
                     {"cost", number(line.cost)}});
  Json loops = Json::array();
  for (const Comparison::Loop& loop : comparison.loops)
    loops.push_back({{"line", loop.line},
                     {"iterations_before", loop.iterations_before},
                     {"iterations", loop.iterations}});
  return {
      {"file", comparison.file},
      {"scale", number(comparison.scale)},
      {"before", number(comparison.before)},
      {"now", number(comparison.now)},
      {"change", number(comparison.change)},
      {"noise", number(comparison.noise)},
      {"verdict", verdictName(comparison.verdict)},
      {"pixels",
       {{"compared", comparison.compared}, {"cheaper", comparison.cheaper}, {"dearer", comparison.dearer}}},
      {"lines", std::move(lines)},
      {"loops", std::move(loops)}};
}

// A path as a reader elsewhere understands it: what is below the working directory relative to it, else the
// file in its folder.
std::string shownPath(const std::string& given) {
  const std::filesystem::path path(given);
  if (!path.is_absolute()) return given;
  std::error_code failed;
  const std::filesystem::path here = std::filesystem::current_path(failed);
  const std::filesystem::path below = path.lexically_relative(here);
  if (!failed && !below.empty() && *below.begin() != "..") return below.string();
  return (path.parent_path().filename() / path.filename()).string();
}

HeatMapText differenceText(const Profile& profile, const Comparison& comparison, const std::string& what) {
  HeatMapText text;
  text.title = std::string("Difference of cost per pixel: ") + methodName(profile.method);
  text.subtitle = what;
  text.unit = profile.unit;
  text.notes.push_back(
      "Against " + shownPath(comparison.file) + ": " + percent(comparison.change) + " in all, noise " +
      percent(comparison.noise) + ": " + verdictName(comparison.verdict) + ". Of " +
      readable(static_cast<double>(comparison.compared), 12) + " pixels, " +
      readable(static_cast<double>(comparison.cheaper), 12) + " are cheaper (blue) and " +
      readable(static_cast<double>(comparison.dearer), 12) + " dearer (red) beyond the noise.");
  return text;
}

std::string threadsCsv(const Profile& profile) {
  const bool fragments = profile.stage == session::Stage::fragment;
  std::string text = fragments ? "x,y," : "";
  for (const std::string& name : profile.threads.names) text += name + ",";
  text += profile.unit + ",uncertainty,measured\n";
  const std::size_t threads = fragments ? profile.map.cost.size() : profile.threads.numbers.size();
  for (std::size_t i = 0; i < threads; ++i) {
    if (profile.map.state[i] == PixelState::none) continue;
    if (fragments) {
      const auto width = static_cast<std::size_t>(profile.map.width);
      text += std::to_string(i % width) + "," + std::to_string(i / width) + ",";
    }
    for (std::size_t name = 0; name < profile.threads.names.size(); ++name)
      text += profile.threads.text(i, name) + ",";
    text += exactText(profile.map.cost[i]) + ",";
    text += exactText(i < profile.uncertainty.size() ? profile.uncertainty[i] : 0);
    text += profile.map.state[i] == PixelState::measured ? ",1\n" : ",0\n";
  }
  return text;
}

// The loop that iterates most; null without loops.
const LoopCost* busiestLoop(const Profile& profile) {
  const auto total = [](const LoopCost& loop) {
    return loop.report.mean * static_cast<double>(loop.report.threads);
  };
  const auto most =
      std::max_element(profile.loops.begin(), profile.loops.end(),
                       [&](const LoopCost& a, const LoopCost& b) { return total(a) < total(b); });
  return most == profile.loops.end() ? nullptr : &*most;
}

void writePerIteration(const Profile& profile, const ProfileFiles& files, const std::string& what) {
  const LoopCost* const loop = busiestLoop(profile);
  if (loop == nullptr) return;
  const auto [map, start] = costPerIteration(profile.map, loop->report.iterations);
  HeatMapText text;
  text.title = std::string("Cost per iteration: ") + methodName(profile.method);
  text.subtitle = what;
  text.unit = profile.unit;
  text.nothing = "no iteration, or no thread";
  const ScaledUnit unit = scaledUnit(profile.unit, start);
  text.notes = {"Each pixel's cost, less the " + readable(start * unit.factor, 3) + " " + unit.name +
                " that a thread costs before it iterates, over its iterations of the loop at line " +
                std::to_string(loop->report.line) +
                ": what is left where iterations alone do not explain the cost."};
  if (profile.reconstruction) {
    text.unmeasured = "iterates, not measured";
    text.notes.push_back("Only measured pixels: " + std::to_string(map.costs(true).size()) + ".");
  }
  writeFile(files.per_iteration_png, drawHeatMap(map, text));
  std::vector<double> cost;
  for (const double c : map.cost) cost.push_back(rounded(c));
  std::vector<double> measured;
  for (const PixelState state : map.state) measured.push_back(state == PixelState::measured ? 1 : 0);
  writeExr(files.per_iteration_exr, map.width, map.height, {{"Y", cost}, {"measured", measured}});
}

HeatMapText neighboursText(const Profile& profile, const std::string& what) {
  HeatMapText text;
  text.title = "What pixels pay for their neighbours: clock less isolate";
  text.subtitle = what;
  text.unit = profile.unit;
  text.notes.push_back(percent(profile.neighbours->share) +
                       " of all ticks. Red: in place it takes longer, waiting for others of its group of " +
                       std::to_string(profile.grain.width) + " x " + std::to_string(profile.grain.height) +
                       " pixels or for memory; blue: alone it would take longer.");
  text.notes.push_back(profile.notes.back());
  return text;
}

void writeNeighbours(const Profile& profile, const ProfileFiles& files, const std::string& what) {
  const NeighbourCost& paid = *profile.neighbours;
  std::vector<std::uint8_t> significant;
  std::vector<double> cost;
  std::vector<double> uncertainty;
  for (std::size_t i = 0; i < paid.cost.size(); ++i) {
    significant.push_back(std::abs(paid.cost[i]) > paid.uncertainty[i] ? 1 : 0);
    cost.push_back(rounded(paid.cost[i]));
    uncertainty.push_back(rounded(paid.uncertainty[i]));
  }
  writeFile(files.neighbours_png,
            drawDifferenceMap(profile.map, paid.cost, significant, neighboursText(profile, what)));
  writeExr(files.neighbours_exr, profile.map.width, profile.map.height,
           {{"Y", cost}, {"uncertainty", uncertainty}});
}

std::vector<ReportLayer> layersOf(const Profile& profile, const Comparison* comparison) {
  std::vector<ReportLayer> layers;
  for (const LoopCost& loop : profile.loops) {
    ReportLayer layer{
        "iterations of the loop at line " + std::to_string(loop.report.line), "iterations", false, {}, {}};
    layer.values.assign(loop.report.iterations.begin(), loop.report.iterations.end());
    layers.push_back(std::move(layer));
  }
  if (profile.neighbours)
    layers.push_back({"paid for neighbours", profile.unit, true, profile.neighbours->cost,
                      profile.neighbours->uncertainty});
  if (comparison != nullptr)
    layers.push_back({"difference from the earlier run", profile.unit, true, comparison->difference, {}});
  return layers;
}

}  // namespace

Json toJson(const Profile& profile, const ProfileFiles& files, const Subject& subject,
            const Comparison* comparison) {
  Json document;
  document["method"] = methodName(profile.method);
  document["stage"] = session::stageName(profile.stage);
  document["unit"] = profile.unit;
  document["width"] = profile.map.width;
  document["height"] = profile.map.height;
  document["covered"] = profile.covered;
  document["measured"] = profile.measured;
  document["passes"] = profile.passes;
  document["seconds"] = number(profile.seconds);
  document["total"] = number(profile.total);
  document["median"] = number(profile.median);
  document["p95"] = number(profile.p95);
  document["spread"] = number(profile.spread);
  document["reconstruction"] = nullptr;
  if (profile.reconstruction)
    document["reconstruction"] = {{"held_out", profile.reconstruction->held_out},
                                  {"error", number(profile.reconstruction->error)},
                                  {"error_below", number(profile.reconstruction->error_below)},
                                  {"median_error", number(profile.reconstruction->median_error)},
                                  {"total_error", number(profile.reconstruction->total_error)}};
  if (profile.same_output)
    document["same_output"] = {{"tried", profile.same_output->tried}, {"same", profile.same_output->same}};
  document["yardstick"] = number(profile.yardstick);
  document["yardstick_noise"] = number(profile.yardstick_noise);
  document["grain"] = {profile.grain.width, profile.grain.height};
  document["timer"] = profile.timer.empty() ? Json(nullptr) : Json(profile.timer);
  document["interrupted"] = profile.interrupted;
  document["lines"] = linesOf(profile);
  document["fit"] = nullptr;
  if (profile.fit)
    document["fit"] = {{"r2", number(profile.fit->r2)},
                       {"start_share", number(profile.fit->start_share)},
                       {"rows", profile.fit->rows}};
  document["branches"] = branchesOf(profile);
  document["functions"] = Json::array();
  for (const FunctionCalls& function : profile.functions)
    document["functions"].push_back(
        {{"name", function.name}, {"line", function.line}, {"calls", function.calls}});
  document["fetches"] = Json::array();
  for (const SamplerFetches& sampler : profile.samplers)
    document["fetches"].push_back({{"sampler", sampler.sampler},
                                   {"function", sampler.function},
                                   {"line", sampler.line},
                                   {"fetches", sampler.fetches}});
  document["loops"] = loopsOf(profile);
  if (profile.neighbours)
    document["neighbours"] = {{"share", number(profile.neighbours->share)},
                              {"scale", number(profile.neighbours->scale)},
                              {"without_divergence", profile.neighbours->without_divergence},
                              {"agreement", agreementOf(profile.neighbours->same)},
                              {"agreement_all", agreementOf(profile.neighbours->all)}};
  if (profile.textures) document["textures"] = toJson(*profile.textures, files.texture);
  document["check"] = checkOf(profile.check);
  document["notes"] = profile.notes;
  if (comparison != nullptr) document["comparison"] = comparisonOf(*comparison);
  document["source"] = subject.source;
  document["files"] = {{"heat.png", files.heat_png},
                       {"heat.exr", files.heat_exr},
                       {"height.png", files.height_png},
                       {"profile.json", files.profile_json},
                       {"report.html", files.report_html}};
  if (!files.threads_csv.empty()) document["files"]["threads.csv"] = files.threads_csv;
  if (!files.per_iteration_png.empty()) {
    document["files"]["per-iteration.png"] = files.per_iteration_png;
    document["files"]["per-iteration.exr"] = files.per_iteration_exr;
  }
  if (profile.neighbours) {
    document["files"]["neighbours.png"] = files.neighbours_png;
    document["files"]["neighbours.exr"] = files.neighbours_exr;
  }
  if (comparison != nullptr) {
    document["files"]["difference.png"] = files.difference_png;
    document["files"]["difference.exr"] = files.difference_exr;
  }
  return document;
}

void writeProfile(const Profile& profile, const ProfileFiles& files, const Subject& subject,
                  const Comparison* comparison) {
  const HeatMapText text = textFor(profile, subject.what);
  writeFile(files.heat_png, drawHeatMap(profile.map, text));
  writeHeatExr(profile, files.heat_exr);
  writeFile(files.height_png, drawHeightField(profile.map, text));
  if (comparison != nullptr) {
    writeFile(files.difference_png,
              drawDifferenceMap(profile.map, comparison->difference, comparison->significant,
                                differenceText(profile, *comparison, subject.what)));
    std::vector<double> difference;
    for (const double d : comparison->difference) difference.push_back(rounded(d));
    writeExr(files.difference_exr, profile.map.width, profile.map.height, {{"Y", difference}});
  }
  if (!files.threads_csv.empty()) writeFile(files.threads_csv, threadsCsv(profile));
  if (!files.per_iteration_png.empty()) writePerIteration(profile, files, subject.what);
  if (profile.neighbours) writeNeighbours(profile, files, subject.what);
  std::vector<ReportPicture> pictures;
  if (profile.textures) pictures = writeTextures(*profile.textures, files.texture, subject.what);
  const Json document = toJson(profile, files, subject, comparison);
  writeFile(files.profile_json, document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  writeFile(files.report_html, makeReport(profile, document, subject.source, subject.what,
                                          layersOf(profile, comparison), pictures));
}

std::string subjectOf(const std::string& program, session::Session& session) {
  return std::filesystem::path(program).filename().string() + ", frame " +
         std::to_string(session.stop().frame) + ", draw " + std::to_string(session.stop().draw) + ", " +
         session::stageName(session.stage()) + " shader, on " + session.facts().renderer;
}

}  // namespace shadestep::profiler
