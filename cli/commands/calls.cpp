// shadestep calls: what a program asks of OpenGL, call by call, or how often.
#include <algorithm>
#include <iostream>
#include <map>
#include <tuple>

#include "cli/common.h"
#include "session/call_statistics.h"

namespace shadestep::cli {
namespace {

struct Options {
  std::string frames;
  std::string filter;
  bool errors = false;
  bool statistics = false;
};

void printCall(const session::LoggedCall& call, bool with_thread) {
  std::cout << call.frame << ":" << call.index;
  if (with_thread) std::cout << " [" << call.thread << "]";
  std::cout << " " << session::describe(call) << "\n";
}

Json inJson(const session::CallStatistics& statistics) {
  Json frames = Json::array();
  for (const auto& [frame, counts] : statistics.frames)
    frames.push_back({{"frame", frame}, {"calls", counts.commands}, {"origins", counts.origins}});
  return {{"calls", statistics.calls},
          {"errors", statistics.errors},
          {"commands", statistics.total.commands},
          {"origins", statistics.total.origins},
          {"frames", frames}};
}

void printMostFirst(const std::map<std::string, std::uint64_t>& counts) {
  std::vector<std::pair<std::string, std::uint64_t>> rows(counts.begin(), counts.end());
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [name, count] : rows) std::cout << "  " << withThousands(count) << "  " << name << "\n";
}

void printStatistics(const session::CallStatistics& statistics) {
  printMostFirst(statistics.total.commands);
  std::cout << "which came with\n";
  printMostFirst(statistics.total.origins);
  std::cout << withThousands(statistics.calls) << (statistics.calls == 1 ? " call in " : " calls in ")
            << statistics.frames.size() << (statistics.frames.size() == 1 ? " frame" : " frames") << ", "
            << withThousands(statistics.errors) << " of them with an error\n";
}

int run(const Common& common, const Options& options) {
  session::CallFilter filter;
  std::tie(filter.first_frame, filter.last_frame) = frameRange(common, options.frames);
  filter.names = splitList(options.filter);
  filter.errors_only = options.errors;

  session::Session session(common.launchOptions());
  Json calls = Json::array();
  session::CallStatistics statistics;
  int first_thread = 0;
  session.forEachCall(filter, [&](const session::LoggedCall& call) {
    statistics.add(call);
    if (first_thread == 0) first_thread = call.thread;
    if (common.json && !options.statistics) calls.push_back(toJson(call));
    if (!common.json && !options.statistics) printCall(call, call.thread != first_thread);
  });
  session.quit();
  if (common.json) {
    Json document;
    if (!options.statistics) document["calls"] = std::move(calls);
    document["statistics"] = inJson(statistics);
    print(document);
  } else if (options.statistics) {
    printStatistics(statistics);
  } else if (statistics.calls == 0) {
    std::cout << "no such call\n";
  }
  return 0;
}

}  // namespace

void addCalls(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("calls", "list the calls of one or more frames, with their arguments");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addFrameOptions(*command, common, options->frames);
  command->add_option("--filter", options->filter, "only commands with such names: glUniform*,glDraw*")
      ->type_name("GLOB[,GLOB...]");
  command->add_flag("--errors", options->errors, "only calls that the driver answered with an error");
  command->add_flag("--stats", options->statistics,
                    "how often each command was called, and what it came with, instead of the calls");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
