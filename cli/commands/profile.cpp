// shadestep profile: what each thread of a fragment shader costs.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <optional>

#include "cli/common.h"
#include "cli/interruption.h"
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
  std::string csv;
  std::optional<double> budget;
  int passes = 6;
  bool no_lines = false;
  std::optional<double> share;
  std::optional<int> fragments;
  int repeats = 5;
  bool textures = false;
  bool neighbours = false;
  bool per_iteration = false;
};

// "5%" or "5": five in a hundred.
double parsePercent(std::string text) {
  const std::string given = text;
  if (!text.empty() && text.back() == '%') text.pop_back();
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc() || end != text.data() + text.size() || !(value > 0) || value > 100)
    throw session::Error(session::Outcome::usage,
                         "--error takes a percentage above 0, such as 5%, not '" + given + "'");
  return value / 100;
}

profiler::ProfileOptions profileOptions(const Options& options) {
  constexpr double kUsualBudget = 12;
  profiler::ProfileOptions result;
  if (!options.error.empty()) result.error = parsePercent(options.error);
  result.budget =
      options.budget.value_or(result.error ? std::numeric_limits<double>::infinity() : kUsualBudget);
  result.passes = options.passes;
  result.lines = !options.no_lines;
  result.share = options.share;
  result.size = options.fragments;
  result.repeats = options.repeats;
  result.textures = options.textures;
  result.neighbours = options.neighbours;
  result.stop = [] { return InterruptibleSession::noted(); };
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

// The costliest lines, most first.
void printLines(const profiler::Profile& profile, const std::vector<std::string>& source) {
  std::vector<profiler::LineCost> lines = profile.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
    return std::pair(a.share.value_or(0), a.hits) > std::pair(b.share.value_or(0), b.hits);
  });
  if (lines.size() > 12) lines.resize(12);
  if (lines.empty()) return;
  std::printf("\n  line          hits   share  source\n");
  for (const profiler::LineCost& line : lines) {
    const std::string share = line.share ? profiler::readable(100 * *line.share, 3) + " %" : "";
    const auto index = static_cast<std::size_t>(line.line) - 1;
    std::printf("  %4d  %12s  %6s  %s\n", line.line, withThousands(line.hits).c_str(), share.c_str(),
                index < source.size() ? source[index].c_str() : "");
  }
}

void printComparison(const profiler::Comparison& comparison, const std::vector<std::string>& source) {
  const auto percent = [](double share) { return profiler::readable(100 * share, 3) + " %"; };
  std::printf("\nagainst %s: %s%s in all, noise %s: %s\n", comparison.file.c_str(),
              comparison.change > 0 ? "+" : "", percent(comparison.change).c_str(),
              percent(comparison.noise).c_str(), profiler::verdictName(comparison.verdict));
  std::printf("of %s pixels in both, %s are cheaper and %s dearer beyond the noise\n",
              withThousands(comparison.compared).c_str(), withThousands(comparison.cheaper).c_str(),
              withThousands(comparison.dearer).c_str());
  for (const profiler::Comparison::Loop& loop : comparison.loops)
    std::printf("loop at line %d: %s iterations before, %s now\n", loop.line,
                withThousands(loop.iterations_before).c_str(), withThousands(loop.iterations).c_str());
  std::vector<profiler::Comparison::Line> lines = comparison.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
    return std::abs(a.cost - a.cost_before) > std::abs(b.cost - b.cost_before);
  });
  if (lines.size() > 8) lines.resize(8);
  if (lines.empty()) return;
  std::printf("\n  line   hits before      hits now   change of cost  source\n");
  for (const profiler::Comparison::Line& line : lines) {
    const auto index = static_cast<std::size_t>(line.line) - 1;
    const std::string change =
        comparison.before > 0 ? percent((line.cost - line.cost_before) / comparison.before) : "";
    std::printf("  %4d  %12s  %12s  %15s  %s\n", line.line != 0 ? line.line : line.line_before,
                withThousands(line.hits_before).c_str(), withThousands(line.hits).c_str(), change.c_str(),
                line.line != 0 && index < source.size() ? source[index].c_str() : "(no longer there)");
  }
}

