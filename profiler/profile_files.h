// A profile as files and as a document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "profiler/comparison.h"
#include "profiler/profile.h"

namespace shadestep::profiler {

struct ProfileFiles {
  std::string heat_png;      // the picture
  std::string heat_exr;      // channels: Y, cost; measured: 1 measured, 0.5 reconstructed, 0 no thread;
                             // uncertainty: 95% half width; diverging, where it was counted: 1
                             // where the threads of a grain do not all do the same
  std::string height_png;    // the same as a landscape
  std::string profile_json;  // the document below
  std::string report_html;   // all of it to look at in a browser, offline
  std::string threads_csv;  // a row per thread: who it is, its cost, its uncertainty, whether it was measured
                            // (1) or reconstructed (0); empty: not wanted
  std::string per_iteration_png,
      per_iteration_exr;                       // cost over iterations of the busiest loop; empty: not wanted
  std::string difference_png, difference_exr;  // with a comparison; channel Y: now - before
  std::string neighbours_png, neighbours_exr;  // with the cost of neighbours; channels Y, uncertainty
  std::string
      texture;  // with texture accesses: the beginning of their names, "DIR/texture-" (texture_files.h)
};

// What the files are about.
struct Subject {
  std::string what;                 // "raycaster, frame 0, draw 0"
  std::vector<std::string> source;  // the shader's lines
};

// "raycaster, frame 0, draw 0, fragment shader, on llvmpipe (...)"
std::string subjectOf(const std::string& program, session::Session&);

// The document of docs/cli.md for the command `profile`. Numbers are exact; NaN is the string "NaN".
nlohmann::ordered_json toJson(const Profile&, const ProfileFiles&, const Subject&,
                              const Comparison* comparison = nullptr);

// Writes the files. Throws std::runtime_error with the file that could not be written.
void writeProfile(const Profile&, const ProfileFiles&, const Subject&,
                  const Comparison* comparison = nullptr);

}  // namespace shadestep::profiler
