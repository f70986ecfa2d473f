// Runs a command as a user would, in a directory of its own that is kept when the test fails.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace shadestep::test {

using Json = nlohmann::json;

struct Finished {
  int status = -1;  // exit status, or 128 + signal
  std::string out, err;
  std::string command;  // as a shell repeats it
  Json json() const;    // stdout as one JSON document; fails the test if it is none
};

// A scratch directory; removed at the end unless the current test failed, when its path is printed.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }
  // Names of the files in it.
  std::vector<std::string> files() const;

  // Runs the command with this as working directory; a failing test prints the command that repeats it.
  Finished run(const std::vector<std::string>& command) const;
  // `shadestep ARGUMENTS... -- PROGRAM...`
  Finished shadestep(std::vector<std::string> arguments, const std::vector<std::string>& program) const;
  // `shadestep step --json ARGUMENTS...` with these commands: its answers to them, without the first one,
  // which says where it began.
  Json step(std::vector<std::string> arguments, const std::vector<std::string>& program,
            const std::vector<std::string>& commands) const;

 private:
  std::filesystem::path path_;
};

// Of an answer of `step`: "main 12[0] after 31?", the function, line and iterations, the column of the call
// that has returned, and a question mark at a branch.
std::string place(const Json& answer);

// An executable of this build.
std::string binary(const std::string& name);
// A program of this build in a context of OpenGL 4.1 without storage buffers, which it is told by its
// argument.
std::vector<std::string> withoutStorage(const std::string& name);
// The command prefixed so that it has an X server of its own.
std::vector<std::string> underX(std::vector<std::string> command);
// The same with a Wayland server; ends with 77 where there is none.
std::vector<std::string> underWayland(std::vector<std::string> command);

std::string readFile(const std::string& path);
// Rows of comma-separated cells, the header left out.
std::vector<std::vector<std::string>> readCsv(const std::string& path);

}  // namespace shadestep::test
