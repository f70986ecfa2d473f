#include "cli/doctor/checks.h"

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "cli/doctor/program_file.h"
#include "cli/doctor/run_command.h"

namespace shadestep::doctor {
namespace {

using Json = nlohmann::json;

constexpr std::chrono::seconds kProbeTimeout{60};

struct ProviderName {
  const char* argument;
  const char* shown;
};
constexpr ProviderName kProviders[] = {{"osmesa", "OSMesa"}, {"egl", "EGL"}, {"glx", "GLX"}};

// A probe's document, or why there is none.
struct Probed {
  Json document;
  std::string failure;
  const Json& context(const char* profile) const { return document["contexts"][profile]; }
};

Probed probeProvider(const std::vector<std::string>& command, const std::string& preload) {
  std::vector<std::pair<std::string, std::string>> environment;
  if (!preload.empty()) environment.emplace_back("LD_PRELOAD", preload);
  const CommandResult result = runCommand(command, environment, kProbeTimeout);
  Probed probed{Json::parse(result.out, nullptr, false), ""};
  if (!result.started)
    probed.failure = "the probe (" + command.front() + ") cannot be started";
  else if (result.timed_out)
    probed.failure = "the driver did not answer within a minute";
  else if (result.status >= 128)
    probed.failure = "the driver crashed (" + std::string(strsignal(result.status - 128)) + ")";
  else if (probed.document.is_discarded())
    probed.failure = "the probe failed with status " + std::to_string(result.status);
  return probed;
}

// "4.5 core, 4.5 compatibility, ES 3.2; llvmpipe (LLVM 15.0.6, 256 bits)"
std::string describeContexts(const Probed& probed) {
  std::string text;
  std::string renderer;
  for (const char* profile : {"core", "compatibility", "es"}) {
    const Json& context = probed.context(profile);
    if (context.contains("error")) continue;
    std::istringstream words(context["version"].get<std::string>());
    std::string word;
    while (words >> word && !std::isdigit(static_cast<unsigned char>(word[0]))) {
    }
    text += (text.empty() ? "" : ", ") + (std::string(profile) == "es" ? "ES " + word : word + " " + profile);
    renderer = context["renderer"];
  }
  return text + "; " + renderer;
}

bool hasContext(const Probed& probed) {
  if (!probed.failure.empty()) return false;
  const Json& contexts = probed.document["contexts"];
  return std::any_of(contexts.begin(), contexts.end(), [](const Json& c) { return !c.contains("error"); });
}

Check checkProvider(const char* name, const Probed& bare) {
  if (!bare.failure.empty()) return {name, false, bare.failure, false};
  if (!hasContext(bare)) return {name, false, bare.context("compatibility")["error"], false};
  return {name, true, describeContexts(bare), false};
}

// Under the interceptor the same contexts must come, and draw calls must pass through it.
Check checkHook(const char* name, const Probed& bare, const Probed& hooked, const std::string& interceptor) {
  Check check{std::string(name) + " hooked", false, "", false};
  if (!hooked.failure.empty()) {
    check.detail = "under the interceptor " + hooked.failure;
    return check;
  }
  for (const char* profile : {"core", "compatibility", "es"}) {
    Json expected = bare.context(profile);
    Json found = hooked.context(profile);
    if (expected.contains("error")) continue;
    const std::string from = found.value("draw_from", "");
    if (std::filesystem::path(from).filename() != std::filesystem::path(interceptor).filename()) {
      check.detail = std::string("the ") + profile + " context's glDrawArrays comes from " +
                     (from.empty() ? "nowhere" : from) + ", not from the interceptor";
      return check;
    }
    for (const char* changing : {"draw_from", "timers"}) {
      expected.erase(changing);
      found.erase(changing);
    }
    if (expected != found) {
      check.detail = std::string("the ") + profile + " context differs from the one without the interceptor";
      return check;
    }
  }
  check.ok = true;
  check.detail = "draw calls pass through the interceptor; versions and extensions are the same as without";
  return check;
}

// What shadestep can make use of, and what for.
struct Feature {
  const char* name;
  std::vector<const char*> extensions;  // one of them is enough
  const char* use;
};
const std::vector<Feature>& features() {
  static const std::vector<Feature> all{
      {"storage buffers", {"GL_ARB_shader_storage_buffer_object"}, "whole runs of a thread from one draw"},
      {"shader clock", {"GL_ARB_shader_clock"}, "profile --method clock"},
      {"bit encoding",
       {"GL_ARB_shader_bit_encoding", "GL_ARB_gpu_shader5"},
       "values bit for bit below GLSL 3.30"},
      {"program interface query", {"GL_ARB_program_interface_query"}, "storage blocks carried over by name"}};
  return all;
}

bool offers(const Probed& probed, const Feature& feature) {
  for (const char* profile : {"core", "compatibility"}) {
    const Json& extensions = probed.context(profile).value("extensions", Json::array());
    for (const char* wanted : feature.extensions)
      if (std::find(extensions.begin(), extensions.end(), wanted) != extensions.end()) return true;
  }
  return false;
}

Check checkFeature(const Feature& feature, const std::map<std::string, Probed>& providers) {
  std::string with;
  for (const auto& [name, probed] : providers)
    if (offers(probed, feature)) with += (with.empty() ? "" : ", ") + name;
  const std::string use = std::string(" (for ") + feature.use + ")";
  return {feature.name, !with.empty(), with.empty() ? "no driver here has it" + use : with + use, false};
}

std::vector<Check> checkTimers(const std::map<std::string, Probed>& providers) {
  for (const auto& [name, probed] : providers) {
    const Json timers = probed.context("core").value("timers", Json::array());
    if (timers.empty()) continue;
    std::vector<Check> checks;
    for (const Json& timer : timers) {
      std::ostringstream detail;
      detail.precision(4);
      const double once = timer["once"];
      const double twice = timer["twice"];
      const double thrice = timer["thrice"];
      if (timer["present"] == true) {
        detail << "one, two, three times the work: ";
        if (timer["name"] == "shader clock")
          detail << once << ", " << twice << ", " << thrice << " ticks";
        else
          detail << once / 1e6 << ", " << twice / 1e6 << ", " << thrice / 1e6 << " ms, "
                 << std::lround(100 * timer["share_of_wall"].get<double>())
                 << " % of what the CPU's clock says";
        detail << " (on " << name << ")"
               << (timer["trusted"] == true ? ""
                   : timer["name"] == "CPU clock"
                       ? ": other load disturbs it, and with it profile --method isolate"
                       : ": not used");
      } else {
        detail << name << " does not have it";
      }
      checks.push_back({"timer " + timer["name"].get<std::string>(), timer["trusted"], detail.str(), false});
    }
    return checks;
  }
  return {};
}

}  // namespace

std::vector<Check> checkMachine(const std::string& interceptor, const std::string& probe) {
  std::vector<Check> checks;
  std::map<std::string, Probed> usable;
  bool any_hooked = false;
  for (const ProviderName& provider : kProviders) {
    const Probed bare =
        probeProvider(usable.empty() ? std::vector<std::string>{probe, provider.argument, "timers"}
                                     : std::vector<std::string>{probe, provider.argument},
                      "");
    checks.push_back(checkProvider(provider.shown, bare));
    if (!hasContext(bare)) continue;
    usable.emplace(provider.shown, bare);
    checks.push_back(
        checkHook(provider.shown, bare, probeProvider({probe, provider.argument}, interceptor), interceptor));
    any_hooked = any_hooked || checks.back().ok;
  }
  checks.push_back({"OpenGL", any_hooked,
                    any_hooked ? "there is an OpenGL that shadestep can debug"
                    : usable.empty()
                        ? "no OpenGL works here; install a driver, e.g. Debian's libosmesa6 and libegl-mesa0"
                        : "OpenGL works here, but not under the interceptor (" + interceptor + ")",
                    true});
  for (const Feature& feature : features()) checks.push_back(checkFeature(feature, usable));
  const std::vector<Check> timers = checkTimers(usable);
  checks.insert(checks.end(), timers.begin(), timers.end());
  checks.push_back(checkPtrace());
  return checks;
}

Check checkPtrace() {
  std::string scope = "unknown";
  std::ifstream("/proc/sys/kernel/yama/ptrace_scope") >> scope;
  const pid_t child = fork();
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
    raise(SIGSTOP);
    _exit(0);
  }
  int status = 0;
  const bool stopped = child > 0 && waitpid(child, &status, 0) == child && WIFSTOPPED(status);
  if (stopped) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  const std::string detail =
      stopped ? "programs started by shadestep can be traced" : "the kernel refuses to trace child processes";
  return {"ptrace", stopped,
          detail + " (yama ptrace_scope: " + scope + "); where it cannot, a crash is told without its thread",
          false};
}

