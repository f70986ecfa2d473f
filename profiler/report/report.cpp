#include "profiler/report/report.h"

#include <cmath>
#include <cstring>

#include "profiler/pictures/colors.h"
#include "profiler/report/template.h"

namespace shadestep::profiler {
namespace {

using Json = nlohmann::ordered_json;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j) three = three << 8 | (i + j < bytes.size() ? bytes[i + j] : 0);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j > bytes.size() ? '=' : kDigits[three >> (18 - 6 * j) & 63];
  }
  return text;
}

std::string base64(const std::vector<double>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<float>(values[i]);
    std::memcpy(bytes.data() + i * sizeof value, &value, sizeof value);
  }
  return base64(bytes);
}

Json colorTable(Color (*colors)(double)) {
  Json table = Json::array();
  for (int i = 0; i < 256; ++i) {
    const Color c = colors(i / 255.0);
    table.push_back({std::lround(255 * c.r), std::lround(255 * c.g), std::lround(255 * c.b)});
  }
  return table;
}

Json layerOf(const ReportLayer& layer) {
  Json json{{"name", layer.name},
            {"unit", layer.unit},
            {"signed", layer.is_signed},
            {"values", base64(layer.values)}};
  json["doubt"] = layer.uncertainty.empty() ? Json(nullptr) : Json(base64(layer.uncertainty));
  return json;
}

}  // namespace

std::string makeReport(const Profile& profile, const Json& document, const std::vector<std::string>& source,
                       const std::string& subject, const std::vector<ReportLayer>& more,
                       const std::vector<ReportPicture>& pictures) {
  Json data;
  data["profile"] = document;
  data["subject"] = subject;
  data["source"] = source;
  data["colors"] = colorTable(sequentialColor);
  data["difference_colors"] = colorTable(differenceColor);
  std::vector<std::uint8_t> state;
  for (const PixelState s : profile.map.state) state.push_back(static_cast<std::uint8_t>(s));
  data["state"] = base64(state);
  data["layers"] = Json::array();
  data["layers"].push_back(layerOf({"cost", profile.unit, false, profile.map.cost, profile.uncertainty}));
  for (const ReportLayer& layer : more) data["layers"].push_back(layerOf(layer));

  data["pictures"] = Json::array();
  for (const ReportPicture& picture : pictures)
    data["pictures"].push_back(
        {{"title", picture.title},
         {"png", base64(std::vector<std::uint8_t>(picture.png.begin(), picture.png.end()))}});

  // Inside a script element nothing may look like its end.
  std::string json;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace))
    if (c == '<')
      json += "\\u003c";
    else
      json += c;
  std::string text = report_template();
  const std::string mark = "@DATA@";
  return text.replace(text.find(mark), mark.size(), json);
}

}  // namespace shadestep::profiler
