// shadestep calls: what a program asks of OpenGL, call by call, or how often.
#include <algorithm>
#include <iostream>
#include <map>
#include <tuple>

#include "cli/common.h"

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

// How often each command was called, frame by frame and in total.
class Statistics {
 public:
  void add(const session::LoggedCall& call) {
    ++frames_[call.frame][call.name];
    ++total_[call.name];
    ++calls_;
    errors_ += call.error != 0 ? 1 : 0;
  }
  std::uint64_t calls() const { return calls_; }
  std::uint64_t errors() const { return errors_; }

  Json json() const {
    Json frames = Json::array();
    for (const auto& [frame, counts] : frames_)
      frames.push_back({{"frame", frame}, {"calls", sorted(counts)}});
    return {{"calls", calls_}, {"errors", errors_}, {"commands", sorted(total_)}, {"frames", frames}};
  }

  void print() const {
    std::vector<std::pair<std::string, std::uint64_t>> rows(total_.begin(), total_.end());
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    for (const auto& [name, count] : rows) std::cout << "  " << withThousands(count) << "  " << name << "\n";
    std::cout << withThousands(calls_) << (calls_ == 1 ? " call in " : " calls in ") << frames_.size()
              << (frames_.size() == 1 ? " frame" : " frames") << ", " << withThousands(errors_)
              << " of them with an error\n";
  }

 private:
  using Counts = std::map<std::string, std::uint64_t>;
  static Json sorted(const Counts& counts) {
    Json json = Json::object();
    for (const auto& [name, count] : counts) json[name] = count;
    return json;
  }

  std::map<std::uint64_t, Counts> frames_;
  Counts total_;
  std::uint64_t calls_ = 0, errors_ = 0;
};

int run(const Common& common, const Options& options) {
  session::CallFilter filter;
  std::tie(filter.first_frame, filter.last_frame) = frameRange(common, options.frames);
  filter.names = splitList(options.filter);
  filter.errors_only = options.errors;

  session::Session session(common.launchOptions());
  Json calls = Json::array();
  Statistics statistics;
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
    document["statistics"] = statistics.json();
    print(document);
  } else if (options.statistics) {
    statistics.print();
  } else if (statistics.calls() == 0) {
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
                    "how often each command was called, instead of the calls");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
