#include "options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <iostream>
#include <map>

#include "image_file.h"
#include "medium.h"
#include "transfer_function.h"

namespace raycaster {
namespace {

// A finite number from low to high; CLI11's own Range lets NaN through.
CLI::Validator number(double low, double high) {
  const auto check = [low, high](const std::string& text) {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
    return good ? std::string() : fmt::format("{} is not a number from {} to {}", text, low, high);
  };
  return CLI::Validator(check, fmt::format("NUMBER in [{} - {}]", low, high));
}

// An option whose value is one of a few names.
template <class Value>
void addChoice(CLI::App& app, const std::string& name, Value& value,
               const std::map<std::string, Value>& choices, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  app.add_option_function<std::string>(
         name, [&value, choices](const std::string& chosen) { value = choices.at(chosen); }, help)
      ->check(CLI::IsMember(names));
}

// How to draw, beyond what a plain ray caster has.
void addChoices(CLI::App& app, Options& options) {
  app.add_option("--medium", options.medium,
                 "a medium with spectral properties instead of a transfer function, before a backdrop")
      ->check(CLI::IsMember(SpectralMedium::presets()));
  app.add_option("--wavelengths", options.wavelengths, "of a medium")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  addChoice<Storage>(app, "--storage", options.storage,
                     {{"coefficients", Storage::coefficients},
                      {"transmittance", Storage::transmittance},
                      {"opacity", Storage::opacity}},
                     "what the table of a scattering medium holds (coefficients)");
  app.add_flag("--slices", options.slices, "screen-aligned slices instead of rays");
  app.add_flag("--leap", options.leap, "rays begin where those of the last frame met something");
  app.add_option("--adaptive", options.adaptive,
                 "longer slabs where absorption varies by less than this per length; 0: never")
      ->check(number(0.0, 1e6))
      ->capture_default_str();
  app.add_option(
         "--budget", options.budget,
         "choose step, tables, termination and wavelengths so that the error stays below this; 0: as given")
      ->check(number(0.0, 1.0));
  app.add_option("--shader", options.shaderFile, "draw with the fragment shader in this file")
      ->check(CLI::ExistingFile);
  app.add_flag("--print-shader", options.printShader, "print the fragment shader for these options and end");
  app.add_flag("--printed-matrix", options.printedMatrix,
               "convert a medium's colours with the matrix of the thesis as printed");
  app.add_flag("--explain", options.explain, "print the plan for --budget");
  app.add_flag("--bench", options.bench, "print times and fetches as JSON");
  app.add_flag("--fetches", options.countFetches, "draw how many texels each ray fetches");
  app.add_flag("--interactive", options.interactive,
               "a window: drag to orbit, wheel or +/- to zoom, space for the next preset, q to leave");
}

// Options that exclude each other; "" if there is nothing to say.
std::string contradiction(const Options& options) {
  const bool emission = options.medium.empty();
  if (!emission && (options.slices || options.leap || options.adaptive > 0))
    return "--medium cannot be drawn with --slices, --leap or --adaptive; leave those out";
  if (int{options.slices} + int{options.leap} + int{options.adaptive > 0} > 1)
    return "--slices, --leap and --adaptive exclude each other; choose one";
  if (options.explain && options.budget == 0)
    return "--explain explains a plan; give it a --budget, for instance 1e-3";
  if (options.interactive && !options.out.empty())
    return "--interactive writes no file; leave out --out or draw without a window";
  return "";
}

}  // namespace

CommandLine parse(int argc, const char* const* argv) {
  CommandLine line;
  Options& options = line.options;
  CLI::App app(
      "Draws a volume by single-pass ray casting. Knows nothing of the debugger that it is shown with.",
      "raycaster");
  addChoice<ContextKind>(
      app, "--context", options.context,
      {{"osmesa", ContextKind::osmesa}, {"glx", ContextKind::glx}, {"egl", ContextKind::egl}},
      "where to draw (osmesa)");
  addChoice<Glsl>(app, "--glsl", options.glsl, {{"120", Glsl::v120}, {"330", Glsl::v330}},
                  "shading language: 120 in a compatibility context, 330 in a core one (330)");
  addChoice<Classification>(app, "--classification", options.classification,
                            {{"post", Classification::post},
                             {"fast", Classification::fast},
                             {"preintegrated", Classification::preintegrated}},
                            "how scalars become colours (preintegrated)");
  app.add_option("--volume", options.volume,
                 "c60 (a buckyball), cube (the same scalar everywhere), sphere, ramp, marschner-lobb, or a "
                 ".den, .nrrd, .nhdr or .raw file")
      ->check([](const std::string& name) {
        const bool known = syntheticVolume(name) || isVolumeFile(name);
        return known ? std::string()
                     : "'" + name + "' is neither a volume's name nor a .den, .nrrd or .raw file";
      })
      ->capture_default_str();
  std::vector<int> rawSize;
  RawLayout::Type rawType = RawLayout::Type::u8;
  app.add_option("--raw-size", rawSize, "voxels of a .raw file: X,Y,Z")->delimiter(',')->expected(3);
  addChoice<RawLayout::Type>(
      app, "--raw-type", rawType,
      {{"u8", RawLayout::Type::u8}, {"u16", RawLayout::Type::u16}, {"f32", RawLayout::Type::f32}},
      "their type, little-endian (u8)");
  app.add_option("--transfer", options.transfer, "transfer function")
      ->check(CLI::IsMember(TransferFunction::presets()))
      ->capture_default_str();
  addChoices(app, options);
  app.add_option("--size", options.size, "width and height in pixels")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  app.add_option("--step", options.step, "distance of samples; the volume's edge is 1")
      ->check(number(1e-6, 1.0))
      ->capture_default_str();
  app.add_option("--ert", options.opacityLimit, "a ray ends at this opacity; 0: never early")
      ->check(number(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--table", options.tableSize, "entries of the classification table along each axis")
      ->check(CLI::Range(2, 4096))
      ->capture_default_str();
  app.add_option("--table-bits", options.tableBits, "of its components: 8, 16 (half float) or 32 (float)")
      ->check(CLI::IsMember({8, 16, 32}))
      ->capture_default_str();
  app.add_option("--target-bits", options.targetBits, "of the image's components while drawing: 8, 16 or 32")
      ->check(CLI::IsMember({8, 16, 32}))
      ->capture_default_str();
  app.add_option("--yaw", options.orbit.yaw, "the camera's orbit, degrees")->check(number(-360.0, 360.0));
  app.add_option("--pitch", options.orbit.pitch, "degrees")->check(number(-90.0, 90.0));
  app.add_option("--distance", options.orbit.distance, "from the volume's centre, in edges")
      ->check(number(0.0, 100.0))
      ->capture_default_str();
  app.add_option("--turn", options.turn, "degrees of yaw from one frame to the next")
      ->check(number(-360.0, 360.0));
  app.add_option("--frames", options.frames, "how many to draw")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--out", options.out,
                 "the last frame as .png, .exr (float) or .raw (RGBA floats, bottom row first)")
      ->check([](const std::string& path) {
        return canWrite(path) ? std::string() : "'" + path + "' must end in .png, .exr or .raw";
      });
  try {
    app.parse(argc, argv);
    if (!rawSize.empty()) options.raw = RawLayout{{rawSize[0], rawSize[1], rawSize[2]}, rawType};
    if (options.interactive) options.context = ContextKind::glx;
    const std::string wrong = contradiction(options);
    if (!wrong.empty()) throw CLI::ValidationError(wrong);
    line.parsed = true;
  } catch (const CLI::CallForHelp& help) {
    line.exit = app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::cerr << "raycaster: " << error.what() << "; see raycaster --help\n";
  }
  return line;
}

}  // namespace raycaster
