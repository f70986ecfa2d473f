// Bad input: the exit codes of docs/cli.md, one clear sentence, no process and no half-written file left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "launch.h"

namespace shadestep::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> kRaycaster = {binary("raycaster"), "--size", "32", "--step", "0.05"};

// One sentence on stderr from shadestep, nothing on stdout, and no file left in the directory.
void expectRefusal(const Finished& finished, int status, const std::string& words) {
  EXPECT_EQ(finished.status, status) << finished.command << "\n" << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("shadestep: ")) << finished.command;
  EXPECT_THAT(finished.err, HasSubstr(words)) << finished.command;
  EXPECT_THAT(finished.out, IsEmpty()) << finished.command;
}

struct Case {
  std::string name;
  std::vector<std::string> arguments, program;
  int status;
  std::string words;
};

void PrintTo(const Case& given, std::ostream* out) {
  *out << given.name;
}

// In arguments: the first line inside the ray caster's loop.
const std::string kInLoop = "LINE_IN_LOOP";

std::string lineInLoop(const Scratch& scratch) {
  const Json source = scratch.shadestep({"source", "--json"}, kRaycaster).json();
  int loop = 0;
  for (const Json& site : source.at("sites")) {
    if (site.at("kind") == "for") loop = site.at("line");
    if (loop > 0 && site.at("line") > loop) return site.at("line").dump();
  }
  return "no loop";
}

class BadInput : public testing::TestWithParam<Case> {};

