// The command line of the ray caster.
#pragma once

#include <optional>
#include <string>

#include "camera.h"
#include "context.h"
#include "permutation.h"
#include "volume_file.h"

namespace raycaster {

struct Options {
  ContextKind context = ContextKind::osmesa;
  Glsl glsl = Glsl::v330;
  Classification classification = Classification::preintegrated;
  std::string volume = "c60";  // a synthetic one's name, or a file
  std::optional<RawLayout> raw;
  std::string transfer = "shells";
  std::string medium;  // a spectral one's name; "" = the transfer function's
  int wavelengths = 16;
  Storage storage = Storage::coefficients;
  bool slices = false;  // instead of rays
  bool leap = false;
  double adaptive = 0;  // tolerance; 0 = off
  double budget = 0;    // root mean square error that a plan has to keep; 0 = the settings above as they are
  std::string shaderFile;  // a fragment shader to draw with instead of the assembled one
  bool printShader = false;
  bool printedMatrix = false;  // XYZ to RGB as the thesis prints it
  bool explain = false, bench = false, interactive = false, countFetches = false;
  int size = 512;              // image, pixels an edge
  double step = 1.0 / 256;     // object space; the volume's edge is 1
  double opacityLimit = 0.95;  // 0 = off
  int tableSize = 256, tableBits = 32, targetBits = 32;
  Orbit orbit;
  double turn = 0;  // degrees of yaw from frame to frame
  int frames = 1;
  std::string out;  // "" = no file
};

// Parsed is false when the program should end with `exit` at once (--help, or an error already printed).
struct CommandLine {
  bool parsed = false;
  int exit = 2;
  Options options;
};
CommandLine parse(int argc, const char* const* argv);

}  // namespace raycaster
