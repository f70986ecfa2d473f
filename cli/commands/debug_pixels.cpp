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

Json asJson(const session::ThreadName& vertex, const TouchedPixels& touched) {
  Json thread = {{"stage", "vertex"}};
  for (const auto& [part, number] : vertex) thread[part] = number;
  const int(&box)[4] = touched.box;
  const Json around = {{"x", {box[0], box[1]}}, {"y", {box[2], box[3]}}};
  return {{"thread", std::move(thread)},
          {"primitives", touched.primitives},
          {"pixels", {{"count", touched.count}, {"box", touched.count > 0 ? around : Json(nullptr)}}},
          {"check", toJson(touched.check)}};
}

std::string asCsv(const TouchedPixels& touched) {
  std::string csv = "x,y,primitive\n";
  const auto width = static_cast<std::size_t>(touched.width);
  for (std::size_t p = 0; p < touched.marks.size(); ++p) {
    if (touched.marks[p] == 0) continue;
    csv += std::to_string(p % width) + "," + std::to_string(p / width) + "," +
           std::to_string(touched.on_pixel[p]) + "\n";
  }
  return csv;
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
  std::cout << "\n"
            << withThousands(touched.count) << " pixels show a fragment of "
            << (touched.primitives.size() == 1 ? "it" : "them");
  const int(&box)[4] = touched.box;
  if (touched.count > 0)
    std::cout << ", from " << box[0] << "," << box[2] << " to " << box[1] << "," << box[3];
  std::cout << "\n" << describe(touched.check) << "\n";
  return 0;
}

}  // namespace shadestep::cli
