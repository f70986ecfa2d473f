#include "profiler/comparison.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "profiler/pictures/files.h"

namespace shadestep::profiler {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& sentence) {
  throw session::Error(session::Outcome::usage, sentence);
}

double numberIn(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0;
}

std::string trimmed(const std::string& line) {
  const auto first = line.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

void readMap(Earlier& earlier, const std::string& path) {
  const ExrImage image = readExr(path);
  const auto cost = image.channels.find("Y");
  const auto measured = image.channels.find("measured");
  if (cost == image.channels.end() || measured == image.channels.end())
    refuse("'" + path + "' has no channels Y and measured; it is no map of 'shadestep profile'");
  earlier.map = CostMap(image.width, image.height);
  earlier.map.cost = cost->second;
  for (std::size_t i = 0; i < earlier.map.state.size(); ++i)
    earlier.map.state[i] = measured->second[i] == 0   ? PixelState::none
                           : measured->second[i] == 1 ? PixelState::measured
                                                      : PixelState::reconstructed;
  const auto uncertainty = image.channels.find("uncertainty");
  earlier.uncertainty = uncertainty == image.channels.end() ? std::vector<double>(earlier.map.cost.size())
                                                            : uncertainty->second;
}

double uncertaintyAt(const std::vector<double>& uncertainty, std::size_t i) {
  return i < uncertainty.size() ? uncertainty[i] : 0;
}

// How far the totals of two runs of the same thing may differ: what the reconstruction does not know, and
// what repeats of it show. Counts have none.
double noiseOf(double total_error, double spread) {
  return std::hypot(total_error, 1.96 * spread);
}

void comparePixels(const Earlier& earlier, const Profile& profile, Comparison& result) {
  result.difference.resize(profile.map.cost.size());
  result.significant.resize(profile.map.cost.size());
  const double of_scale = std::hypot(profile.yardstick_noise, earlier.yardstick_noise);
  for (std::size_t i = 0; i < profile.map.cost.size(); ++i) {
    if (profile.map.state[i] == PixelState::none || earlier.map.state[i] == PixelState::none) continue;
    ++result.compared;
    const double before = earlier.map.cost[i] * result.scale;
    result.before += before;
    result.now += profile.map.cost[i];
    result.difference[i] = profile.map.cost[i] - before;
    const double unsure = std::hypot(uncertaintyAt(profile.uncertainty, i),
                                     uncertaintyAt(earlier.uncertainty, i) * result.scale, before * of_scale);
    if (std::abs(result.difference[i]) <= unsure) continue;
    result.significant[i] = 1;
    (result.difference[i] < 0 ? result.cheaper : result.dearer) += 1;
  }
}

void compareLines(const Earlier& earlier, const Profile& profile, const std::vector<int>& matches,
                  Comparison& result) {
  std::map<int, const Earlier::Line*> before;
  for (const Earlier::Line& line : earlier.lines) before[line.line] = &line;
  for (const LineCost& line : profile.lines) {
    Comparison::Line one;
    one.line = line.line;
    one.hits = line.hits;
    one.cost = line.share.value_or(0) * result.now;
    const auto index = static_cast<std::size_t>(line.line) - 1;
    const auto found = before.find(index < matches.size() ? matches[index] : 0);
    if (found != before.end()) {
      one.line_before = found->first;
      one.hits_before = found->second->hits;
      one.cost_before = found->second->share * result.before;
      before.erase(found);
    }
    result.lines.push_back(one);
  }
  for (const auto& [number, line] : before) {
    Comparison::Line gone;
    gone.line_before = number;
    gone.hits_before = line->hits;
    gone.cost_before = line->share * result.before;
    result.lines.push_back(gone);
  }
}

}  // namespace

Earlier readEarlier(const std::string& path) {
  std::ifstream file(path);
  const Json document = Json::parse(file, nullptr, false);
  if (!file || document.is_discarded() || !document.is_object() || !document.contains("method") ||
      !document.contains("lines"))
    refuse("'" + path + "' is no profile.json of 'shadestep profile'");
  Earlier earlier;
  earlier.file = path;
  earlier.method = document["method"].get<std::string>();
  earlier.unit = document.value("unit", "");
  earlier.yardstick = numberIn(document, "yardstick");
  earlier.yardstick_noise = numberIn(document, "yardstick_noise");
  earlier.spread = numberIn(document, "spread");
  if (document.contains("reconstruction") && document["reconstruction"].is_object())
    earlier.total_error = numberIn(document["reconstruction"], "total_error");
  for (const Json& line : document["lines"])
    earlier.lines.push_back(
        {line.value("line", 0), line.value("hits", std::uint64_t{0}), numberIn(line, "share")});
  for (const Json& loop : document.value("loops", Json::array())) {
    Earlier::Loop one{loop.value("line", 0), loop.value("threads", std::uint64_t{0}), 0,
                      loop.value("active", std::vector<std::uint64_t>{}),
                      loop.value("left", std::vector<std::uint64_t>{})};
    one.iterations =
        static_cast<std::uint64_t>(std::llround(numberIn(loop, "mean") * static_cast<double>(one.threads)));
    earlier.loops.push_back(std::move(one));
  }
  earlier.source = document.value("source", std::vector<std::string>{});
  const std::string map = std::filesystem::path(path).parent_path() / "heat.exr";
  try {
    readMap(earlier, map);
  } catch (const std::runtime_error& error) {
    refuse("the map of '" + path + "' cannot be read: " + error.what());
  }
  return earlier;
}

