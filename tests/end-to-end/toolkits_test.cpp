// Programs of the usual toolkits, each with its own way to a context and to its functions. Truth: the
// fragment shader's closed form, and the program's own look at its pixels.
#include <gtest/gtest.h>

#include <filesystem>

#include "launch.h"

namespace shadestep::test {
namespace {

struct Toolkit {
  std::string name, program;
  std::vector<std::string> arguments;
  std::string variable;          // NAME=VALUE of its environment
  std::uint64_t own_frames = 0;  // that the toolkit presents before the program's first
  std::vector<std::string> (*under)(std::vector<std::string>) = underX;
};

void PrintTo(const Toolkit& toolkit, std::ostream* out) {
  *out << toolkit.name;
}

class Toolkits : public testing::TestWithParam<Toolkit> {};

TEST_P(Toolkits, AreDebuggedInAnyFrame) {
  const Toolkit& toolkit = GetParam();
  const std::string program = binary("programs/toolkit-" + toolkit.program);
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "the toolkit was not there at the build";
  std::vector<std::string> command = {program};
  command.insert(command.end(), toolkit.arguments.begin(), toolkit.arguments.end());
  if (!toolkit.variable.empty()) command.insert(command.begin(), {"env", toolkit.variable});

  const Scratch scratch;
  for (const std::uint64_t frame : {0, 2}) {
    std::vector<std::string> debugger = {
        binary("shadestep"), "debug",   "--json",
        "--continue",        "--frame", std::to_string(toolkit.own_frames + frame),
        "--pixel",           "10,7",    "--"};
    debugger.insert(debugger.end(), command.begin(), command.end());
    const Finished finished = scratch.run(toolkit.under(debugger));
    constexpr int kCannotRunHere = 77;
    if (finished.status == kCannotRunHere) GTEST_SKIP() << finished.err;
    if (finished.status == 5 && scratch.run(toolkit.under(command)).status == kCannotRunHere)
      GTEST_SKIP() << finished.err;
    ASSERT_EQ(finished.status, 0) << "the program's own look at its pixels, or ours\n" << finished.err;
    const Json run = finished.json();
    EXPECT_EQ(run.at("check").at("outputs"), "identical");
    const Json first = run.at("steps").at(0);
    EXPECT_EQ(first.at("changed").at("seen").at("value"), 10.5 + 100.0 * static_cast<double>(frame));
  }
}

INSTANTIATE_TEST_SUITE_P(
    EndToEnd, Toolkits,
    testing::Values(Toolkit{"GlfwByGlx", "glfw", {}, "", 1}, Toolkit{"GlfwByEgl", "glfw", {"egl"}, "", 1},
                    Toolkit{"SdlByGlx", "sdl", {}, "", 0},
                    Toolkit{"SdlByEgl", "sdl", {}, "SDL_VIDEO_X11_FORCE_EGL=1", 0},
                    Toolkit{"GlutAndGlew", "glut-glew", {}, "", 0}, Toolkit{"Epoxy", "epoxy", {}, "", 0},
                    Toolkit{"QtByGlx", "qt", {}, "", 0},
                    Toolkit{"QtByEgl", "qt", {}, "QT_XCB_GL_INTEGRATION=xcb_egl", 0},
                    Toolkit{"PointersByGlsNames", "own-pointers", {}, "", 0},
                    Toolkit{"GlxWindow", "surfaces", {"glx-window"}, "", 0},
                    Toolkit{"GlxOldWindow", "surfaces", {"glx-old-window"}, "", 0},
                    Toolkit{"GlxPbuffer", "surfaces", {"glx-pbuffer"}, "", 0},
                    Toolkit{"GlxPixmap", "surfaces", {"glx-pixmap"}, "", 0},
                    Toolkit{"EglWindow", "surfaces", {"egl-window"}, "", 0},
                    Toolkit{"EglDevice", "surfaces", {"egl-device"}, "", 0},
                    Toolkit{"EglGbm", "surfaces", {"egl-gbm"}, "", 0},
                    Toolkit{"EglWayland", "surfaces", {"egl-wayland"}, "", 0, underWayland}),
    [](const auto& one) { return one.param.name; });

// Before main, and before every constructor of what was loaded ahead of the library has run.
TEST(StaticConstructor, ThatDrawsIsDebugged) {
  const Scratch scratch;
  for (const char* draw : {"0", "2"}) {
    const Finished finished =
        scratch.shadestep({"debug", "--json", "--continue", "--draw", draw, "--pixel", "10,7"},
                          {binary("programs/toolkit-early")});
    ASSERT_EQ(finished.status, 0) << finished.err;
    EXPECT_EQ(finished.json().at("check").at("outputs"), "identical");
    EXPECT_EQ(finished.json().at("steps").at(0).at("changed").at("seen").at("value"),
              10.5 + 100.0 * std::stod(draw));
  }
}

}  // namespace
}  // namespace shadestep::test