void printNeighbours(const profiler::NeighbourCost& paid, const std::string& unit) {
  std::printf("paid for neighbours: %s %% of all %s\n", profiler::readable(100 * paid.share, 3).c_str(),
              unit.c_str());
  const auto agreement = [](const char* methods, const profiler::RankAgreement& ranks) {
    std::printf("  %s %s, of at most %s that their noise lets be seen\n", methods,
                profiler::readable(ranks.rho, 3).c_str(), profiler::readable(ranks.most, 3).c_str());
  };
  const auto agreements = [&](const profiler::NeighbourCost::Agreement& of, const char* which) {
    if (of.clock_isolate.pixels < 2) return;
    std::printf("ranks of the %s groups %s (Spearman):\n", withThousands(of.clock_isolate.pixels).c_str(),
                which);
    agreement("clock and isolate", of.clock_isolate);
    agreement("clock and count  ", of.clock_count);
    agreement("isolate and count", of.isolate_count);
  };
  agreements(paid.all, "by the dearest thread of each");
  agreements(paid.same, "in which all threads do the same");
}

void printText(const profiler::Profile& profile, const std::vector<std::string>& source) {
  const auto cost = [&](double value) {
    const profiler::ScaledUnit unit = profiler::scaledUnit(profile.unit, value);
    return profiler::readable(value * unit.factor) + " " + unit.name;
  };
  const bool fragments = profile.stage == session::Stage::fragment;
  std::printf("%s: %s of %s %s measured, %d time%s each, in %s s\n", methodName(profile.method),
              withThousands(profile.measured).c_str(), withThousands(profile.covered).c_str(),
              fragments ? "covered pixels" : "threads", profile.passes, profile.passes == 1 ? "" : "s",
              profiler::readable(profile.seconds, 3).c_str());
  std::printf("per %s: median %s, 95 %% below %s; reproducible to %s %%\n", fragments ? "pixel" : "thread",
              cost(profile.median).c_str(), cost(profile.p95).c_str(),
              profiler::readable(100 * profile.spread, 2).c_str());
  if (profile.reconstruction)
    std::printf(
        "the rest reconstructed: error %s %% (root mean square), with 95 %% confidence below %s %%, by %zu "
        "held-out pixels\n",
        profiler::readable(100 * profile.reconstruction->error, 2).c_str(),
        profiler::readable(100 * profile.reconstruction->error_below, 2).c_str(),
        profile.reconstruction->held_out);
  if (profile.neighbours) printNeighbours(*profile.neighbours, profile.unit);
  std::cout << describe(profile.check) << "\n";
  for (const std::string& note : profile.notes) std::cout << "note: " << note << "\n";
  std::fflush(stdout);
  printLines(profile, source);
  if (profile.fit)
    std::printf("\n  shares by a fit of costs to counts: R2 %s\n",
                profiler::readable(profile.fit->r2, 3).c_str());
}

// How much of the device is in use behind each condition.
void printBranches(const profiler::Profile& profile) {
  if (profile.branches.empty()) return;
  // Threads that are alone in their group never wait.
  const bool groups = !(profile.grain == profiler::Grain{});
  std::printf("\n  line     evaluated         taken");
  if (groups)
    std::printf("  lanes active there, and behind it (groups of %d x %d)", profile.grain.width,
                profile.grain.height);
  std::printf("\n");
  for (const profiler::BranchCost& branch : profile.branches) {
    std::printf("  %4d  %12s  %12s  ", branch.line, withThousands(branch.evaluated).c_str(),
                withThousands(branch.taken).c_str());
    if (groups)
      std::printf("%s %%, %s %%  ", profiler::readable(100 * branch.active_share, 3).c_str(),
                  profiler::readable(100 * branch.taken_share, 3).c_str());
    std::printf("%s\n", branch.kind.c_str());
  }
}

