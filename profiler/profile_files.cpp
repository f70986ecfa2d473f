#include "profiler/profile_files.h"

#include <cmath>

#include "profiler/pictures/files.h"
#include "profiler/pictures/heat_map.h"
#include "profiler/pictures/ticks.h"

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
    lines.push_back(std::move(entry));
  }
  return lines;
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
  text.title = std::string("Cost per pixel: ") + methodName(profile.method);
  text.subtitle = what;
  text.unit = profile.unit;
  std::string measured = readable(static_cast<double>(profile.covered), 12) + " pixels";
  if (profile.reconstruction)
    measured += ", " + readable(static_cast<double>(profile.measured), 12) + " of them measured (" +
                percent(static_cast<double>(profile.measured) / static_cast<double>(profile.covered)) +
                "); the rest reconstructed, median error " + percent(profile.reconstruction->error) + " on " +
                std::to_string(profile.reconstruction->held_out) + " held-out pixels";
  if (profile.passes > 1)
    measured +=
        "; " + std::to_string(profile.passes) + " measurements each, spread " + percent(profile.spread);
  text.notes.push_back(measured + ".");
  text.notes.insert(text.notes.end(), profile.notes.begin(), profile.notes.end());
  return text;
}

void writeHeatExr(const Profile& profile, const std::string& path) {
  std::vector<double> cost;
  std::vector<double> measured;
  for (std::size_t i = 0; i < profile.map.cost.size(); ++i) {
    cost.push_back(static_cast<double>(static_cast<float>(profile.map.cost[i])));
    measured.push_back(profile.map.state[i] == PixelState::measured        ? 1
                       : profile.map.state[i] == PixelState::reconstructed ? 0.5
                                                                           : 0);
  }
  writeExr(path, profile.map.width, profile.map.height, {{"Y", cost}, {"measured", measured}});
}

}  // namespace

Json toJson(const Profile& profile, const ProfileFiles& files) {
  Json document;
  document["method"] = methodName(profile.method);
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
                                  {"error", number(profile.reconstruction->error)}};
  if (profile.same_output)
    document["same_output"] = {{"tried", profile.same_output->tried}, {"same", profile.same_output->same}};
  document["lines"] = linesOf(profile);
  document["check"] = checkOf(profile.check);
  document["notes"] = profile.notes;
  document["files"] = {
      {"heat.png", files.heat_png}, {"heat.exr", files.heat_exr}, {"profile.json", files.profile_json}};
  return document;
}

void writeProfile(const Profile& profile, const ProfileFiles& files, const std::string& what) {
  writeFile(files.heat_png, drawHeatMap(profile.map, textFor(profile, what)));
  writeHeatExr(profile, files.heat_exr);
  writeFile(files.profile_json,
            toJson(profile, files).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace shadestep::profiler
