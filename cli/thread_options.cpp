#include "cli/thread_options.h"

#include <algorithm>

#include "session/values.h"

namespace shadestep::cli {

const char* threadSyntax(session::Stage stage) {
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

void addThreadOptions(CLI::App& app, ThreadOptions& options, const std::string& pixel_help) {
  CLI::App* command = &app;
  command->add_option("--pixel", options.pixel, pixel_help)->type_name("X,Y");
  command
      ->add_option("--vertex", options.vertex,
                   "with --stage vertex: gl_VertexID; tess-control: gl_InvocationID; tess-eval: which of the "
                   "patch's generated vertices")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option(
          "--instance", options.instance,
          "with --stage vertex: gl_InstanceID; geometry, tess-control, tess-eval: which of the threads "
          "with the same numbers ('repeat'); default 0")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--primitive", options.primitive, "with --stage geometry, tess-control, tess-eval")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--invocation", options.invocation,
                   "with --stage compute: gl_GlobalInvocationID; geometry: gl_InvocationID")
      ->type_name("X,Y,Z");
}

namespace {

void requireFitting(session::Stage stage, bool given, bool fits, const std::string& option) {
  if (!given || fits) return;
  throw session::Error(session::Outcome::usage, option + " names no thread of the " +
                                                    session::stageName(stage) + " stage; " +
                                                    threadSyntax(stage) + " does");
}

}  // namespace

std::optional<session::ThreadName> chosenThread(session::Stage stage, const ThreadOptions& options,
                                                bool follows_pixels) {
  using session::Stage;
  const bool patches = stage == Stage::tess_control || stage == Stage::tess_eval;
  requireFitting(stage, !options.pixel.empty(), stage == Stage::fragment || follows_pixels, "--pixel");
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

std::string identityText(const session::ThreadValues& threads, std::size_t thread) {
  std::string text;
  for (const session::WatchedValues& one : threads.identity)
    text += (text.empty() ? "" : ", ") + one.name + " " + session::formatValue(one.valueAt(thread));
  return text;
}

}  // namespace shadestep::cli
