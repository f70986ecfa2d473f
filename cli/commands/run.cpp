// shadestep run: the program under the interceptor, without stopping, or with one capture at every draw.
#include <iostream>
#include <limits>

#include "cli/common.h"
#include "session/text.h"
#include "session/thread_values.h"

namespace shadestep::cli {
namespace {

struct Options {
  bool every_draw = false;
};

// Captures one probe, at the first statement of main, and lets the draw go on. True if it could.
bool debugDraw(session::Session& session, std::string& last_reason) {
  try {
    const frontend::Shader& shader = session.shader(session::Stage::fragment);
    session::PlaceSelection place;
    for (const frontend::Statement& statement : shader.statements) {
      if (statement.function == shader.main && statement.kind != frontend::StatementKind::block) {
        place.line = statement.place.line;
        place.column = statement.place.column;
        break;
      }
    }
    if (place.line == 0) return false;
    const session::ThreadValues values = session::valuesAt(session, place, {});
    if (!values.check.identical()) last_reason = session::describe(values.check);
    return values.check.identical();
  } catch (const session::Error& error) {
    if (error.outcome() != session::Outcome::cannot_debug &&
        error.outcome() != session::Outcome::nothing_matches)
      throw;
    last_reason = error.what();
    return false;
  }
}

int run(const Common& common, const Options& options) {
  session::Session session(common.launchOptions());
  std::uint64_t debugged = 0;
  std::string last_reason;
  if (options.every_draw) {
    session.forEachDraw(0, std::numeric_limits<std::uint64_t>::max() - 1, [&](const session::DrawStop&) {
      debugged += debugDraw(session, last_reason) ? 1 : 0;
    });
  }
  const int status = session.runToEnd();
  const session::Progress progress = session.progress();
  if (common.json) {
    print({{"frames", progress.frames}, {"draws", progress.draws}, {"debugged", debugged}});
  } else if (!common.quiet) {
    std::cerr << "shadestep: " << progress.frames << " frames, " << progress.draws << " draws";
    if (options.every_draw) std::cerr << ", " << debugged << " debugged";
    if (!last_reason.empty()) std::cerr << "; one that was not: " << last_reason;
    std::cerr << "\n";
  }
  return status;
}

}  // namespace

void addRun(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("run", "run the program under the interceptor; exits with its status");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  command->add_flag("--every-draw", options->every_draw, "stop at every draw, capture one probe and go on");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
