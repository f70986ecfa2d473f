#include "launch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

namespace shadestep::test {

namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-,=:+") ==
          std::string::npos &&
      !text.empty()) {
    return text;
  }
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

}  // namespace

Json Finished::json() const {
  Json document = Json::parse(out, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << "no JSON from: " << command << "\nstdout:\n"
                                        << out.substr(0, 2000) << "\nstderr:\n"
                                        << err;
  return document.is_discarded() ? Json::object() : document;
}

Scratch::Scratch() {
  std::string pattern = (fs::temp_directory_path() / "shadestep-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a scratch directory");
  path_ = pattern;
}

Scratch::~Scratch() {
  if (testing::Test::HasFailure()) {
    std::cerr << "files kept in " << path_.string() << "\n";
    return;
  }
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> Scratch::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(".run")) names.push_back(name);
  }
  return names;
}

Finished Scratch::run(const std::vector<std::string>& command) const {
  Finished finished;
  for (const std::string& word : command)
    finished.command += (finished.command.empty() ? "" : " ") + quoted(word);
  const std::string out = file(".run-out");
  const std::string err = file(".run-err");
  const int raw = std::system(
      ("cd " + quoted(path_.string()) + " && " + finished.command + " >" + quoted(out) + " 2>" + quoted(err))
          .c_str());
  finished.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  finished.out = readFile(out);
  finished.err = readFile(err);
  // Seen only when the test fails: how to repeat this very run.
  testing::Test::RecordProperty("command", finished.command);
  return finished;
}

Finished Scratch::shadestep(std::vector<std::string> arguments,
                            const std::vector<std::string>& program) const {
  arguments.insert(arguments.begin(), binary("shadestep"));
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), program.begin(), program.end());
  return run(arguments);
}

Json Scratch::step(std::vector<std::string> arguments, const std::vector<std::string>& program,
                   const std::vector<std::string>& commands) const {
  std::ofstream script(file("commands"));
  for (const std::string& command : commands) script << command << "\n";
  script.close();
  arguments.insert(arguments.begin(), {binary("shadestep"), "step", "--json"});
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), program.begin(), program.end());
  std::string line;
  for (const std::string& word : arguments) line += quoted(word) + " ";
  const Finished run = this->run({"sh", "-c", line + "< commands"});
  EXPECT_EQ(run.status, 0) << run.err;
  Json steps = run.json()["steps"];
  EXPECT_EQ(steps.size(), commands.size() + 1);
  steps.erase(0);
  return steps;
}

std::string place(const Json& answer) {
  std::string text = answer["function"].get<std::string>() + " " + std::to_string(answer["line"].get<int>());
  for (const Json& iteration : answer["iteration"]) text += "[" + iteration.dump() + "]";
  if (answer.contains("returned"))
    text += " after " + std::to_string(answer["returned"]["column"].get<int>());
  if (answer.contains("sides")) text += "?";
  return text;
}

std::string binary(const std::string& name) {
  return std::string(SHADESTEP_TEST_BINARIES) + "/" + name;
}

std::vector<std::string> withoutStorage(const std::string& name) {
  return {"env",
          "MESA_GL_VERSION_OVERRIDE=4.1",
          "MESA_GLSL_VERSION_OVERRIDE=410",
          "MESA_EXTENSION_OVERRIDE=-GL_ARB_shader_storage_buffer_object",
          binary(name),
          "4.1"};
}

std::vector<std::string> underX(std::vector<std::string> command) {
  command.insert(command.begin(), {"xvfb-run", "-a"});
  return command;
}

std::vector<std::string> underWayland(std::vector<std::string> command) {
  command.insert(command.begin(), UNDER_WESTON);
  return command;
}

std::string readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

std::vector<std::vector<std::string>> readCsv(const std::string& path) {
  std::istringstream text(readFile(path));
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(text, line);  // header
  while (std::getline(text, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    std::string cell;
    while (std::getline(row, cell, ',')) cells.push_back(cell);
    rows.push_back(std::move(cells));
  }
  return rows;
}

}  // namespace shadestep::test
