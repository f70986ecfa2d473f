// The textures that a draw reads, and the texels of one.
#include <algorithm>
#include <iostream>
#include <limits>

#include "cli/commands/state.h"
#include "profiler/pictures/files.h"
#include "profiler/pictures/value_image.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using session::ShaderTexture;
using session::TextureImage;

std::string sizeOf(const session::SampledTexture& facts) {
  if (facts.levels.empty()) return "";
  const auto& base = facts.levels.front();
  std::string text = std::to_string(base.width) + " x " + std::to_string(base.height);
  if (base.depth > 1) text += " x " + std::to_string(base.depth);
  if (facts.samples > 0) text += ", " + std::to_string(facts.samples) + " samples";
  return text;
}

std::string exact(const TextureImage& image, std::size_t word) {
  return session::formatComponent(image.type.basic, &image.words[word]);
}

// Every channel, or those that the format may have: what it lacks reads as 0, alpha as 1.
profiler::ValueImage asImage(const TextureImage& image, bool all = true) {
  profiler::ValueImage result;
  result.width = image.width;
  result.height = image.height;
  const std::size_t texels = image.words.size() / 4;
  result.state.assign(texels, profiler::ThreadState::reached);
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<double>& plane = result.components.emplace_back();
    for (std::size_t i = 0; i < texels; ++i)
      plane.push_back(session::componentAsDouble(image.type.basic, &image.words[i * 4 + c]));
  }
  const auto everywhere = [&](std::size_t channel, double value) {
    const std::vector<double>& plane = result.components[channel];
    return std::all_of(plane.begin(), plane.end(), [&](double one) { return one == value; });
  };
  if (all || !everywhere(3, 1.0)) return result;
  result.components.pop_back();
  while (result.components.size() > 1 && everywhere(result.components.size() - 1, 0.0))
    result.components.pop_back();
  return result;
}

std::string asCsv(const TextureImage& image) {
  std::string csv = "x,y,r,g,b,a\n";
  for (std::size_t i = 0; i < image.words.size() / 4; ++i) {
    const auto width = static_cast<std::size_t>(image.width);
    const auto stride = static_cast<std::size_t>(image.stride);
    csv += std::to_string(i % width * stride) + "," + std::to_string(i / width * stride);
    for (std::size_t c = 0; c < 4; ++c) csv += "," + exact(image, i * 4 + c);
    csv += "\n";
  }
  return csv;
}

void writeImage(const std::string& path, const TextureImage& image) {
  if (path.ends_with(".exr")) return profiler::writeValueExr(path, asImage(image));
  if (!path.ends_with(".png"))
    throw session::Error(session::Outcome::usage,
                         "--image takes a file that ends in .png or .exr, not '" + path + "'");
  profiler::ValueImageText text;
  text.title = image.uniform + " (" + glslName(image.type) + ")";
  text.subtitle = "level " + std::to_string(image.level) + ", slice " + std::to_string(image.slice);
  text.each = "texels";
  profiler::writeFile(path, profiler::drawValueImage(asImage(image, false), text));
}

// Of the numbers of each channel, least and greatest.
std::vector<std::pair<double, double>> ranges(const TextureImage& image) {
  std::vector<std::pair<double, double>> result;
  for (const std::vector<double>& plane : asImage(image).components) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::pair range{kInfinity, -kInfinity};
    for (const double value : plane) {
      range.first = std::min(range.first, value);
      range.second = std::max(range.second, value);
    }
    result.push_back(range);
  }
  return result;
}

Json asJson(const TextureImage& image) {
  Json document;
  document["texture"] = image.uniform;
  document["level"] = image.level;
  document["slice"] = image.slice;
  document["width"] = image.width;
  document["height"] = image.height;
  document["every"] = image.stride;
  document["type"] = glslName(image.type);
  document["min"] = Json::array();
  document["max"] = Json::array();
  for (const auto& [low, high] : ranges(image)) {
    document["min"].push_back(number(low));
    document["max"].push_back(number(high));
  }
  document["check"] = toJson(image.check);
  return document;
}

void printText(const TextureImage& image) {
  std::cout << image.uniform << " (" << glslName(image.type) << "), level " << image.level << ", slice "
            << image.slice << ": " << image.width << " x " << image.height << " texels";
  if (image.stride > 1) std::cout << ", every " << image.stride << "th along each axis";
  std::cout << "\n";
  static constexpr const char* kNames[] = {"r", "g", "b", "a"};
  const auto found = ranges(image);
  for (std::size_t c = 0; c < found.size(); ++c)
    std::cout << "  " << kNames[c] << " from " << profiler::exactText(static_cast<float>(found[c].first))
              << " to " << profiler::exactText(static_cast<float>(found[c].second)) << "\n";
  std::cout << (image.check.compared_at_all && image.check.identical()
                    ? "read in two ways, with the same result"
                    : "NOT THE SAME when it is read in two ways: do not trust these texels")
            << "\n";
}

}  // namespace

Json asJson(const ShaderTexture& texture) {
  const session::SampledTexture& facts = texture.facts;
  Json levels = Json::array();
  for (const auto& level : facts.levels) levels.push_back({level.width, level.height, level.depth});
  return {{"uniform", facts.uniform},
          {"type", texture.type},
          {"unit", facts.unit},
          {"texture", facts.texture},
          {"base_level", facts.base_level},
          {"levels", std::move(levels)},
          {"samples", facts.samples},
          {"reason", facts.reason.empty() ? Json(nullptr) : Json(facts.reason)}};
}

std::string asText(const ShaderTexture& texture) {
  const session::SampledTexture& facts = texture.facts;
  std::string text = facts.uniform + " (" + texture.type + "): unit " + std::to_string(facts.unit);
  if (!facts.reason.empty()) return text + ", " + facts.reason;
  text += ", texture " + std::to_string(facts.texture) + ", " + sizeOf(facts);
  if (facts.levels.size() > 1) text += ", " + std::to_string(facts.levels.size()) + " levels";
  return text;
}

int showTexture(session::Session& session, const Common& common, const StateOptions& options) {
  int level = options.level;
  if (level < 0) {
    level = 0;
    for (const ShaderTexture& texture : session::shaderTextures(session))
      if (texture.facts.uniform == options.texture) level = texture.facts.base_level;
  }
  const TextureImage image = session::textureImage(session, options.texture, level, options.slice);
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(image));
  if (!options.image.empty())
    for (const std::string& file : splitList(options.image)) writeImage(common.inOut(file), image);
  if (common.json)
    print(asJson(image));
  else
    printText(image);
  return image.check.identical() ? 0 : static_cast<int>(session::Outcome::failed);
}

}  // namespace shadestep::cli
