// The whole run of one thread, as a person reads it, as JSON, and as CSV.
#include <algorithm>
#include <iostream>
#include <sstream>

#include "cli/commands/debug.h"
#include "profiler/pictures/files.h"
#include "session/fragment_origin.h"
#include "session/plan.h"
#include "session/probed_run.h"
#include "session/thread_run.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using frontend::Shader;
using session::Step;
using session::ThreadRun;

std::string joined(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : ",") + std::to_string(number);
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The user's own line.
std::string sourceOf(const Shader& shader, int line) {
  if (line < 1 || static_cast<std::size_t>(line) > shader.lines.size()) return {};
  return trimmed(shader.lines[static_cast<std::size_t>(line) - 1]);
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() > width) text = text.substr(0, width - 3) + "...";
  text.resize(width, ' ');
  return text;
}

// Where the call stands that led to an `enter`.
frontend::Place callOf(const Shader& shader, const Step& step) {
  const frontend::TokenIndex name = shader.calls[static_cast<std::size_t>(step.call)].name;
  return shader.tokens[static_cast<std::size_t>(name)].place;
}

std::string whatHappened(const Shader& shader, const Step& step) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "  ") + part; };
  for (const Step::Choice& choice : step.choices)
    add(choice.operation + " at " + std::to_string(choice.line) + ":" + std::to_string(choice.column) +
        (choice.outcome ? " true" : " false"));
  if (!step.outcome.empty()) add("-> " + step.outcome);
  if (step.kind == Step::Kind::call) add("(calls)");
  if (step.kind == Step::Kind::leave) add("(returns)");
  if (step.call != frontend::kNone) {
    const frontend::Place place = callOf(shader, step);
    add("(called at " + std::to_string(place.line) + ":" + std::to_string(place.column) + ")");
  }
  if (step.kind == Step::Kind::cut)
    add("the driver ended this loop although its condition still held: what follows is not what the shader "
        "says");
  for (const session::NamedValue& changed : step.changed) {
    add(changed.name + " = " + session::formatValue(changed.value));
  }
  for (const std::string& name : step.left_out)
    add(name + " (too large to be recorded: 'debug --at " + std::to_string(step.line) + " --after --print " +
        name + "[0]' shows an element)");
  return text;
}

std::string summary(const ThreadRun& run, int samples) {
  std::string text = run.discarded  ? "ended in a discard"
                     : run.complete ? "ran to its end"
                                    : "not yet at its end (without storage buffers each step costs a redraw)";
  if (run.hits > 1) {
    text += "; fragment " + std::to_string(run.hit) + " of " + std::to_string(run.hits) +
            " on the pixel (--hit 0 to " + std::to_string(run.hits - 1) + "), ";
    text += run.visible            ? "the visible one"
            : run.visible_hit >= 0 ? "hidden: the visible one is " + std::to_string(run.visible_hit)
                                   : "none of which is visible";
  } else if (!run.visible && !run.discarded) {
    text += samples > 0 ? "; hidden, or not on this sample (--sample)" : "; hidden by the fragment tests";
  }
  return text;
}

