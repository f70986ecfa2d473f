// shadestep debug: one thread's whole run (--pixel), or the values at one place for all threads (--at).
#include "cli/commands/debug.h"

#include <algorithm>

namespace shadestep::cli {
namespace {

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

// How a thread of a stage is named on the command line.
const char* threadOptions(session::Stage stage) {
  switch (stage) {
    case session::Stage::vertex:
      return "--vertex N [--instance M]";
    case session::Stage::tess_control:
    case session::Stage::tess_eval:
      return "--primitive N --vertex M";
    case session::Stage::geometry:
      return "--primitive N [--invocation M]";
    case session::Stage::compute:
      return "--invocation X,Y,Z";
    case session::Stage::fragment:
      break;
  }
  return "--pixel X,Y";
}

void requireFitting(session::Stage stage, bool given, bool fits, const std::string& option) {
  if (!given || fits) return;
  throw session::Error(session::Outcome::usage, option + " names no thread of the " +
                                                    session::stageName(stage) + " stage; " +
                                                    threadOptions(stage) + " does");
}

int run(const Common& common, const DebugOptions& options) {
  const session::Stage stage = selectedStage(common);
  const bool chosen = chosenThread(stage, options).has_value();
  const bool has_thread = chosen || !options.pixel.empty();
  if (options.at.empty() && !has_thread) {
    throw session::Error(session::Outcome::usage, std::string("say which thread with ") +
                                                      threadOptions(stage) +
                                                      ", or which place with --at LINE --print NAMES");
  }
  if (options.at.empty() && !(options.print.empty() && options.image.empty() && options.scatter.empty() &&
                              options.iteration.empty())) {
    throw session::Error(session::Outcome::usage,
                         "--print, --image, --scatter and --iteration go with --at LINE");
  }
  if (!options.at.empty() && options.hit >= 0) requireOneFragment(options);
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  session.requireCapturable();
  choose(session, options.fragments);
  const bool origin = !options.pixel.empty() && stage != session::Stage::fragment;
  const auto look = origin               ? debugOrigin
                    : options.at.empty() ? debugThread
                    : options.hit >= 0   ? debugHit
                                         : debugValues;
  const int outcome = look(session, common, options);
  if (!options.let_run) return outcome;
  const int status = session.runToEnd();
  return outcome != 0 ? outcome : status;
}

}  // namespace

std::optional<session::ThreadName> chosenThread(session::Stage stage, const DebugOptions& options) {
  using session::Stage;
  const bool patches = stage == Stage::tess_control || stage == Stage::tess_eval;
  const bool whole_run = options.at.empty() && options.hit < 0;
  requireFitting(stage, !options.pixel.empty(),
                 stage == Stage::fragment || (whole_run && stage != Stage::compute), "--pixel");
  requireFitting(stage, options.vertex >= 0, stage == Stage::vertex || patches, "--vertex");
  requireFitting(stage, options.instance >= 0, stage == Stage::vertex || stage == Stage::geometry || patches,
                 "--instance");
  requireFitting(stage, options.primitive >= 0, patches || stage == Stage::geometry, "--primitive");
  requireFitting(stage, !options.invocation.empty(), stage == Stage::geometry || stage == Stage::compute,
                 "--invocation");
  const int instance = std::max(options.instance, 0);
  if (stage == Stage::vertex && options.vertex >= 0)
    return session::ThreadName{{"vertex", options.vertex}, {"instance", instance}};
  if (patches && options.primitive >= 0)
    return session::ThreadName{
        {"primitive", options.primitive}, {"vertex", std::max(options.vertex, 0)}, {"repeat", instance}};
  if (stage == Stage::compute && !options.invocation.empty()) {
    std::vector<int> at = parseIntegers(options.invocation, "--invocation", 1, 3);
    at.resize(3);
    return session::ThreadName{{"x", at[0]}, {"y", at[1]}, {"z", at[2]}};
  }
  if (stage == Stage::geometry && options.primitive >= 0) {
    const int invocation =
        options.invocation.empty() ? 0 : parseIntegers(options.invocation, "--invocation", 1, 1)[0];
    return session::ThreadName{
        {"primitive", options.primitive}, {"invocation", invocation}, {"repeat", instance}};
  }
  return std::nullopt;
}

void addDebug(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("debug", "one thread's whole run, or the values at a place for all threads");
  auto options = std::make_shared<DebugOptions>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  command
      ->add_option(
          "--pixel", options->pixel,
          "the fragment on this pixel, from the lower left; with --stage vertex or tess-control: the runs "
          "that it comes from")
      ->type_name("X,Y");
  command
      ->add_option("--hit", options->hit,
                   "which fragment, if the draw has several on the pixel; default the visible one")
      ->type_name("N");
  command
      ->add_option("--vertex", options->vertex,
                   "with --stage vertex: gl_VertexID; tess-control: gl_InvocationID; tess-eval: which of the "
                   "patch's generated vertices")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option(
          "--instance", options->instance,
          "with --stage vertex: gl_InstanceID; geometry, tess-control, tess-eval: which of the threads "
          "with the same numbers ('repeat'); default 0")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--primitive", options->primitive, "with --stage geometry, tess-control, tess-eval")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--invocation", options->invocation,
                   "with --stage compute: gl_GlobalInvocationID; geometry: gl_InvocationID")
      ->type_name("X,Y,Z");
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
                   "the first printed value over all threads, as a picture or exactly")
      ->type_name("F.png|F.exr");
  command
      ->add_option("--csv", options->csv,
                   "the printed values, a row per thread (with --pixel alone: a row per step)")
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
