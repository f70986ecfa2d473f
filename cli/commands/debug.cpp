// shadestep debug: one thread's whole run (--pixel), or the values at one place for all threads (--at).
#include "cli/commands/debug.h"

#include <algorithm>

namespace shadestep::cli {
namespace {

// From a fragment to the runs of an earlier stage that it comes from, which are whole runs.
bool followsPixels(session::Stage stage, const DebugOptions& options) {
  return options.at.empty() && options.hit < 0 && stage != session::Stage::compute;
}

// --hit with --at is about one fragment, which a recording shows.
void requireOneFragment(const DebugOptions& options) {
  if (options.pixel.empty()) {
    throw session::Error(session::Outcome::usage, "--hit needs --pixel X,Y, which says where");
  }
  if (!options.image.empty() || !options.csv.empty() || !options.scatter.empty() || options.plan != "auto") {
    throw session::Error(
        session::Outcome::usage,
        "--image, --csv, --scatter and --plan are about all threads; with --at, --hit is about one");
  }
}

void requireVertex(session::Stage stage, bool chosen, const DebugOptions& options) {
  if (stage == session::Stage::vertex && chosen && options.pixel.empty() && options.at.empty()) return;
  throw session::Error(session::Outcome::usage,
                       "--pixels goes with --stage vertex --vertex N [--instance M] alone");
}

int run(const Common& common, const DebugOptions& options) {
  const session::Stage stage = selectedStage(common);
  const bool chosen = chosenThread(stage, options, followsPixels(stage, options)).has_value();
  const bool has_thread = chosen || !options.pixel.empty();
  if (options.at.empty() && !has_thread) {
    throw session::Error(session::Outcome::usage, std::string("say which thread with ") +
                                                      threadSyntax(stage) +
                                                      ", or which place with --at LINE --print NAMES");
  }
  if (options.pixels) requireVertex(stage, chosen, options);
  if (options.at.empty() && !(options.print.empty() && (options.image.empty() || options.pixels) &&
                              options.scatter.empty() && options.iteration.empty())) {
    throw session::Error(session::Outcome::usage,
                         "--print, --image, --scatter and --iteration go with --at LINE");
  }
  if (!options.at.empty() && options.hit >= 0) requireOneFragment(options);
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  session.requireCapturable();
  choose(session, options.fragments);
  const bool origin = !options.pixel.empty() && stage != session::Stage::fragment;
  const auto look = options.pixels       ? debugPixels
                    : origin             ? debugOrigin
                    : options.at.empty() ? debugThread
                    : options.hit >= 0   ? debugHit
                                         : debugValues;
  const int outcome = look(session, common, options);
  if (!options.let_run) return outcome;
  const int status = session.runToEnd();
  return outcome != 0 ? outcome : status;
}

}  // namespace

void addDebug(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("debug", "one thread's whole run, or the values at a place for all threads");
  auto options = std::make_shared<DebugOptions>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  addThreadOptions(
      *command, *options,
      "the fragment on this pixel, from the lower left; with --stage vertex or tess-control: the "
      "runs that it comes from");
  command->add_flag("--pixels", options->pixels,
                    "with --stage vertex --vertex N: the pixels whose visible fragments its primitives made");
  command
      ->add_option("--hit", options->hit,
                   "which fragment, if the draw has several on the pixel; default the visible one")
      ->type_name("N");
  command->add_option("--at", options->at, "a place in the source: before the statement there")
      ->type_name("LINE[:COL]");
  command->add_flag("--after", options->after,
                    "after the statement at --at (a condition: after it was evaluated)");
  command
      ->add_option("--iteration", options->iteration,
                   "0-based iteration per enclosing loop, outermost first; default the last")
      ->type_name("I[,J...]");
  command->add_option("--call", options->call, "lines of the calls that lead to the place, outermost first")
      ->type_name("LINE[,LINE...]");
  command->add_option("--print", options->print, "variables, or parts of them, with commas between")
      ->type_name("A,B");
  command
      ->add_option("--image", options->image,
                   "the first printed value over all threads, as a picture or exactly; with --pixels: these")
      ->type_name("F.png|F.exr");
  command
      ->add_option(
          "--csv", options->csv,
          "the printed values, a row per thread (with --pixel alone: a row per step; with --pixels: a "
          "row per pixel)")
      ->type_name("F");
  command
      ->add_option(
          "--scatter", options->scatter,
          "the first two printed components against each other, a point per thread, coloured by the third")
      ->type_name("F.png");
  command
      ->add_option(
          "--plan", options->plan,
          "how to get at the values, which are the same by every plan: single (a pixel's run: a probe "
          "per step), window, recording; auto: what fits")
      ->check(CLI::IsMember({"auto", "single", "window", "recording"}));
  addFragmentOptions(*command, options->fragments);
  command->add_flag("--continue", options->let_run,
                    "then let the program run to its own end; default is to end it");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
