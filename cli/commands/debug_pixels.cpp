// From a vertex to the pixels that it touched.
#include <iostream>

#include "cli/commands/debug.h"
#include "profiler/pictures/files.h"
#include "profiler/pictures/value_image.h"
#include "session/touched_pixels.h"

namespace shadestep::cli {
namespace {

using session::TouchedPixels;

std::string nameText(const session::ThreadName& name) {
  std::string text;
  for (const auto& [part, number] : name)
    text += (text.empty() ? "" : ", ") + part + " " + std::to_string(number);
  return text;
}

std::string numbersText(const std::vector<int>& numbers) {
  constexpr std::size_t kMost = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(numbers.size(), kMost); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
  if (numbers.size() > kMost) text += " and " + withThousands(numbers.size() - kMost) + " more";
  return text;
}

Json asJson(const TouchedPixels::Some& pixels) {
  const int(&box)[4] = pixels.box;
  const Json around = {{"x", {box[0], box[1]}}, {"y", {box[2], box[3]}}};
  return {{"count", pixels.count}, {"box", pixels.count > 0 ? around : Json(nullptr)}};
}

Json asJson(const session::ThreadName& vertex, const TouchedPixels& touched) {
  Json thread = {{"stage", "vertex"}};
  for (const auto& [part, number] : vertex) thread[part] = number;
  const bool known = touched.hidden_unknown.empty();
  return {{"thread", std::move(thread)},
          {"primitives", touched.primitives},
          {"pixels", asJson(touched.shown)},
          {"hidden", known ? asJson(touched.hidden) : Json(nullptr)},
          {"hidden_unknown", known ? Json(nullptr) : Json(touched.hidden_unknown)},
          {"check", toJson(touched.check)}};
}

std::string asCsv(const TouchedPixels& touched) {
  std::string csv = "x,y,primitive,shown\n";
  const auto width = static_cast<std::size_t>(touched.width);
  for (std::size_t p = 0; p < touched.marks.size(); ++p) {
    const bool shown = touched.marks[p] != 0;
    const int primitive = shown ? touched.on_pixel[p] : touched.hidden_on_pixel[p];
    if (primitive == TouchedPixels::kNothing) continue;
    csv += std::to_string(p % width) + "," + std::to_string(p / width) + "," + std::to_string(primitive) +
           (shown ? ",1\n" : ",0\n");
  }
  return csv;
}

std::string boxText(const TouchedPixels::Some& pixels) {
  if (pixels.count == 0) return "";
  const int(&box)[4] = pixels.box;
  return ", from " + std::to_string(box[0]) + "," + std::to_string(box[2]) + " to " + std::to_string(box[1]) +
         "," + std::to_string(box[3]);
}

// The touched pixels by their primitives; hatched: the draw's others.
void writeImage(const std::string& path, const std::string& vertex, const TouchedPixels& touched) {
  profiler::ValueImage image;
  image.width = touched.width;
  image.height = touched.height;
  image.components.emplace_back();
  for (std::size_t p = 0; p < touched.marks.size(); ++p) {
    image.state.push_back(touched.marks[p] != 0 ? profiler::ThreadState::reached
                          : touched.on_pixel[p] == TouchedPixels::kNothing
                              ? profiler::ThreadState::none
                              : profiler::ThreadState::not_reached);
    image.components.back().push_back(touched.on_pixel[p]);
  }
  if (path.ends_with(".exr"))
    profiler::writeValueExr(path, image);
  else
    profiler::writeFile(
        path, profiler::drawValueImage(image, {"gl_PrimitiveID", "pixels that " + vertex + " touches"}));
}

}  // namespace

int debugPixels(session::Session& session, const Common& common, const DebugOptions& options) {
  const session::ThreadName vertex = chosenThread(session.stage(), options, false).value();
  const TouchedPixels touched = session::touchedBy(session, vertex);
  if (!options.image.empty()) writeImage(common.inOut(options.image), nameText(vertex), touched);
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(touched));
  if (common.json) {
    print(asJson(vertex, touched));
    return 0;
  }
  std::cout << nameText(vertex) << " belongs to " << withThousands(touched.primitives.size())
            << (touched.primitives.size() == 1 ? " primitive" : " primitives");
  if (!touched.primitives.empty()) std::cout << ": " << numbersText(touched.primitives);
  const std::string them = touched.primitives.size() == 1 ? "it" : "them";
  std::cout << "\n"
            << withThousands(touched.shown.count) << " pixels show a fragment of " << them
            << boxText(touched.shown) << "\n";
  if (!touched.hidden_unknown.empty())
    std::cout << "hidden fragments are not told: " << touched.hidden_unknown;
  else
    std::cout << withThousands(touched.hidden.count) << " more have a fragment of " << them
              << " that is hidden or discarded" << boxText(touched.hidden);
  std::cout << "\n" << describe(touched.check) << "\n";
  return 0;
}

}  // namespace shadestep::cli
