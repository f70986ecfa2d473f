// shadestep verify: every site of every selected draw by every plan, compared with each other and with the
// draw as the program makes it.
#include "session/verify.h"

#include <chrono>
#include <iostream>

#include "cli/common.h"
#include "session/timed_out.h"

namespace shadestep::cli {
namespace {

struct Options {
  std::string frames;
  long long draw = -1;  // -1: all
  bool keep_running = false;
  bool twice = false;
  session::VerifyOptions verify;
};

Json toJson(const session::VerifyFailure& failure) {
  Json json;
  json["kind"] = session::kindName(failure.kind);
  json["stage"] = failure.stage ? Json(session::stageName(*failure.stage)) : Json(nullptr);
  json["frame"] = failure.frame;
  json["draw"] = failure.draw;
  json["line"] = failure.line;
  json["column"] = failure.column;
  json["plan"] = failure.plan;
  json["variable"] = failure.variable;
  json["detail"] = failure.detail;
  return json;
}

Json toJson(const session::VerifyCounts& counts) {
  Json json;
  json["shaders"] = counts.shaders;
  json["sites"] = counts.sites;
  json["passes"] = counts.passes;
  json["values_compared"] = counts.compared;
  json["analysis_failed"] = counts.analysis_failed;
  json["compile_failed"] = counts.compile_failed;
  json["output_mismatch"] = counts.output_mismatch;
  json["value_mismatch"] = counts.value_mismatch;
  json["state_leaks"] = counts.state_leaks;
  json["crashes"] = counts.crashes;
  json["unsteady"] = counts.unsteady;
  json["timeouts"] = counts.timeouts;
  return json;
}

Json toJson(const session::VerifyReport& report) {
  Json json;
  json["draws"] = report.draws;
  json.update(toJson(report.total()));
  json["stages"] = Json::object();
  for (const auto& [stage, counts] : report.stages)
    json["stages"][session::stageName(stage)] = toJson(counts);
  json["skipped"] = Json::array();
  for (const auto& [what, count] : report.skipped) {
    json["skipped"].push_back(
        {{"stage", session::stageName(what.first)}, {"reason", what.second}, {"count", count}});
  }
  json["failures"] = Json::array();
  for (const auto& failure : report.failures) json["failures"].push_back(toJson(failure));
  return json;
}

void printText(const session::VerifyReport& report, double seconds) {
  std::cout << report.draws << " draws, " << static_cast<int>(seconds + 0.5) << " s\n";
  for (const auto& [stage, counts] : report.stages) {
    std::cout << "  " << session::stageName(stage) << ": " << counts.shaders << " shaders, " << counts.sites
              << " sites, " << withThousands(counts.passes) << " passes, " << withThousands(counts.compared)
              << " values compared\n";
  }
  const session::VerifyCounts total = report.total();
  std::cout << "  instrumented shaders that do not compile  " << total.compile_failed << "\n"
            << "  passes with other outputs                 " << total.output_mismatch << "\n"
            << "  values that differ between plans          " << total.value_mismatch << "\n"
            << "  state left changed                        " << total.state_leaks << "\n"
            << "  crashes of the program                    " << total.crashes << "\n"
            << "  passes that see other threads than others " << total.unsteady << "\n"
            << "  ends by the time limit (--timeout)        " << total.timeouts << "\n";
  for (const auto& [what, count] : report.skipped)
    std::cout << "  skipped " << count << " x (" << session::stageName(what.first) << "): " << what.second
              << "\n";
}

void printFailures(const session::VerifyReport& report) {
  for (const auto& failure : report.failures) {
    std::cerr << "shadestep: " << session::kindName(failure.kind) << ": frame " << failure.frame << ", draw "
              << failure.draw;
    if (failure.stage) std::cerr << ", " << session::stageName(*failure.stage) << " shader";
    if (failure.line > 0) std::cerr << ", line " << failure.line << ":" << failure.column;
    std::cerr << (failure.plan.empty() ? "" : ", " + failure.plan)
              << (failure.variable.empty() ? "" : ", " + failure.variable) << ": " << failure.detail << "\n";
  }
}

// What the program's target held at the last draw that was looked at.
struct LastDraw {
  session::DrawStop stop;
  std::optional<std::vector<session::ColorOutput>> outputs;
};

// Runs the program once more, stops at that draw only, and compares. Null if there is nothing to compare.
Json sameWithoutUs(const Common& common, const LastDraw& last) {
  if (!last.outputs) return nullptr;
  session::Session untouched(common.launchOptions());
  untouched.runTo(last.stop.frame, last.stop.draw);
  const auto outputs = session::drawnHere(untouched);
  if (!outputs) return nullptr;
  return session::sameBits(*last.outputs, *outputs);
}

int run(const Common& common, const Options& options) {
  const auto [first, last] = frameRange(common, options.frames);
  const auto start = std::chrono::steady_clock::now();
  session::Session session(common.launchOptions());
  session::Verifier verifier(session, options.verify);
  int status = 0;
  std::optional<LastDraw> last_draw;
  try {
    session.forEachDraw(first, last, [&](const session::DrawStop& stop) {
      if (options.draw >= 0 && stop.draw != static_cast<std::uint64_t>(options.draw)) return;
      verifier.verifyDraw();
      if (options.twice) last_draw = LastDraw{stop, session::drawnHere(session)};
    });
    if (options.keep_running) status = session.runToEnd();
  } catch (const session::TimedOut& error) {
    if (verifier.report().draws == 0) throw;
    verifier.addEnd(session::VerifyFailure::Kind::timeout, error.what());
  } catch (const session::Error& error) {
    if (verifier.report().draws == 0) throw;
    verifier.addEnd(session::VerifyFailure::Kind::crash, error.what());
  }
  const Json identical = last_draw ? sameWithoutUs(common, *last_draw) : Json(nullptr);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

  const session::VerifyReport& report = verifier.report();
  if (common.json) {
    Json json = toJson(report);
    json["program_output_identical"] = identical;
    json["program_status"] = options.keep_running ? Json(status) : Json(nullptr);
    json["seconds"] = seconds.count();
    print(json);
  } else {
    printText(report, seconds.count());
    if (!identical.is_null())
      std::cout << "  the program draws the same without it     " << (identical == Json(true) ? "yes" : "NO")
                << "\n";
  }
  if (!common.quiet) printFailures(report);
  return report.passed() && identical != Json(false) ? 0 : static_cast<int>(session::Outcome::failed);
}

}  // namespace

void addVerify(CLI::App& app, Common& common, Action& action) {
  CLI::App* command = app.add_subcommand(
      "verify", "step through every site of every selected draw by every plan, and check the results");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  CLI::Option* stage =
      command->add_option("--stage", common.stage, "this stage only (default: all that a draw has)");
  stage->type_name("STAGE");
  addFrameOptions(*command, common, options->frames);
  command->add_option("--draw", options->draw, "this draw of each frame only (default: all)")->type_name("N");
  command
      ->add_option("--pixels,--threads", options->verify.threads,
                   "pixels, or threads of other stages, that are recorded and compared")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--draws-per-shader", options->verify.draws_per_shader,
                   "draws with the same program and text that are looked at")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--budget", options->verify.seconds_per_draw,
                   "seconds for one draw; further sites are skipped")
      ->type_name("S")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_flag("--twice", options->twice,
                    "run the program once more without looking at its draws, and compare what it has drawn");
  command->add_flag("--continue", options->keep_running, "then let the program run to its own end");
  command->callback([&common, &action, options, stage] {
    action = [&common, options, stage] {
      if (!stage->empty()) options->verify.stage = selectedStage(common);
      return run(common, *options);
    };
  });
}

}  // namespace shadestep::cli
