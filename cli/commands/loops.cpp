// shadestep loops: per loop, how many threads iterate and how many leave at each iteration.
#include <fstream>
#include <iostream>

#include "cli/common.h"
#include "cli/fragment_options.h"
#include "profiler/pictures/files.h"
#include "profiler/pictures/loop_chart.h"
#include "profiler/pictures/value_image.h"
#include "session/loops.h"

namespace shadestep::cli {
namespace {

using session::LoopReport;
using session::LoopsReport;

struct Options {
  int line = 0;
  std::string image;
  std::string iterations_image;
  std::string csv, threads_csv;
  std::string compare;
  std::string label = "this run";
  std::string compare_label = "compared run";
  FragmentOptions fragments;
};

Json asJson(const LoopsReport& report, session::Stage stage) {
  Json loops = Json::array();
  for (const LoopReport& loop : report.loops) {
    Json one;
    one["line"] = loop.line;
    one["call"] = nullptr;
    one["function"] = loop.function;
    one["threads"] = loop.threads;
    one["entries"] = loop.entries;
    one["active"] = loop.active;
    one["left"] = loop.left;
    one["cut"] = loop.cut;
    one["max"] = loop.max;
    one["mean"] = loop.mean;
    loops.push_back(std::move(one));
  }
  Json document;
  document["stage"] = session::stageName(stage);
  document["loops"] = std::move(loops);
  document["check"] = toJson(report.check);
  return document;
}

// The loop of an earlier document that this run's loop is drawn against: the one at the same line, or the
// only one.
profiler::LoopRun readCompared(const Options& options, const LoopReport& loop) {
  std::ifstream file(options.compare);
  const Json document = Json::parse(file, nullptr, false);
  if (!file || document.is_discarded() || !document.contains("loops") || !document["loops"].is_array()) {
    throw session::Error(session::Outcome::usage,
                         "'" + options.compare + "' is no document of 'shadestep loops --json'");
  }
  const Json& loops = document["loops"];
  for (const Json& one : loops) {
    if (one.value("line", 0) != loop.line && loops.size() != 1) continue;
    profiler::LoopRun run;
    run.name = options.compare_label;
    run.active = one.value("active", std::vector<std::uint64_t>{});
    run.left = one.value("left", std::vector<std::uint64_t>{});
    return run;
  }
  throw session::Error(session::Outcome::nothing_matches, "'" + options.compare + "' has no loop at line " +
                                                              std::to_string(loop.line) +
                                                              "; choose one with --at");
}

// The loop that pictures are of: the one with the most iterations in all.
const LoopReport& busiest(const LoopsReport& report) {
  const auto total = [](const LoopReport& loop) { return loop.mean * static_cast<double>(loop.threads); };
  const LoopReport* most = &report.loops.front();
  for (const LoopReport& loop : report.loops) {
    if (total(loop) > total(*most)) most = &loop;
  }
  return *most;
}

std::string asCsv(const LoopsReport& report, const std::optional<profiler::LoopRun>& compared) {
  std::string csv = "line,iteration,active,left";
  if (compared) csv += ",compared_active,compared_left";
  csv += "\n";
  const LoopReport& shown = busiest(report);
  for (const LoopReport& loop : report.loops) {
    const bool with = compared && &loop == &shown;
    const std::size_t rows =
        with ? std::max(loop.active.size(), compared->active.size()) : loop.active.size();
    const auto cell = [](const std::vector<std::uint64_t>& column, std::size_t i) {
      return "," + std::to_string(i < column.size() ? column[i] : 0);
    };
    for (std::size_t i = 0; i < rows; ++i) {
      csv += std::to_string(loop.line) + "," + std::to_string(i) + cell(loop.active, i) + cell(loop.left, i);
      if (with) csv += cell(compared->active, i) + cell(compared->left, i);
      if (compared && !with) csv += ",,";
      csv += "\n";
    }
  }
  return csv;
}

// A row per thread: who it is, and the iterations of every loop.
std::string threadsCsv(const LoopsReport& report) {
  session::ThreadValues threads;
  threads.width = report.width;
  threads.height = report.height;
  threads.marks = report.marks;
  threads.identity = report.identity;
  for (const LoopReport& loop : report.loops) {
    session::WatchedValues values{"line" + std::to_string(loop.line), {}, 1, loop.iterations};
    values.type.basic = frontend::Basic::uint_;
    threads.values.push_back(std::move(values));
  }
  return session::asCsv(threads);
}

void writeIterationsImage(const std::string& path, const LoopsReport& report, const LoopReport& loop) {
  profiler::ValueImage image;
  image.width = report.width;
  image.height = report.height;
  std::vector<double> plane;
  for (std::size_t p = 0; p < report.marks.size(); ++p) {
    image.state.push_back(report.marks[p] == 0 ? profiler::ThreadState::none
                                               : profiler::ThreadState::reached);
    plane.push_back(loop.iterations[p]);
  }
  image.components.push_back(std::move(plane));
  if (path.ends_with(".exr")) {
    profiler::writeValueExr(path, image);
  } else {
    profiler::writeFile(path, profiler::drawValueImage(image, {"Iterations per thread",
                                                               "loop at line " + std::to_string(loop.line)}));
  }
}

void printText(const LoopsReport& report) {
  for (const LoopReport& loop : report.loops) {
    std::cout << "loop at line " << loop.line << " in " << loop.function << ": "
              << withThousands(loop.threads) << " threads, mean " << loop.mean
              << " iterations, longest thread " << loop.max;
    if (loop.cut > 0)
      std::cout << ", ended by the driver in " << withThousands(loop.cut)
                << " threads although its condition still held (llvmpipe ends loops after 65,536 iterations)";
    if (loop.entries > 1) std::cout << ", entered up to " << loop.entries << " times by one thread";
    std::cout << "\n";
    if (loop.active.empty()) continue;
    std::cout << "  iteration      active        left\n";
    // About twenty rows tell the shape; --csv has all of them.
    const std::size_t stride = std::max<std::size_t>(1, loop.active.size() / 20);
    for (std::size_t i = 0; i < loop.active.size(); i += stride) {
      std::uint64_t left = 0;
      for (std::size_t j = i; j < std::min(i + stride, loop.left.size()); ++j) left += loop.left[j];
      std::printf("  %9zu  %10s  %10s\n", i, withThousands(loop.active[i]).c_str(),
                  withThousands(left).c_str());
    }
    if (stride > 1) std::cout << "  (every " << stride << "th iteration; 'left' sums up to the next row)\n";
  }
  std::cout << describe(report.check) << "\n";
}

int run(const Common& common, const Options& options) {
  if (selectedStage(common) != session::Stage::fragment && !options.iterations_image.empty())
    throw session::Error(session::Outcome::usage,
                         "--iterations-image shows fragments, which have a place; take --threads-csv F");
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  choose(session, options.fragments);
  const LoopsReport report = session::profileLoops(session, options.line);
  const LoopReport& shown = busiest(report);
  std::optional<profiler::LoopRun> compared;
  if (!options.compare.empty()) compared = readCompared(options, shown);

  if (!options.image.empty()) {
    std::vector<profiler::LoopRun> runs{{options.label, shown.active, shown.left}};
    if (compared) runs.push_back(*compared);
    const profiler::LoopChartText text{"Loop at line " + std::to_string(shown.line),
                                       withThousands(shown.threads) + " threads of the draw"};
    profiler::writeFile(common.inOut(options.image), profiler::drawLoopChart(runs, text));
  }
  if (!options.iterations_image.empty()) {
    writeIterationsImage(common.inOut(options.iterations_image), report, shown);
  }
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(report, compared));
  if (!options.threads_csv.empty())
    profiler::writeFile(common.inOut(options.threads_csv), threadsCsv(report));
  if (common.json) {
    print(asJson(report, session.stage()));
  } else {
    printText(report);
  }
  return report.check.compared_at_all && !report.check.identical()
             ? static_cast<int>(session::Outcome::failed)
             : 0;
}

}  // namespace

void addLoops(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("loops", "per loop and iteration, how many threads are active and how many leave");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command->add_option("--at", options->line, "only the loop at this line")->type_name("LINE");
  command->add_option("--image", options->image, "chart of active and leaving threads per iteration")
      ->type_name("F.png");
  command->add_option("--iterations-image", options->iterations_image, "iterations per thread as an image")
      ->type_name("F.png|F.exr");
  command->add_option("--csv", options->csv, "a row per iteration")->type_name("F");
  command->add_option("--threads-csv", options->threads_csv, "a row per thread: the iterations of each loop")
      ->type_name("F");
  command
      ->add_option("--compare", options->compare, "an earlier run's --json document, drawn beside this one")
      ->type_name("FILE");
  addFragmentOptions(*command, options->fragments);
  command->add_option("--label", options->label, "what the chart calls this run")->type_name("TEXT");
  command->add_option("--compare-label", options->compare_label, "what the chart calls the compared run")
      ->type_name("TEXT");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
