// The ray caster under the debugger: the values it shows are the program's own.
// Truth comes from the program's own image, from the CPU model of the ray caster, and from the other plan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include "launch.h"
#include "options.h"
#include "reference.h"

namespace shadestep::test {
namespace {

constexpr int kSize = 64;

struct Variant {
  std::string context, glsl;
};

void PrintTo(const Variant& variant, std::ostream* out) {
  *out << variant.context << " " << variant.glsl;
}

std::vector<std::string> raycaster(const Variant& variant, const std::vector<std::string>& more = {}) {
  std::vector<std::string> command = {
      binary("raycaster"),   "--context", variant.context, "--glsl", variant.glsl, "--size",
      std::to_string(kSize), "--step",    "0.02"};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

Finished shadestep(const Scratch& scratch, const Variant& variant, std::vector<std::string> arguments,
                   const std::vector<std::string>& more = {}) {
  arguments.insert(arguments.begin(), binary("shadestep"));
  arguments.emplace_back("--");
  const auto program = raycaster(variant, more);
  arguments.insert(arguments.end(), program.begin(), program.end());
  return scratch.run(variant.context == "glx" ? underX(arguments) : arguments);
}

// The line of the fragment shader that contains `text`, by the tool's own listing.
int lineWith(const Scratch& scratch, const Variant& variant, const std::string& text) {
  const Json source = shadestep(scratch, variant, {"source", "--json"}).json();
  int number = 0;
  for (const auto& line : source["lines"]) {
    ++number;
    if (line.get<std::string>().find(text) != std::string::npos) return number;
  }
  ADD_FAILURE() << "no line with " << text;
  return 0;
}

std::uint32_t bitsOf(const std::string& text) {
  return std::bit_cast<std::uint32_t>(std::strtof(text.c_str(), nullptr));
}

class Raycaster : public testing::TestWithParam<Variant> {};

// For every covered pixel the last value of the accumulated colour is the program's own output, bit for bit.
TEST_P(Raycaster, LastColourIsTheProgramsOutput) {
  const Scratch scratch;
  const Variant& variant = GetParam();
  const auto plain = raycaster(variant, {"--out", scratch.file("plain.raw")});
  ASSERT_EQ(scratch.run(variant.context == "glx" ? underX(plain) : plain).status, 0);
  const std::string raw = readFile(scratch.file("plain.raw"));
  ASSERT_EQ(raw.size(), std::size_t{kSize} * kSize * 16);

  const int last = lineWith(scratch, variant, "Color = dst;");
  const Finished debugged =
      shadestep(scratch, variant,
                {"debug", "--at", std::to_string(last), "--print", "dst", "--csv", "dst.csv", "--json"});
  ASSERT_EQ(debugged.status, 0) << debugged.err;
  const Json document = debugged.json();
  EXPECT_EQ(document["check"]["outputs"], "identical");

  const auto rows = readCsv(scratch.file("dst.csv"));
  ASSERT_EQ(rows.size(), document["threads"]["launched"].get<std::size_t>());
  ASSERT_GT(rows.size(), 500u);
  std::size_t opaque = 0;
  for (const auto& row : rows) {
    const int x = std::stoi(row[0]);
    const int y = std::stoi(row[1]);
    std::uint32_t expected[4];
    std::memcpy(expected,
                raw.data() + (static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)) * 16, 16);
    for (std::size_t c = 0; c < 4; ++c)
      ASSERT_EQ(bitsOf(row[2 + c]), expected[c]) << "pixel " << x << "," << y << " component " << c;
    opaque += std::bit_cast<float>(expected[3]) > 0.5f ? 1 : 0;
  }
  EXPECT_GT(opaque, 100u) << "the image should not be empty";
}

// Iterations per thread, without early termination, are the length of the ray in steps, computed on the CPU.
TEST_P(Raycaster, IterationCountsFollowFromTheRaysLength) {
  const Scratch scratch;
  const Variant& variant = GetParam();
  const Finished looped = shadestep(
      scratch, variant, {"loops", "--json", "--iterations-image", "iterations.exr"}, {"--ert", "0"});
  ASSERT_EQ(looped.status, 0) << looped.err;
  const Json loop = looped.json()["loops"][0];

  const raycaster::Volume volume = raycaster::buckyball();
  const raycaster::Camera camera(volume.extent, raycaster::Options{}.orbit);
  std::map<long, std::uint64_t> expected;  // iterations -> rays
  std::uint64_t unsure = 0;                // rays that end so near a step's end that rounding decides
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto slabs = raycaster::slabs(camera, volume, 0.02, x, y, kSize);
      if (!slabs) continue;
      if (std::abs(*slabs - std::round(*slabs)) < 1e-4) ++unsure;
      ++expected[static_cast<long>(std::ceil(*slabs))];
    }
  }
  const auto left = loop["left"].get<std::vector<std::uint64_t>>();
  std::uint64_t misplaced = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::uint64_t rays = expected[static_cast<long>(i) + 1];
    misplaced += left[i] > rays ? left[i] - rays : rays - left[i];
  }
  EXPECT_LE(misplaced, 2 * unsure + 2 * expected[0]);
  EXPECT_LT(unsure, 20u);
  EXPECT_EQ(loop["max"].get<long>(), expected.rbegin()->first);
}

