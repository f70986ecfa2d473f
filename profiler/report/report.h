// The report: one HTML file that holds all it shows and reads from disk, offline.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "profiler/profile.h"

namespace shadestep::profiler {

// A map to look at beside the costs.
struct ReportLayer {
  std::string name;  // "iterations of the loop at line 58"
  std::string unit;
  bool is_signed = false;           // a difference: the colours have a middle
  std::vector<double> values;       // per pixel, rows from the bottom up
  std::vector<double> uncertainty;  // per pixel; may be empty
};

// A picture that stands in the report as it is.
struct ReportPicture {
  std::string title;
  std::string png;  // the file's bytes
};

// The file's text. `document`: what toJson gives; `source`: the shader's lines.
std::string makeReport(const Profile&, const nlohmann::ordered_json& document,
                       const std::vector<std::string>& source, const std::string& subject,
                       const std::vector<ReportLayer>& more, const std::vector<ReportPicture>& pictures = {});

}  // namespace shadestep::profiler
