// A profile as files and as a document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "profiler/profile.h"

namespace shadestep::profiler {

struct ProfileFiles {
  std::string heat_png;  // the picture
  std::string heat_exr;  // channel Y: cost, as floats; "measured": 1 measured, 0.5 reconstructed, 0 no thread
  std::string profile_json;  // the document below
};

// The document of docs/cli.md for the command `profile`. Numbers are exact; NaN is the string "NaN".
nlohmann::ordered_json toJson(const Profile&, const ProfileFiles&);

// Writes the three files. `what` names the subject on the picture: "raycaster, frame 0, draw 0".
// Throws std::runtime_error with the file that could not be written.
void writeProfile(const Profile&, const ProfileFiles&, const std::string& what);

}  // namespace shadestep::profiler