std::vector<Check> checkProgramFile(const std::string& program) {
  const ProgramFile file = inspectProgram(program);
  if (!file.error.empty()) return {{"program", false, file.error, true}};
  if (!file.script.empty())
    return {{"program", true,
             file.path + " is a script for " + file.script + "; what it starts is hooked too", true}};
  std::vector<Check> checks;
  checks.push_back({"program", file.native,
                    file.path + ": " + std::to_string(file.bits) + "-bit " + file.machine +
                        (file.native ? "" : "; the interceptor of this build cannot be loaded into it"),
                    true});
  checks.push_back(
      {"program loading", file.dynamic && !file.privileged,
       !file.dynamic     ? "statically linked: no library can be preloaded; build it as a dynamic executable"
       : file.privileged ? "setuid, setgid or with file capabilities: the loader ignores preloaded "
                           "libraries; run a copy without these"
                         : "dynamically linked, not privileged: a library can be preloaded",
       true});
  const std::vector<std::string> gl = glLibraries(file.libraries);
  std::string names;
  for (const std::string& name : gl) names += (names.empty() ? "" : ", ") + name;
  checks.push_back(
      {"program libraries", true,
       gl.empty() ? "no OpenGL library is linked; if it draws with OpenGL, it loads it while running" : names,
       false});
  return checks;
}

}  // namespace shadestep::doctor