std::string asText(const Shader& shader, const session::DrawStop& stop, const session::DrawFacts& facts,
                   const FragmentOptions& fragments, const ThreadRun& run) {
  std::ostringstream text;
  const std::string forced = describe(fragments);
  if (!forced.empty()) text << forced << "\n";
  std::string who =
      run.identity.empty() ? "pixel " + std::to_string(run.x) + "," + std::to_string(run.y) : "";
  for (const session::NamedValue& one : run.identity)
    who += (who.empty() ? "" : ", ") + one.name + " " + session::formatValue(one.value);
  text << who << "  " << session::stageName(shader.stage) << " shader of program " << facts.program
       << "  frame " << stop.frame << ", draw " << stop.draw << " (" << stop.call << ")\n"
       << facts.renderer << "  GLSL " << shader.version << "\n"
       << withThousands(run.steps.size()) << " steps, " << summary(run, facts.samples) << "\n"
       << describe(run.check) << "\n\n";
  for (const session::NamedValue& input : run.inputs)
    text << "input " << input.name << " = " << session::formatValue(input.value) << "\n";
  if (!run.inputs.empty()) text << "\n";
  text << "  step  line  iteration  " << padded("source", 56) << "  what changed\n";
  std::size_t number = 0;
  for (const Step& step : run.steps) {
    const std::string indent(static_cast<std::size_t>(step.depth) * 2, ' ');
    std::string source = sourceOf(shader, step.line);
    if (step.kind == Step::Kind::enter) source = "> " + source;
    text << padded(std::string(6 - std::min<std::size_t>(6, std::to_string(number).size()), ' ') +
                       std::to_string(number),
                   6)
         << padded("  " + std::string(4 - std::min<std::size_t>(4, std::to_string(step.line).size()), ' ') +
                       std::to_string(step.line),
                   8)
         << padded(joined(step.iteration), 9) << "  " << padded(indent + source, 56);
    const std::string happened = whatHappened(shader, step);
    if (!happened.empty()) text << "  " << happened;
    text << "\n";
    ++number;
  }
  text << "\n";
  for (const ThreadRun::Output& output : run.outputs) {
    text << "colour output " << output.draw_buffer
         << " at this pixel after the draw: " << session::formatValue(output.value) << "\n";
  }
  return text.str();
}

Json choicesAsJson(const Step& step) {
  Json choices = Json::array();
  for (const Step::Choice& choice : step.choices) {
    choices.push_back({{"operator", choice.operation},
                       {"line", choice.line},
                       {"column", choice.column},
                       {"outcome", choice.outcome}});
  }
  return choices;
}

Json valuesAsJson(const std::vector<session::NamedValue>& values) {
  Json json = Json::object();
  for (const session::NamedValue& value : values)
    json[value.name] = {{"type", glslName(value.value.type)}, {"value", toJson(value.value)}};
  return json;
}

Json asJson(const Shader& shader, const ThreadRun& run) {
  Json document;
  document["thread"] = {{"stage", "fragment"},
                        {"x", run.x},
                        {"y", run.y},
                        {"hit", run.hit},
                        {"hits", run.hits},
                        {"visible", run.visible},
                        {"visible_hit", run.visible_hit < 0 ? Json(nullptr) : Json(run.visible_hit)}};
  if (!run.identity.empty()) {
    document["thread"] = {{"stage", session::stageName(shader.stage)}};
    for (const session::NamedValue& one : run.identity) document["thread"][one.name] = toJson(one.value);
    document["inputs"] = valuesAsJson(run.inputs);
  }
  Json steps = Json::array();
  for (const Step& step : run.steps) {
    Json one;
    one["line"] = step.line;
    one["column"] = step.column;
    one["function"] = step.function;
    one["kind"] = session::kindName(step.kind);
    one["depth"] = step.depth;
    one["iteration"] = step.iteration;
    if (!step.outcome.empty()) one["outcome"] = step.outcome;
    one["changed"] = valuesAsJson(step.changed);
    if (!step.choices.empty()) one["choices"] = choicesAsJson(step);
    if (step.call != frontend::kNone) {
      const frontend::Place place = callOf(shader, step);
      one["call"] = {{"line", place.line}, {"column", place.column}};
    }
    if (!step.left_out.empty()) one["left_out"] = step.left_out;
    steps.push_back(std::move(one));
  }
  document["steps"] = std::move(steps);
  document["outcome"] = run.discarded ? "discarded" : run.complete ? "finished" : "not followed to its end";
  Json outputs = Json::array();
  Json draw_buffers = Json::array();
  for (const ThreadRun::Output& output : run.outputs) {
    outputs.push_back(toJson(output.value));
    draw_buffers.push_back(output.draw_buffer);
  }
  document["outputs"] = std::move(outputs);
  document["output_draw_buffers"] = std::move(draw_buffers);
  document["check"] = toJson(run.check);
  return document;
}