void printTextures(const profiler::TextureAccesses& accesses) {
  std::printf("\n  line       lookups       outside  of the texture\n");
  for (const profiler::LookupReads& lookup : accesses.lookups) {
    std::printf("  %4d  %12s  %12s  %s(%s, ...)%s\n", lookup.line, withThousands(lookup.lookups).c_str(),
                withThousands(lookup.outside).c_str(), lookup.function.c_str(), lookup.sampler.c_str(),
                lookup.reason.empty() ? "" : (": not counted, " + lookup.reason).c_str());
    if (lookup.undefined > 0)
      std::printf("        %12s  of them with a coordinate that is NaN or infinite\n",
                  withThousands(lookup.undefined).c_str());
  }
  std::printf("\n  level               texels         reads    used  sampler\n");
  for (const profiler::TextureReads& texture : accesses.textures) {
    if (!texture.reason.empty())
      std::printf("  %45s  %s: %s\n", "", texture.sampler.c_str(), texture.reason.c_str());
    for (const profiler::TextureLevelReads& level : texture.levels) {
      if (level.total == 0) continue;
      std::string size = std::to_string(level.width) + " x " + std::to_string(level.height);
      if (level.depth > 1) size += " x " + std::to_string(level.depth);
      std::printf("  %5d  %19s  %12s  %4s %%  %s\n", level.level, size.c_str(),
                  withThousands(level.total).c_str(), profiler::readable(100 * level.used, 3).c_str(),
                  texture.sampler.c_str());
    }
  }
  for (const std::string& note : accesses.notes) std::printf("  %s\n", note.c_str());
}

void printFiles(const profiler::ProfileFiles& files, const profiler::Profile& profile, bool compared,
                double seconds) {
  std::printf("\nwrote %s, %s, %s, %s, %s", files.report_html.c_str(), files.heat_png.c_str(),
              files.heat_exr.c_str(), files.height_png.c_str(), files.profile_json.c_str());
  if (compared) std::printf(", %s, %s", files.difference_png.c_str(), files.difference_exr.c_str());
  if (profile.neighbours) std::printf(", %s, %s", files.neighbours_png.c_str(), files.neighbours_exr.c_str());
  if (!files.threads_csv.empty()) std::printf(", %s", files.threads_csv.c_str());
  if (!files.per_iteration_png.empty())
    std::printf(", %s, %s", files.per_iteration_png.c_str(), files.per_iteration_exr.c_str());
  if (profile.textures) std::printf(", %s*.png, %s*.exr", files.texture.c_str(), files.texture.c_str());
  std::printf(" in %s s\n", profiler::readable(seconds, 2).c_str());
}

profiler::ProfileFiles filesIn(const Common& common) {
  profiler::ProfileFiles files;
  files.heat_png = common.inOut("heat.png");
  files.heat_exr = common.inOut("heat.exr");
  files.height_png = common.inOut("height.png");
  files.profile_json = common.inOut("profile.json");
  files.report_html = common.inOut("report.html");
  files.difference_png = common.inOut("difference.png");
  files.difference_exr = common.inOut("difference.exr");
  files.neighbours_png = common.inOut("neighbours.png");
  files.neighbours_exr = common.inOut("neighbours.exr");
  files.texture = common.inOut("texture-");
  return files;
}

void requireLoop(const frontend::Shader& shader) {
  using frontend::StatementKind;
  const bool any = std::any_of(shader.statements.begin(), shader.statements.end(), [](const auto& statement) {
    return statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
           statement.kind == StatementKind::do_while;
  });
  if (!any)
    throw session::Error(session::Outcome::nothing_matches,
                         "--per-iteration needs a loop, and the shader has none");
}

// The shader's lines; none where it has no source.
std::vector<std::string> sourceOf(session::Session& session) {
  try {
    return session.shader().lines;
  } catch (const session::Error& error) {
    if (error.outcome() != session::Outcome::cannot_debug &&
        error.outcome() != session::Outcome::nothing_matches)
      throw;
    return {};
  }
}