// The recording of one pixel and single probes over all pixels agree bit for bit, at several places and
// iterations.
TEST_P(Raycaster, TheTwoPlansAgree) {
  const Scratch scratch;
  const Variant& variant = GetParam();
  const std::vector<std::string> to_the_end = {"--ert", "0"};
  const Json run = shadestep(scratch, variant, {"debug", "--pixel", "30,34", "--json"}, to_the_end).json();
  ASSERT_EQ(run["check"]["outputs"], "identical");
  const int line = lineWith(scratch, variant, "scalarOld = scalar;");

  std::size_t compared = 0;
  for (const int iteration : {0, 1, 7, 15}) {
    // What the recording knows when the line is about to run: the last change of each variable before it.
    std::map<std::string, Json> known;
    bool found = false;
    for (const Json& step : run["steps"]) {
      if (step["line"] == line && step["iteration"] == Json::array({iteration})) {
        found = true;
        break;
      }
      if (step["function"] != "main") continue;
      for (const auto& [name, value] : step["changed"].items()) known[name] = value["value"];
    }
    ASSERT_TRUE(found) << "iteration " << iteration;
    const Json values =
        shadestep(scratch, variant,
                  {"debug", "--at", std::to_string(line), "--iteration", std::to_string(iteration), "--pixel",
                   "30,34", "--print", "dst,src,pos,scalar,scalarOld,thickness,i", "--json"},
                  to_the_end)
            .json()["values"];
    for (const auto& [name, value] : values.items()) {
      ASSERT_TRUE(known.count(name)) << name << " is not in the recording";
      EXPECT_EQ(value["at_pixel"], known[name]) << name << " in iteration " << iteration;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 4u * 7u);
}

// The recorded run ends with the colour that the pixel has.
TEST_P(Raycaster, TheRunEndsWithThePixelsColour) {
  const Scratch scratch;
  const Json run = shadestep(scratch, GetParam(), {"debug", "--pixel", "30,34", "--json"}).json();
  EXPECT_EQ(run["outcome"], "finished");
  const Json& last = run["steps"].back();
  const std::string output = GetParam().glsl == "120" ? "gl_FragColor" : "FragColor";
  ASSERT_TRUE(last["changed"].contains(output)) << last.dump();
  EXPECT_EQ(last["changed"][output]["value"], run["outputs"][0]);
}

// The program's own final image is the same with and without the debugger.
TEST_P(Raycaster, TheImageIsTheSameUnderTheDebugger) {
  const Scratch scratch;
  const Variant& variant = GetParam();
  const auto plain = raycaster(variant, {"--frames", "2", "--out", "plain.raw"});
  ASSERT_EQ(scratch.run(variant.context == "glx" ? underX(plain) : plain).status, 0);
  const std::string expected = readFile(scratch.file("plain.raw"));
  ASSERT_FALSE(expected.empty());

  const Finished every =
      shadestep(scratch, variant, {"run", "--every-draw", "--json"}, {"--frames", "2", "--out", "every.raw"});
  EXPECT_EQ(every.status, 0) << every.err;
  EXPECT_EQ(every.json()["debugged"], 2) << every.err;
  EXPECT_TRUE(readFile(scratch.file("every.raw")) == expected);

  const Finished stepped = shadestep(scratch, variant, {"debug", "--pixel", "30,34", "--continue", "--json"},
                                     {"--frames", "2", "--out", "stepped.raw"});
  EXPECT_EQ(stepped.status, 0) << stepped.err;
  EXPECT_TRUE(readFile(scratch.file("stepped.raw")) == expected);
}

// Without storage buffers a run is followed by one probe per step. It is the same run, but for returned
// values, which no probe can see, and for the operands that ran, which none is asked for.
TEST(EndToEnd, ARunByProbesIsTheRecordedRun) {
  for (const char* glsl : {"120", "330"}) {
    const Scratch scratch;
    const auto run = [&](const std::string& extensions) {
      const Finished finished =
          scratch.run({"env", "MESA_EXTENSION_OVERRIDE=" + extensions, binary("shadestep"), "debug",
                       "--pixel", "10,14", "--json", "--", binary("raycaster"), "--glsl", glsl, "--size",
                       "32", "--step", "0.2", "--ert", "0"});
      Json document = finished.json();
      for (Json& step : document["steps"]) {
        if (step["kind"] == "return") step["changed"] = Json::object();
        step.erase("choices");
      }
      return document;
    };
    const Json recorded = run("");
    const Json probed = run("-GL_ARB_shader_storage_buffer_object");
    EXPECT_GT(recorded["steps"].size(), 50u);
    EXPECT_EQ(probed["steps"], recorded["steps"]) << "GLSL " << glsl;
    EXPECT_EQ(probed["outputs"], recorded["outputs"]);
    EXPECT_EQ(probed["check"], recorded["check"]);
  }
}

INSTANTIATE_TEST_SUITE_P(EndToEnd, Raycaster,
                         testing::Values(Variant{"osmesa", "120"}, Variant{"osmesa", "330"},
                                         Variant{"egl", "120"}, Variant{"egl", "330"}, Variant{"glx", "120"},
                                         Variant{"glx", "330"}),
                         [](const auto& variant) { return variant.param.context + variant.param.glsl; });

// Three contexts and both GLSL versions give the same run of a pixel (but for what the versions spell
// differently).
TEST(EndToEnd, ContextsAndGlslVersionsGiveTheSameRun) {
  const Scratch scratch;
  std::map<std::string, std::vector<Json>> runs;
  for (const char* context : {"osmesa", "egl", "glx"}) {
    for (const char* glsl : {"120", "330"}) {
      const Json run = shadestep(scratch, {context, glsl}, {"debug", "--pixel", "20,40", "--json"}).json();
      Json values = Json::array();
      for (const Json& step : run["steps"]) {
        Json changed = Json::array();
        for (const auto& [name, value] : step["changed"].items()) changed.push_back(value["value"]);
        values.push_back({step["kind"], step["iteration"], changed});
      }
      runs[glsl].push_back(values);
    }
  }
  for (const auto& [glsl, list] : runs) {
    EXPECT_GT(list[0].size(), 100u);
    EXPECT_EQ(list[0], list[1]) << "osmesa and egl, GLSL " << glsl;
    EXPECT_EQ(list[0], list[2]) << "osmesa and glx, GLSL " << glsl;
  }
  EXPECT_EQ(runs["120"][0], runs["330"][0]);
}

}  // namespace
}  // namespace shadestep::test
