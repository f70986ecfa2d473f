// The file checks of `shadestep doctor`, on copies of this very test with what matters changed in them.
#include <elf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "cli/doctor/checks.h"
#include "cli/doctor/program_file.h"
#include "cli/doctor/run_command.h"

namespace shadestep::doctor {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Program : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "shadestep-doctor-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
    copy_ = (directory_ / "copy").string();
    fs::copy_file(fs::read_symlink("/proc/self/exe"), copy_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  // Overwrites part of the copy.
  template <class T>
  void patch(std::size_t offset, const T& value) {
    std::fstream file(copy_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset));
    file.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  T read(std::size_t offset) {
    std::ifstream file(copy_, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    T value{};
    file.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }

  fs::path directory_;
  std::string copy_;
};

TEST_F(Program, an_ordinary_one_can_be_hooked) {
  const ProgramFile file = inspectProgram(copy_);
  EXPECT_EQ(file.error, "");
  EXPECT_EQ(file.bits, 64);
  EXPECT_TRUE(file.native);
  EXPECT_TRUE(file.dynamic);
  EXPECT_FALSE(file.privileged);
  EXPECT_THAT(file.libraries, testing::Contains("libc.so.6"));
  for (const Check& check : checkProgramFile(copy_))
    EXPECT_TRUE(check.ok) << check.name << ": " << check.detail;
}

TEST_F(Program, without_a_loader_is_static) {
  const auto header = read<Elf64_Ehdr>(0);
  bool found = false;
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    const std::size_t offset = header.e_phoff + i * header.e_phentsize;
    if (read<Elf64_Phdr>(offset).p_type != PT_INTERP) continue;
    found = true;
    patch(offset + offsetof(Elf64_Phdr, p_type), Elf64_Word{PT_NULL});
  }
  ASSERT_TRUE(found);
  EXPECT_FALSE(inspectProgram(copy_).dynamic);
  EXPECT_THAT(checkProgramFile(copy_)[1].detail, testing::HasSubstr("statically linked"));
  EXPECT_FALSE(checkProgramFile(copy_)[1].ok);
}

TEST_F(Program, of_32_bits_or_another_machine_is_not_native) {
  patch(offsetof(Elf64_Ehdr, e_machine), Elf64_Half{EM_RISCV});
  EXPECT_FALSE(inspectProgram(copy_).native);
  EXPECT_EQ(inspectProgram(copy_).machine, "RISC-V");
  patch(EI_CLASS, static_cast<unsigned char>(ELFCLASS32));
  EXPECT_EQ(inspectProgram(copy_).bits, 32);
  EXPECT_FALSE(checkProgramFile(copy_)[0].ok);
}

TEST_F(Program, that_is_setuid_is_refused) {
  chmod(copy_.c_str(), 04755);
  EXPECT_TRUE(inspectProgram(copy_).privileged);
  EXPECT_FALSE(checkProgramFile(copy_)[1].ok);
}

TEST_F(Program, that_is_a_script_names_its_interpreter) {
  std::ofstream(copy_, std::ios::trunc) << "#! /bin/sh -e\n";
  EXPECT_EQ(inspectProgram(copy_).script, "/bin/sh -e");
}

TEST_F(Program, that_is_none_is_said) {
  EXPECT_THAT(inspectProgram("/no/such/program").error, testing::HasSubstr("no program '/no/such/program'"));
  EXPECT_THAT(inspectProgram("no-such-program-anywhere").error, testing::HasSubstr("in PATH"));
  EXPECT_THAT(inspectProgram(directory_.string()).error, testing::HasSubstr("no executable file"));
  std::ofstream(copy_, std::ios::trunc) << "text\n";
  EXPECT_THAT(inspectProgram(copy_).error, testing::HasSubstr("neither"));
}

TEST(GlLibraries, are_found_among_others) {
  EXPECT_THAT(glLibraries({"libc.so.6", "libGL.so.1", "libGLib.so", "libSDL2-2.0.so.0", "libm.so.6"}),
              testing::ElementsAre("libGL.so.1", "libSDL2-2.0.so.0"));
}

TEST(RunCommand, gives_output_status_and_environment) {
  const CommandResult result =
      runCommand({"/bin/sh", "-c", "echo $SHADESTEP_TEST; exit 3"}, {{"SHADESTEP_TEST", "x"}}, 10s);
  EXPECT_EQ(result.out, "x\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(runCommand({"/bin/sh", "-c", "kill -SEGV $$"}, {}, 10s).status, 128 + 11);
  EXPECT_FALSE(runCommand({"/no/such/program"}, {}, 10s).started);
}

TEST(RunCommand, ends_what_does_not_end) {
  const CommandResult result = runCommand({"/bin/sh", "-c", "exec sleep 100"}, {}, 0s);
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.status, 128 + 9);
}

TEST(CheckPtrace, names_the_kernel_s_setting) {
  EXPECT_THAT(checkPtrace().detail, testing::HasSubstr("ptrace_scope"));
}

}  // namespace
}  // namespace shadestep::doctor