TEST_P(BadInput, IsSaidWithItsExitCode) {
  const Case& given = GetParam();
  const Scratch scratch;
  std::vector<std::string> arguments = given.arguments;
  for (std::string& argument : arguments)
    if (argument == kInLoop) argument = lineInLoop(scratch);
  expectRefusal(scratch.shadestep(arguments, given.program), given.status, given.words);
  EXPECT_THAT(scratch.files(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    EndToEnd, BadInput,
    testing::Values(
        Case{"NoSuchProgram", {"debug", "--pixel", "1,1"}, {"./no-such-program"}, 2, "no-such-program"},
        Case{"NoProgram", {"debug", "--pixel", "1,1"}, {}, 2, "after '--'"},
        Case{"NeitherThreadNorPlace", {"debug"}, kRaycaster, 2, "--pixel"},
        Case{"PixelIsNoPixel", {"debug", "--pixel", "middle"}, kRaycaster, 2, "--pixel"},
        Case{"NoSuchStageName", {"debug", "--pixel", "1,1", "--stage", "pixel"}, kRaycaster, 2, "pixel"},
        Case{"NoGlInIt",
             {"debug", "--json", "--pixel", "1,1"},
             {binary("programs/no-gl")},
             5,
             "without using OpenGL"},
        Case{"NoSuchFrame", {"debug", "--frame", "7", "--pixel", "1,1"}, kRaycaster, 5, "before frame 7"},
        Case{"NoSuchDraw", {"debug", "--draw", "9", "--pixel", "1,1"}, kRaycaster, 3, "has 1 draw: 0"},
        Case{"PixelOutside", {"debug", "--pixel", "32,0"}, kRaycaster, 3, "32 x 32"},
        Case{"PixelNotCovered", {"debug", "--pixel", "0,0"}, kRaycaster, 3, "no fragment on pixel 0,0"},
        Case{"NoSuchLine", {"debug", "--at", "9999", "--print", "dst"}, kRaycaster, 3, "hold statements"},
        Case{"NoSuchVariable",
             {"debug", "--at", kInLoop, "--print", "nothing_like_it"},
             kRaycaster,
             3,
             "nothing_like_it"},
        Case{"NoSuchIteration",
             {"debug", "--at", kInLoop, "--iteration", "4000", "--print", "dst"},
             kRaycaster,
             3,
             "none of the"},
        Case{"TooManyIterations",
             {"debug", "--at", kInLoop, "--iteration", "1,2", "--print", "dst"},
             kRaycaster,
             3,
             "lies in 1 loop"},
        Case{"NoSuchLoop", {"loops", "--at", "1"}, kRaycaster, 3, "there are loops at line"},
        Case{"StageNotThere", {"source", "--stage", "geometry"}, kRaycaster, 3, "vertex, fragment"},
        Case{"ThreadOfAnotherStage",
             {"debug", "--stage", "vertex", "--at", "8", "--print", "position", "--pixel", "16,16"},
             kRaycaster,
             2,
             "--vertex N"},
        Case{"FixedFunction", {"debug", "--pixel", "1,1"}, {binary("programs/fixed-function")}, 4, "fixed"},
        Case{"NoSuchFolderForTheImage",
             {"debug", "--at", kInLoop, "--print", "dst", "--image", "/proc/nowhere/dst.png"},
             kRaycaster,
             2,
             "cannot make the directory '/proc/nowhere'"},
        Case{"LoadedAsABinary",
             {"debug", "--pixel", "1,1"},
             {binary("programs/program-binary")},
             4,
             "the program was loaded as a binary: there is no source; switch the program's shader cache off"},
        Case{"SpirV",
             {"debug", "--pixel", "1,1"},
             {binary("programs/spirv")},
             4,
             "the shader is SPIR-V: there is no source"},
        Case{"FrameThatNeverComes",
             {"debug", "--frame", "9", "--pixel", "1,1"},
             {binary("programs/fixed-function")},
             5,
             "'shadestep draws --frames 0..0' lists the draws"},
        Case{"EndsEarly", {"debug", "--pixel", "1,1"}, {binary("programs/no-draw")}, 3, "no draw"}),
    [](const auto& given) { return given.param.name; });

TEST(EndToEnd, ACrashBeforeTheDrawIsSaidAsSuch) {
  const Scratch scratch;
  const Finished finished =
      scratch.shadestep({"debug", "--pixel", "1,1"}, {binary("programs/crash"), "before"});
  expectRefusal(finished, 5, "signal 11");
}

// The loader ignores LD_PRELOAD there: said, with where to find out why, and the program has run as ever.
TEST(EndToEnd, AProgramThatCannotBePreloadedIsSaidAsSuch) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make another user's setuid program";
  const Scratch scratch, programs;
  const std::filesystem::path program = programs.path() / "setuid";
  std::filesystem::copy_file(binary("programs/no-gl"), program);
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(chown(program.c_str(), kNobody, kNobody), 0);
  ASSERT_EQ(chmod(program.c_str(), 04755), 0);
  const Finished debugged = scratch.shadestep({"debug", "--pixel", "1,1"}, {program.string()});
  EXPECT_EQ(debugged.status, 5) << debugged.err;
  EXPECT_EQ(debugged.out, "no OpenGL here\n");
  EXPECT_THAT(debugged.err, HasSubstr("without loading the interceptor; 'shadestep doctor -- "));
  EXPECT_THAT(debugged.err, testing::Not(HasSubstr("before frame")));
  EXPECT_THAT(scratch.shadestep({"doctor"}, {program.string()}).out, HasSubstr("setuid"));
}

TEST(EndToEnd, AProgramOf32BitsIsSaidAsSuch) {
  const Scratch scratch;
  std::ofstream(scratch.file("exits.s"))
      << ".globl _start\n_start: movl $1, %eax\nxorl %ebx, %ebx\nint $0x80\n";
  const Finished made =
      scratch.run({"sh", "-c", "as --32 exits.s -o exits.o && ld -m elf_i386 exits.o -o exits"});
  if (made.status != 0 || scratch.run({"./exits"}).status != 0) GTEST_SKIP() << "no 32-bit programs here";
  const Finished run = scratch.shadestep({"debug", "--pixel", "1,1"}, {"./exits"});
  EXPECT_EQ(run.status, 5);
  EXPECT_NE(run.err.find("'./exits' exited with status 0 without loading the interceptor; 'shadestep doctor"),
            std::string::npos)
      << run.err;
  const Finished doctor = scratch.shadestep({"doctor"}, {"./exits"});
  EXPECT_EQ(doctor.status, 1);
  EXPECT_NE(doctor.out.find("32-bit x86; the interceptor of this build cannot be loaded into it"),
            std::string::npos)
      << doctor.out;
}

TEST(EndToEnd, NoProcessIsLeftBehind) {
  const Scratch scratch;
  // The program, which would run for hours, is found again by a mark in its environment.
  const std::string mark = "SHADESTEP_TEST_MARK=" + scratch.path().filename().string();
  const Finished debugged =
      scratch.shadestep({"debug", "--pixel", "16,16", "--json"},
                        {"env", mark, binary("raycaster"), "--size", "32", "--frames", "1000000"});
  EXPECT_EQ(debugged.status, 0) << debugged.err;
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    EXPECT_EQ(readFile(process.path() / "environ").find(mark), std::string::npos)
        << process.path() << " still runs";
  }
}

}  // namespace
}  // namespace shadestep::test
