// shadestep doctor: what works on this machine, and why hooking a program fails.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "cli/common.h"
#include "cli/doctor/checks.h"

namespace shadestep::cli {
namespace {

using doctor::Check;

constexpr std::chrono::seconds kFirstDrawTimeout{20};

std::string besideThisExecutable(const std::string& name) {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
}

// Runs the program to its first draw: does the interceptor see it, and can it be debugged?
std::vector<Check> checkProgramRun(const Common& common) {
  session::LaunchOptions launch = common.launchOptions();
  launch.program_output_to_stderr = true;  // our stdout is the report
  if (common.timeout == 0) launch.timeout = kFirstDrawTimeout;
  std::vector<Check> checks;
  try {
    session::Session session(launch);
    checks.push_back({"program hooked", true, "the interceptor was loaded into it", true});
    const session::DrawStop stop = session.runTo(common.frame, common.draw);
    const session::DrawFacts& facts = session.facts();
    checks.push_back(
        {"program draws", true,
         stop.call + " on " + facts.provider + ", OpenGL " + facts.version + ", " + facts.renderer, true});
    session.shader(session::Stage::fragment);
    session.requireCapturable();
    checks.push_back(
        {"program debuggable", true, "the fragment shader of its first draw can be debugged", false});
  } catch (const session::Error& error) {
    static constexpr const char* names[] = {"program hooked", "program draws", "program debuggable"};
    checks.push_back(
        {names[std::min<std::size_t>(checks.size(), 2)], false, error.what(), checks.size() < 2});
  }
  return checks;
}

int run(const Common& common) {
  std::vector<Check> checks;
  const std::string interceptor = session::findInterceptor();
  checks = doctor::checkMachine(interceptor, besideThisExecutable("shadestep-doctor-probe"));
  if (!common.program.empty()) {
    const std::vector<Check> file = doctor::checkProgramFile(common.program.front());
    checks.insert(checks.end(), file.begin(), file.end());
    if (std::all_of(file.begin(), file.end(),
                    [](const Check& check) { return check.ok || !check.essential; })) {
      const std::vector<Check> whole = checkProgramRun(common);
      checks.insert(checks.end(), whole.begin(), whole.end());
    }
  }
  if (common.json) {
    Json list = Json::array();
    for (const Check& check : checks)
      list.push_back({{"name", check.name}, {"ok", check.ok}, {"detail", check.detail}});
    print({{"checks", list}});
  } else {
    for (const Check& check : checks) {
      std::string name = check.name;
      name.resize(std::max<std::size_t>(name.size(), 24), ' ');
      std::cout << (check.ok          ? "ok    "
                    : check.essential ? "FAIL  "
                                      : "no    ")
                << name << "  " << check.detail << "\n";
    }
  }
  const bool works = std::all_of(checks.begin(), checks.end(),
                                 [](const Check& check) { return check.ok || !check.essential; });
  return static_cast<int>(works ? session::Outcome::done : session::Outcome::failed);
}

}  // namespace

void addDoctor(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand(
      "doctor", "what works on this machine; given a program, why it can or cannot be debugged");
  addCommonOptions(*command, common);
  command->callback([&common, &action] { action = [&common] { return run(common); }; });
}

}  // namespace shadestep::cli
