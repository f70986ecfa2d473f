// shadestep profile: what each thread of a fragment shader costs.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "cli/common.h"
#include "cli/progress.h"
#include "profiler/pictures/ticks.h"
#include "profiler/profile_files.h"

namespace shadestep::cli {
namespace {

struct Options {
  std::string method = "auto";
  std::string roi;
  std::string error;
  std::string compare;
  double budget = 12;
  int passes = 5;
  bool no_lines = false;
};

profiler::ProfileOptions profileOptions(const Options& options) {
  profiler::ProfileOptions result;
  result.budget = options.budget;
  result.passes = options.passes;
  result.lines = !options.no_lines;
  if (!options.roi.empty()) {
    const std::vector<int> roi = parseIntegers(options.roi, "--roi", 4, 4);
    if (roi[2] < 1 || roi[3] < 1) {
      throw session::Error(
          session::Outcome::usage,
          "--roi takes X,Y,WIDTH,HEIGHT with a width and height of at least 1, not '" + options.roi + "'");
    }
    result.roi = profiler::Region{roi[0], roi[1], roi[2], roi[3]};
  }
  return result;
}

profiler::Profile measure(session::Session& session, const std::string& method,
                          const profiler::ProfileOptions& options) {
  if (method == "count") return profiler::profileCount(session, options);
  if (method == "clock") return profiler::profileClock(session, options);
  if (method == "isolate") return profiler::profileIsolate(session, options);
  return profiler::profileAuto(session, options);
}

// "raycaster, frame 0, draw 0, on llvmpipe (...)"
std::string subject(session::Session& session, const Common& common) {
  return std::filesystem::path(common.program.front()).filename().string() + ", frame " +
         std::to_string(session.stop().frame) + ", draw " + std::to_string(session.stop().draw) +
         ", fragment shader, on " + session.facts().renderer;
}

// The costliest lines, most first.
void printLines(const profiler::Profile& profile, const frontend::Shader& shader) {
  std::vector<profiler::LineCost> lines = profile.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.hits > b.hits; });
  if (lines.size() > 12) lines.resize(12);
  if (lines.empty()) return;
  std::printf("\n  line          hits   share  source\n");
  for (const profiler::LineCost& line : lines) {
    const std::string share = line.share ? profiler::readable(100 * *line.share, 3) + " %" : "";
    const auto index = static_cast<std::size_t>(line.line) - 1;
    std::printf("  %4d  %12s  %6s  %s\n", line.line, withThousands(line.hits).c_str(), share.c_str(),
                index < shader.lines.size() ? shader.lines[index].c_str() : "");
  }
}

void printText(const profiler::Profile& profile, const profiler::ProfileFiles& files,
               const frontend::Shader& shader) {
  const auto cost = [&](double value) {
    const profiler::ScaledUnit unit = profiler::scaledUnit(profile.unit, value);
    return profiler::readable(value * unit.factor) + " " + unit.name;
  };
  std::printf("%s: %s of %s covered pixels measured, %d time%s each, in %s s\n", methodName(profile.method),
              withThousands(profile.measured).c_str(), withThousands(profile.covered).c_str(), profile.passes,
              profile.passes == 1 ? "" : "s", profiler::readable(profile.seconds, 3).c_str());
  std::printf("per pixel: median %s, 95 %% below %s; spread of repeats %s %%\n", cost(profile.median).c_str(),
              cost(profile.p95).c_str(), profiler::readable(100 * profile.spread, 2).c_str());
  if (profile.reconstruction)
    std::printf("the rest reconstructed: median error %s %% on %zu held-out pixels\n",
                profiler::readable(100 * profile.reconstruction->error, 2).c_str(),
                profile.reconstruction->held_out);
  std::cout << describe(profile.check) << "\n";
  for (const std::string& note : profile.notes) std::cout << "note: " << note << "\n";
  std::fflush(stdout);
  printLines(profile, shader);
  std::printf("\nwrote %s, %s, %s\n", files.heat_png.c_str(), files.heat_exr.c_str(),
              files.profile_json.c_str());
}

int run(const Common& common, const Options& options) {
  if (!options.compare.empty() || !options.error.empty()) {
    throw session::Error(session::Outcome::usage,
                         std::string(options.compare.empty() ? "--error" : "--compare") +
                             " is not in this version; profile both programs and compare their heat.exr");
  }
  profiler::ProfileOptions how = profileOptions(options);
  const profiler::ProfileFiles files{common.inOut("heat.png"), common.inOut("heat.exr"),
                                     common.inOut("profile.json")};
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  session.requireCapturable();

  profiler::Profile profile;
  {
    ProgressBar bar("profiling", common.quiet);
    how.progress = [&bar](double share) { bar.update(share); };
    profile = measure(session, options.method, how);
  }
  profiler::writeProfile(profile, files, subject(session, common));
  if (common.json) {
    print(profiler::toJson(profile, files));
  } else {
    printText(profile, files, session.shader(session::Stage::fragment));
  }
  return profile.check.compared_at_all && !profile.check.identical()
             ? static_cast<int>(session::Outcome::failed)
             : 0;
}

}  // namespace

void addProfile(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("profile", "what each thread costs; writes heat.png, heat.exr, profile.json");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command
      ->add_option(
          "--method", options->method,
          "count: statements executed; clock: the driver's shader clock; isolate: one pixel's thread "
          "alone, on the CPU's clock; auto: clock, else isolate, else count")
      ->check(CLI::IsMember({"auto", "clock", "isolate", "count"}));
  command->add_option("--roi", options->roi, "only these pixels: lower left corner and size")
      ->type_name("X,Y,W,H");
  command->add_option("--budget", options->budget, "isolate: seconds to measure; decides how many pixels")
      ->type_name("S")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--passes", options->passes, "clock: draws, of which the median counts")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--no-lines", options->no_lines, "do not count executions per line");
  command->add_option("--error", options->error, "not in this version")->type_name("P%");
  command->add_option("--compare", options->compare, "not in this version")->type_name("FILE");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
