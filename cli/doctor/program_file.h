// Facts about the file of a program that decide whether a library can be preloaded into it.
#pragma once

#include <string>
#include <vector>

namespace shadestep::doctor {

struct ProgramFile {
  std::string path;         // after a search through PATH; empty if there is no such program
  std::string error;        // why nothing more is known: one sentence; empty if the rest holds
  std::string script;       // the interpreter's line if it is a script; then only the interpreter matters
  int bits = 0;             // 64 or 32
  std::string machine;      // "x86-64", "AArch64", ... or "machine N"
  bool native = false;      // the same class and machine as this executable
  bool dynamic = false;     // has a dynamic loader; LD_PRELOAD works only then
  bool privileged = false;  // setuid, setgid or file capabilities: the loader ignores LD_PRELOAD
  std::vector<std::string> libraries;  // all that the loader would map, by soname
};

// Looks at the file as execvp would find it. The program is not run; for the libraries its dynamic loader is,
// with --list.
ProgramFile inspectProgram(const std::string& program);

// Those of `libraries` that are OpenGL or get at it at run time (libGL, libEGL, libOSMesa, libepoxy, SDL,
// GLFW, Qt, ...).
std::vector<std::string> glLibraries(const std::vector<std::string>& libraries);

}  // namespace shadestep::doctor
