// Where textures are read, as files and as part of the document. Of every level that is read a picture (PNG)
// and the counts (EXR): NAME-level0.png and .exr, where NAME is the sampler's with '_' for what is no letter
// or digit. The slices, layers or faces of a level lie beside each other, row by row from the lower left.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "profiler/report/report.h"
#include "profiler/texture_access.h"

namespace shadestep::profiler {

// `beginning`: of the files' names, "DIR/texture-".
nlohmann::ordered_json toJson(const TextureAccesses&, const std::string& beginning);

// Writes the files; returns the pictures. `subject`: what was drawn, on what. Throws std::runtime_error with
// the file that could not be written.
std::vector<ReportPicture> writeTextures(const TextureAccesses&, const std::string& beginning,
                                         const std::string& subject);

// A level as one picture of width x height counters, from the lower left; -1 where there is none.
struct Sheet {
  int width = 0, height = 0;
  std::vector<double> reads;
};
Sheet sheetOf(const TextureLevelReads&);

}  // namespace shadestep::profiler
