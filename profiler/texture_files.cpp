#include "profiler/texture_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "profiler/pictures/files.h"
#include "profiler/pictures/heat_map.h"
#include "profiler/pictures/ticks.h"

namespace shadestep::profiler {
namespace {

using Json = nlohmann::ordered_json;

std::string baseName(const TextureReads& texture, const TextureLevelReads& level) {
  std::string name = texture.sampler;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name + "-level" + std::to_string(level.level);
}

Json levelJson(const TextureReads& texture, const TextureLevelReads& level, const std::string& beginning) {
  Json json{{"level", level.level},
            {"width", level.width},
            {"height", level.height},
            {"depth", level.depth},
            {"bin", {level.bin, level.bin, level.bin_z}},
            {"reads", level.total},
            {"most", level.most},
            {"used", level.used},
            {"box", nullptr},
            {"files", nullptr}};
  if (level.total == 0) return json;
  // In texels, both ends included.
  const int bins[] = {level.bin, level.bin, level.bin_z};
  const int sizes[] = {level.width, level.height, level.depth};
  Json first = Json::array();
  Json last = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    first.push_back(level.first[axis] * bins[axis]);
    last.push_back(std::min((level.last[axis] + 1) * bins[axis], sizes[axis]) - 1);
  }
  json["box"] = {first, last};
  const std::string name = beginning + baseName(texture, level);
  json["files"] = {{"png", name + ".png"}, {"exr", name + ".exr"}};
  return json;
}

HeatMapText textFor(const TextureReads& texture, const TextureLevelReads& level, const std::string& subject) {
  HeatMapText text;
  text.title = "Where " + texture.sampler + " is read: level " + std::to_string(level.level);
  text.subtitle = subject;
  text.unit = "reads";
  text.nothing = "never read";
  std::string size = std::to_string(level.width) + " x " + std::to_string(level.height);
  if (level.depth > 1) size += " x " + std::to_string(level.depth);
  const std::string counters = level.bin > 1 || level.bin_z > 1 ? "counters" : "texels";
  text.notes.push_back(size + " texels, " + texture.min_filter + ", " + texture.mag_filter + ". " +
                       readable(static_cast<double>(level.total), 12) + " reads; " +
                       readable(100 * level.used, 3) + " % of the " + counters +
                       " are read at all, one of them " + readable(static_cast<double>(level.most), 12) +
                       " times.");
  if (level.bin > 1)
    text.notes.push_back("A counter stands for " + std::to_string(level.bin) + " x " +
                         std::to_string(level.bin) + " x " + std::to_string(level.bin_z) + " texels.");
  if (level.slices > 1) text.notes.push_back("Slices lie beside each other, row by row from the lower left.");
  return text;
}

}  // namespace

// Slices in a grid that is about as wide as high; a long line in rows.
Sheet sheetOf(const TextureLevelReads& level) {
  constexpr int kLongLine = 256;
  Sheet sheet;
  if (level.rows == 1 && level.slices == 1 && level.columns > kLongLine) {
    sheet.width = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(level.columns))));
    sheet.height = (level.columns + sheet.width - 1) / sheet.width;
    sheet.reads.assign(level.reads.begin(), level.reads.end());
    sheet.reads.resize(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), -1);
    return sheet;
  }
  const double side = std::sqrt(static_cast<double>(level.slices) * level.rows / level.columns);
  const int across = std::clamp(static_cast<int>(std::ceil(side)), 1, level.slices);
  sheet.width = across * level.columns;
  sheet.height = (level.slices + across - 1) / across * level.rows;
  sheet.reads.assign(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), -1);
  std::size_t i = 0;
  for (int z = 0; z < level.slices; ++z)
    for (int y = 0; y < level.rows; ++y)
      for (int x = 0; x < level.columns; ++x, ++i) {
        const auto column = static_cast<std::size_t>(z % across * level.columns + x);
        const auto row = static_cast<std::size_t>(z / across * level.rows + y);
        sheet.reads[row * static_cast<std::size_t>(sheet.width) + column] = level.reads[i];
      }
  return sheet;
}

Json toJson(const TextureAccesses& accesses, const std::string& beginning) {
  Json textures = Json::array();
  for (const TextureReads& texture : accesses.textures) {
    Json levels = Json::array();
    for (const TextureLevelReads& level : texture.levels)
      levels.push_back(levelJson(texture, level, beginning));
    textures.push_back({{"sampler", texture.sampler},
                        {"reason", texture.reason.empty() ? Json(nullptr) : Json(texture.reason)},
                        {"unit", texture.unit},
                        {"texture", texture.texture},
                        {"min_filter", texture.min_filter},
                        {"mag_filter", texture.mag_filter},
                        {"wrap", {texture.wrap[0], texture.wrap[1], texture.wrap[2]}},
                        {"reads", texture.reads},
                        {"border", texture.border},
                        {"levels", std::move(levels)}});
  }
  Json lookups = Json::array();
  for (const LookupReads& lookup : accesses.lookups)
    lookups.push_back({{"sampler", lookup.sampler},
                       {"function", lookup.function},
                       {"line", lookup.line},
                       {"column", lookup.column},
                       {"reason", lookup.reason.empty() ? Json(nullptr) : Json(lookup.reason)},
                       {"lookups", lookup.lookups},
                       {"outside", lookup.outside},
                       {"undefined", lookup.undefined}});
  return {{"threads", accesses.threads},
          {"textures", std::move(textures)},
          {"lookups", std::move(lookups)},
          {"notes", accesses.notes}};
}

std::vector<ReportPicture> writeTextures(const TextureAccesses& accesses, const std::string& beginning,
                                         const std::string& subject) {
  std::vector<ReportPicture> pictures;
  for (const TextureReads& texture : accesses.textures)
    for (const TextureLevelReads& level : texture.levels) {
      if (level.total == 0) continue;
      const Sheet sheet = sheetOf(level);
      CostMap map(sheet.width, sheet.height);
      for (std::size_t i = 0; i < sheet.reads.size(); ++i) {
        map.cost[i] = std::max(sheet.reads[i], 0.0);
        map.state[i] = sheet.reads[i] > 0 ? PixelState::measured : PixelState::none;
      }
      const HeatMapText text = textFor(texture, level, subject);
      const std::string name = beginning + baseName(texture, level);
      pictures.push_back({text.title, drawHeatMap(map, text)});
      writeFile(name + ".png", pictures.back().png);
      writeExr(name + ".exr", sheet.width, sheet.height, {{"Y", map.cost}});
    }
  return pictures;
}

}  // namespace shadestep::profiler
