// The header of an NRRD file ("nearly raw raster data", teem.sourceforge.net/nrrd/format.html).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>

namespace raycaster {

struct NrrdHeader {
  enum class Encoding { raw, text, gzip };
  Eigen::Vector3i size = {0, 0, 0};
  Eigen::Vector3d spacing = {1, 1, 1};
  std::string type;  // NRRD's canonical name: "uint8", "int16", "float", ...
  Encoding encoding = Encoding::raw;
  bool bigEndian = false;
  std::string dataFile;         // "" = the data follow the header
  std::size_t headerBytes = 0;  // up to and with the empty line
};

// Throws std::runtime_error saying which field is missing or cannot be understood.
NrrdHeader parseNrrd(std::string_view file);

}  // namespace raycaster
