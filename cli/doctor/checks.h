// What works on this machine, and with a given program: the checks behind `shadestep doctor`.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace shadestep::doctor {

struct Check {
  std::string name;  // "OSMesa", "timer GL_TIME_ELAPSED", "program libraries"
  bool ok = false;
  std::string detail;      // one line: what was found, or what to do
  bool essential = false;  // nothing can be debugged while this fails
};

// Drivers and their extensions, hooking, timers, ptrace. `interceptor`: path of libshadestep-gl.so, `probe`:
// of shadestep-doctor-probe. Takes some seconds.
std::vector<Check> checkMachine(const std::string& interceptor, const std::string& probe);

// What can be told from the program's file alone, without running it.
std::vector<Check> checkProgramFile(const std::string& program);

// Tracing of child processes: allowed by the kernel or not.
Check checkPtrace();

}  // namespace shadestep::doctor