std::string asCsv(const ThreadRun& run) {
  std::string csv = "step,line,column,function,iteration,name,type,value\n";
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    const Step& step = run.steps[i];
    const std::string head = std::to_string(i) + "," + std::to_string(step.line) + "," +
                             std::to_string(step.column) + "," + step.function + ",\"" +
                             joined(step.iteration) + "\",";
    if (!step.outcome.empty()) csv += head + "condition,bool," + step.outcome + "\n";
    if (step.outcome.empty() && step.changed.empty()) csv += head + ",,\n";
    for (const session::NamedValue& value : step.changed) {
      csv += head + session::csvCell(value.name) + "," + glslName(value.value.type) + ",\"" +
             session::formatValue(value.value) + "\"\n";
    }
  }
  return csv;
}

ThreadRun follow(session::Session& session, const DebugOptions& options) {
  if (session.stage() != session::Stage::fragment)
    return session::followThread(session, chosenThread(session.stage(), options, true).value());
  const std::vector<int> pixel = parseIntegers(options.pixel, "--pixel", 2, 2);
  const int x = pixel[0], y = pixel[1];
  const session::Plan plan = session::planByName(options.plan).value_or(session::Plan::automatic);
  if (plan == session::Plan::window || (plan == session::Plan::single && options.hit >= 0)) {
    throw session::Error(
        session::Outcome::usage,
        "a pixel's run is followed by --plan recording, or its visible fragment's by --plan single");
  }
  if (plan == session::Plan::single) return session::followPixelByProbes(session, x, y);
  if (plan == session::Plan::recording) session.prepareRecording();  // throws where there is none
  return session::followPixel(session, x, y, options.hit);
}

}  // namespace

namespace {

int statusOf(const ThreadRun& run) {
  return run.check.compared_at_all && !run.check.identical() ? static_cast<int>(session::Outcome::failed) : 0;
}

}  // namespace

int debugThread(session::Session& session, const Common& common, const DebugOptions& options) {
  const ThreadRun run = follow(session, options);
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(run));
  if (common.json) {
    Json document = asJson(session.shader(), run);
    document["fragments"] = toJson(options.fragments);
    print(document);
  } else {
    std::cout << asText(session.shader(), session.stop(), session.facts(), options.fragments, run);
  }
  return statusOf(run);
}

int debugOrigin(session::Session& session, const Common& common, const DebugOptions& options) {
  if (!options.csv.empty())
    throw session::Error(session::Outcome::usage,
                         "--csv is about one run; --pixel names those of a primitive here");
  const std::vector<int> pixel = parseIntegers(options.pixel, "--pixel", 2, 2);
  const session::FragmentOrigin origin = session::originOf(session, pixel[0], pixel[1], session.stage());
  Json runs = Json::array();
  std::string text;
  int status = 0;
  for (const session::ThreadName& thread : origin.threads) {
    const ThreadRun run = session::followThread(session, thread);
    status = std::max(status, statusOf(run));
    if (common.json)
      runs.push_back(asJson(session.shader(), run));
    else
      text += asText(session.shader(), session.stop(), session.facts(), options.fragments, run);
  }
  if (common.json) {
    Json document;
    document["fragment"] = {
        {"x", pixel[0]}, {"y", pixel[1]}, {"primitive", origin.primitive}, {"check", toJson(origin.check)}};
    if (!origin.emitted.empty()) {
      document["fragment"]["invocation"] = origin.invocation;
      document["fragment"]["emitted"] = origin.emitted;
    }
    document["runs"] = std::move(runs);
    document["fragments"] = toJson(options.fragments);
    print(document);
  } else {
    std::cout << "the fragment on pixel " << options.pixel << " comes from primitive " << origin.primitive;
    if (!origin.emitted.empty())
      std::cout << ", emitted as " << (origin.emitted.size() == 1 ? "vertex " : "vertices ")
                << joined(origin.emitted) << " of the geometry shader's invocation " << origin.invocation;
    std::cout << ": " << origin.threads.size() << (origin.threads.size() == 1 ? " run" : " runs") << "\n\n"
              << text;
  }
  return status;
}

}  // namespace shadestep::cli
