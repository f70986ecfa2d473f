#include "cli/doctor/program_file.h"

#include <elf.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/doctor/run_command.h"

namespace shadestep::doctor {
namespace {

std::string findProgram(const std::string& program) {
  if (program.find('/') != std::string::npos) return access(program.c_str(), F_OK) == 0 ? program : "";
  const char* path = std::getenv("PATH");
  std::istringstream directories(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string directory; std::getline(directories, directory, ':');) {
    const std::string candidate = (directory.empty() ? "." : directory) + "/" + program;
    if (access(candidate.c_str(), X_OK) == 0 && !std::filesystem::is_directory(candidate)) return candidate;
  }
  return "";
}

std::string machineName(int machine) {
  switch (machine) {
    case EM_X86_64:
      return "x86-64";
    case EM_386:
      return "x86";
    case EM_AARCH64:
      return "AArch64";
    case EM_ARM:
      return "ARM";
    case EM_RISCV:
      return "RISC-V";
    default:
      return "machine " + std::to_string(machine);
  }
}

template <class T>
bool readAt(std::ifstream& file, std::uint64_t offset, T& value) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(offset));
  return static_cast<bool>(file.read(reinterpret_cast<char*>(&value), sizeof value));
}

// The path of the dynamic loader (PT_INTERP); empty for static programs.
template <class Header, class Segment>
std::string loaderOf(std::ifstream& file) {
  Header header{};
  if (!readAt(file, 0, header)) return "";
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    Segment segment{};
    if (!readAt(file, header.e_phoff + i * header.e_phentsize, segment)) return "";
    if (segment.p_type != PT_INTERP || segment.p_filesz > 4096) continue;
    std::string loader(segment.p_filesz, '\0');
    file.clear();
    file.seekg(static_cast<std::streamoff>(segment.p_offset));
    file.read(loader.data(), static_cast<std::streamsize>(loader.size()));
    return loader.c_str();  // up to the first NUL
  }
  return "";
}

// The first word of each line of the loader's list: "	libGL.so.1 => /usr/lib/... (0x...)".
std::vector<std::string> libraryNames(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    if (words >> name && name.find(".so") != std::string::npos)
      names.push_back(std::filesystem::path(name).filename());
  }
  return names;
}

int ownMachine() {
  std::ifstream self("/proc/self/exe", std::ios::binary);
  Elf64_Ehdr header{};
  return readAt(self, 0, header) ? header.e_machine : -1;
}

void inspectElf(std::ifstream& file, ProgramFile& facts) {
  Elf64_Ehdr header{};  // both classes begin alike up to e_machine
  readAt(file, 0, header);
  facts.bits = header.e_ident[EI_CLASS] == ELFCLASS64 ? 64 : 32;
  facts.machine = machineName(header.e_machine);
  facts.native = facts.bits == 64 && header.e_machine == ownMachine();
  const std::string loader =
      facts.bits == 64 ? loaderOf<Elf64_Ehdr, Elf64_Phdr>(file) : loaderOf<Elf32_Ehdr, Elf32_Phdr>(file);
  facts.dynamic = !loader.empty();
  if (facts.dynamic && facts.native)
    facts.libraries = libraryNames(
        runCommand({loader, "--list", std::filesystem::absolute(facts.path)}, {}, std::chrono::seconds(10))
            .out);
}

}  // namespace

ProgramFile inspectProgram(const std::string& program) {
  ProgramFile facts;
  facts.path = findProgram(program);
  if (facts.path.empty()) {
    facts.error =
        "there is no program '" + program + "'" + (program.find('/') == std::string::npos ? " in PATH" : "");
    return facts;
  }
  struct stat status {};
  std::ifstream file(facts.path, std::ios::binary);
  std::array<char, 4> magic{};
  if (stat(facts.path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) ||
      access(facts.path.c_str(), X_OK) != 0) {
    facts.error = "'" + facts.path + "' is no executable file";
    return facts;
  }
  facts.privileged = (status.st_mode & (S_ISUID | S_ISGID)) != 0 ||
                     getxattr(facts.path.c_str(), "security.capability", nullptr, 0) > 0;
  file.read(magic.data(), magic.size());
  if (magic[0] == '#' && magic[1] == '!') {
    file.clear();
    file.seekg(2);
    std::getline(file, facts.script);
    facts.script.erase(0, facts.script.find_first_not_of(" \t"));
  } else if (std::memcmp(magic.data(), ELFMAG, SELFMAG) == 0) {
    inspectElf(file, facts);
  } else {
    facts.error = "'" + facts.path + "' is neither an ELF executable nor a script";
  }
  return facts;
}

std::vector<std::string> glLibraries(const std::vector<std::string>& libraries) {
  static constexpr const char* beginnings[] = {
      "libGL.",   "libGLX.",  "libOpenGL.", "libEGL.", "libGLESv",   "libOSMesa",  "libepoxy.", "libGLEW.",
      "libglfw.", "libSDL2-", "libSDL-",    "libSDL3", "libQt5Gui.", "libQt6Gui.", "libglut."};
  std::vector<std::string> found;
  for (const std::string& library : libraries)
    if (std::any_of(std::begin(beginnings), std::end(beginnings),
                    [&](const char* beginning) { return library.starts_with(beginning); }))
      found.push_back(library);
  return found;
}

}  // namespace shadestep::doctor