int run(const Common& common, const Options& options) {
  profiler::ProfileOptions how = profileOptions(options);
  std::optional<profiler::Earlier> earlier;
  if (!options.compare.empty()) earlier = profiler::readEarlier(options.compare);
  profiler::ProfileFiles files = filesIn(common);
  if (options.per_iteration) {
    if (options.no_lines)
      throw session::Error(session::Outcome::usage,
                           "--per-iteration needs what --no-lines leaves out; give one of them");
    files.per_iteration_png = common.inOut("per-iteration.png");
    files.per_iteration_exr = common.inOut("per-iteration.exr");
  }
  InterruptibleSession interruptible(common.launchOptions());
  session::Session& session = interruptible.session();
  runToDraw(session, common);
  // What has no source is not refused: its draw can be timed.
  if (options.method != "auto" && options.method != "tiles") session.requireCapturable();
  if (options.per_iteration) requireLoop(session.shader());
  // Who the threads of other stages are, no picture tells.
  if (!options.csv.empty() || session.stage() != session::Stage::fragment)
    files.threads_csv = common.inOut(options.csv.empty() ? "threads.csv" : options.csv);
  interruptible.on(InterruptibleSession::Action::note);

  profiler::Profile profile;
  {
    ProgressBar bar("profiling", common.quiet);
    how.progress = [&bar](double share) { bar.update(share); };
    // Against an earlier run only its own method says anything.
    profile = profiler::profileBy(earlier && options.method == "auto" ? earlier->method : options.method,
                                  session, how);
  }
  if (profile.interrupted) std::fprintf(stderr, "interrupted: this is what was measured until then\n");
  const std::vector<std::string> source = sourceOf(session);
  const profiler::Subject what{profiler::subjectOf(common.program.front(), session), source};
  std::optional<profiler::Comparison> comparison;
  if (earlier) comparison = profiler::compare(*earlier, profile, source);
  const profiler::Comparison* const compared = comparison ? &*comparison : nullptr;
  const auto before = std::chrono::steady_clock::now();
  profiler::writeProfile(profile, files, what, compared);
  const std::chrono::duration<double> writing = std::chrono::steady_clock::now() - before;
  if (common.json) {
    print(profiler::toJson(profile, files, what, compared));
  } else {
    printText(profile, source);
    printBranches(profile);
    if (profile.textures) printTextures(*profile.textures);
    if (comparison) printComparison(*comparison, source);
    printFiles(files, profile, comparison.has_value(), writing.count());
  }
  const bool differs = profile.check.compared_at_all && !profile.check.identical();
  const bool dearer = comparison && comparison->verdict == profiler::Verdict::dearer;
  return differs || dearer ? static_cast<int>(session::Outcome::failed) : 0;
}

}  // namespace

void addProfile(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand(
      "profile", "what each thread costs; writes report.html, heat.png, heat.exr, height.png, profile.json");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command
      ->add_option(
          "--method", options->method,
          "count: statements executed; clock: the driver's shader clock; isolate: one pixel's thread "
          "alone, on the CPU's clock; tiles: the program's own draw in parts of its target, without source, "
          "too; "
          "auto: clock, else isolate, else count; tiles where there is no source")
      ->check(CLI::IsMember({"auto", "clock", "isolate", "count", "tiles"}));
  command->add_option("--roi", options->roi, "only these pixels: lower left corner and size")
      ->type_name("X,Y,W,H");
  command
      ->add_option(
          "--budget", options->budget,
          "seconds to measure (12, or with --error until that is reached); isolate: decides how many pixels")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--passes", options->passes,
                   "clock: draws, of which the lower quartile counts; up to twice as many while they do not "
                   "repeat each other to 0.5%")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--no-lines", options->no_lines, "do not count executions per line");
  command->add_flag(
      "--neighbours", options->neighbours,
      "clock: also measure by isolate, for what each pixel pays for its neighbours: neighbours.png and .exr");
  command->add_flag("--per-iteration", options->per_iteration,
                    "also the cost over the iterations of the busiest loop: per-iteration.png and .exr");
  command->add_flag("--textures", options->textures,
                    "also map where textures are read, and how often: texture-SAMPLER-levelN.png and .exr");
  command
      ->add_option("--error", options->error,
                   "measure until the map is known this well (isolate: with 95 % confidence, by held-out "
                   "pixels; clock: between passes)")
      ->type_name("P%");
  command
      ->add_option(
          "--compare", options->compare,
          "an earlier run's profile.json (its heat.exr beside it): what became cheaper and what dearer; "
          "status 1 if this run is dearer beyond the noise")
      ->type_name("FILE");
  command
      ->add_option("--csv", options->csv,
                   "also a row per thread: its cost, its uncertainty, and whether it was measured")
      ->type_name("FILE");
  command
      ->add_option("--share", options->share, "isolate: measure this share of the pixels, on a regular grid")
      ->type_name("0..1")
      ->check(CLI::Range(1e-6, 1.0));
  command
      ->add_option("--fragments", options->fragments,
                   "isolate: fragments per side of a measured draw (chosen)")
      ->type_name("N")
      ->check(CLI::Range(2, 2048));
  command
      ->add_option("--repeats", options->repeats,
                   "isolate: draws per measured pixel, of which the lower quartile counts")
      ->type_name("N")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