const char* verdictName(Verdict verdict) {
  return verdict == Verdict::same      ? "no difference beyond the noise"
         : verdict == Verdict::cheaper ? "cheaper"
                                       : "dearer";
}

std::vector<int> matchLines(const std::vector<std::string>& before, const std::vector<std::string>& after) {
  std::vector<std::string> a;
  std::vector<std::string> b;
  for (const std::string& line : before) a.push_back(trimmed(line));
  for (const std::string& line : after) b.push_back(trimmed(line));
  std::vector<int> match(b.size());
  // Equal beginnings and ends are most of it; only what lies between needs the table.
  std::size_t first = 0;
  while (first < a.size() && first < b.size() && a[first] == b[first]) {
    match[first] = static_cast<int>(first) + 1;
    ++first;
  }
  std::size_t end_a = a.size();
  std::size_t end_b = b.size();
  while (end_a > first && end_b > first && a[end_a - 1] == b[end_b - 1])
    match[--end_b] = static_cast<int>(end_a--);
  const std::size_t n = end_a - first;
  const std::size_t m = end_b - first;
  std::vector<std::vector<int>> longest(n + 1, std::vector<int>(m + 1));
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t j = m; j-- > 0;)
      longest[i][j] = a[first + i] == b[first + j] ? longest[i + 1][j + 1] + 1
                                                   : std::max(longest[i + 1][j], longest[i][j + 1]);
  for (std::size_t i = 0, j = 0; i < n && j < m;) {
    if (a[first + i] == b[first + j])
      match[first + j++] = static_cast<int>(first + i++) + 1;
    else if (longest[i + 1][j] >= longest[i][j + 1])
      ++i;
    else
      ++j;
  }
  return match;
}

Comparison compare(const Earlier& earlier, const Profile& profile, const std::vector<std::string>& source) {
  if (earlier.method != methodName(profile.method) || earlier.unit != profile.unit)
    refuse("'" + earlier.file + "' was measured by " + earlier.method + " in " + earlier.unit +
           ", this run by " + methodName(profile.method) + "; give both the same --method");
  if (earlier.map.width != profile.map.width || earlier.map.height != profile.map.height)
    refuse("'" + earlier.file + "' is of " + std::to_string(earlier.map.width) + " x " +
           std::to_string(earlier.map.height) + " pixels, this run of " + std::to_string(profile.map.width) +
           " x " + std::to_string(profile.map.height) + "; only equal targets can be compared");
  Comparison result;
  result.file = earlier.file;
  if (earlier.yardstick > 0 && profile.yardstick > 0) result.scale = profile.yardstick / earlier.yardstick;
  comparePixels(earlier, profile, result);
  if (result.compared == 0) refuse("'" + earlier.file + "' has no pixel in common with this run");
  const double total_error = profile.reconstruction ? profile.reconstruction->total_error : 0;
  const double of_runs =
      std::hypot(noiseOf(total_error, profile.spread), noiseOf(earlier.total_error, earlier.spread));
  result.noise = std::hypot(of_runs, profile.yardstick_noise, earlier.yardstick_noise);
  result.change = result.before > 0 ? (result.now - result.before) / result.before : 0;
  if (std::abs(result.change) > result.noise)
    result.verdict = result.change < 0 ? Verdict::cheaper : Verdict::dearer;

  const std::vector<int> matches = matchLines(earlier.source.empty() ? source : earlier.source, source);
  compareLines(earlier, profile, matches, result);
  for (const LoopCost& loop : profile.loops) {
    const auto index = static_cast<std::size_t>(loop.report.line) - 1;
    const int line_before = index < matches.size() ? matches[index] : 0;
    for (const Earlier::Loop& before : earlier.loops)
      if (before.line == line_before)
        result.loops.push_back({loop.report.line, before.iterations,
                                static_cast<std::uint64_t>(std::llround(
                                    loop.report.mean * static_cast<double>(loop.report.threads)))});
  }
  return result;
}

}  // namespace shadestep::profiler
