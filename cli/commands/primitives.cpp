// shadestep primitives: what a geometry shader makes of each input primitive.
#include <algorithm>
#include <iostream>

#include "cli/common.h"
#include "profiler/pictures/files.h"
#include "session/emits.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using session::EmittedVertex;
using session::GeometryEmits;
using session::GeometryRun;
using session::InputPrimitive;
using session::OutputPrimitive;

constexpr std::size_t kMostInText = 32;  // input primitives

struct Options {
  int primitive = -1;
  std::string csv;
};

// ---- JSON

Json asJson(const GeometryEmits& emits, const EmittedVertex& vertex, int stream) {
  Json json = Json::object();
  for (std::size_t i = 0; i < emits.outputs.size(); ++i)
    if (emits.outputs[i].stream == stream) json[emits.outputs[i].name] = toJson(emits.value(vertex, i));
  return json;
}

Json asJson(const GeometryEmits& emits, const OutputPrimitive& output) {
  Json vertices = Json::array();
  for (const EmittedVertex& vertex : output.vertices)
    vertices.push_back(asJson(emits, vertex, output.stream));
  return {{"stream", output.stream},
          {"parts", output.parts},
          {"ill_formed", output.ill_formed},
          {"vertices", std::move(vertices)}};
}

Json asJson(const GeometryEmits& emits, const GeometryRun& run) {
  Json outputs = Json::array();
  for (const OutputPrimitive& output : run.outputs) outputs.push_back(asJson(emits, output));
  return {{"invocation", run.invocation},
          {"vertices", run.vertices},
          {"beyond_limit", run.beyond_limit},
          {"outputs", std::move(outputs)}};
}

Json asJson(const GeometryEmits& emits, const InputPrimitive& input) {
  Json json;
  json["primitive"] = input.primitive;
  if (emits.repeats) json["repeat"] = input.repeat;
  Json runs = Json::array();
  for (const GeometryRun& run : input.runs) runs.push_back(asJson(emits, run));
  json["runs"] = std::move(runs);
  return json;
}

Json asJson(const GeometryEmits& emits, const GeometryEmits::Totals& totals) {
  Json document;
  document["output"] = emits.primitive;
  document["max_vertices"] = emits.max_vertices < 0 ? Json(nullptr) : Json(emits.max_vertices);
  document["totals"] = {{"inputs", totals.inputs},           {"runs", totals.runs},
                        {"silent_runs", totals.silent_runs}, {"outputs", totals.outputs},
                        {"ill_formed", totals.ill_formed},   {"parts", totals.parts},
                        {"vertices", totals.vertices},       {"beyond_limit", totals.beyond_limit}};
  Json types = Json::object();
  for (const GeometryEmits::Output& output : emits.outputs) types[output.name] = glslName(output.type);
  document["types"] = std::move(types);
  Json inputs = Json::array();
  for (const InputPrimitive& input : emits.inputs) inputs.push_back(asJson(emits, input));
  document["inputs"] = std::move(inputs);
  document["check"] = toJson(emits.check);
  return document;
}

// ---- text

std::string counted(std::uint64_t number, const std::string& one, const std::string& several) {
  return withThousands(number) + " " + (number == 1 ? one : several);
}

std::string partName(const GeometryEmits& emits, std::uint64_t number) {
  const std::string name = emits.primitive == "points"       ? "point"
                           : emits.primitive == "line_strip" ? "line"
                                                             : "triangle";
  return counted(number, name, name + "s");
}

void printOutput(const GeometryEmits& emits, const OutputPrimitive& output, std::size_t number) {
  std::cout << "    " << (output.stream > 0 ? "stream " + std::to_string(output.stream) + ", " : "")
            << "output " << number << ": " << counted(output.vertices.size(), "vertex", "vertices") << ", "
            << (output.ill_formed ? "ILL-FORMED: too few for a " + emits.primitive
                                  : partName(emits, static_cast<std::uint64_t>(output.parts)))
            << "\n";
  for (std::size_t i = 0; i < output.vertices.size(); ++i) {
    std::cout << "      vertex " << i;
    for (std::size_t k = 0; k < emits.outputs.size(); ++k) {
      if (emits.outputs[k].stream != output.stream) continue;
      std::cout << "  " << emits.outputs[k].name << " = "
                << session::formatValue(emits.value(output.vertices[i], k));
    }
    std::cout << "\n";
  }
}

void printInput(const GeometryEmits& emits, const InputPrimitive& input) {
  std::cout << "primitive " << input.primitive;
  if (emits.repeats) std::cout << ", repeat " << input.repeat;
  std::cout << "\n";
  for (const GeometryRun& run : input.runs) {
    std::cout << "  invocation " << run.invocation << ": "
              << counted(static_cast<std::uint64_t>(run.vertices), "vertex", "vertices");
    if (run.beyond_limit > 0)
      std::cout << ", THE LAST " << run.beyond_limit << " BEYOND max_vertices = " << emits.max_vertices
                << ", hence dropped";
    std::cout << "\n";
    for (std::size_t i = 0; i < run.outputs.size(); ++i) printOutput(emits, run.outputs[i], i);
  }
}

void printText(const GeometryEmits& emits, const GeometryEmits::Totals& totals) {
  std::cout << counted(totals.inputs, "input primitive", "input primitives") << ", "
            << counted(totals.runs, "run", "runs") << " of the shader (" << withThousands(totals.silent_runs)
            << " emitting nothing), " << counted(totals.outputs, "output primitive", "output primitives")
            << " (" << emits.primitive << "; " << withThousands(totals.ill_formed) << " ill-formed), "
            << partName(emits, totals.parts) << ", " << counted(totals.vertices, "vertex", "vertices");
  if (totals.beyond_limit > 0)
    std::cout << " (" << withThousands(totals.beyond_limit) << " beyond max_vertices)";
  std::cout << "\n" << describe(emits.check) << "\n\n";
  for (std::size_t i = 0; i < std::min(emits.inputs.size(), kMostInText); ++i)
    printInput(emits, emits.inputs[i]);
  if (emits.inputs.size() > kMostInText)
    std::cout << "... and " << withThousands(emits.inputs.size() - kMostInText)
              << " more; --primitive N shows one, --json and --csv all\n";
}

// ---- CSV: a row per vertex

std::string asCsv(const GeometryEmits& emits) {
  std::string csv = "primitive,repeat,invocation,stream,output,vertex";
  for (const GeometryEmits::Output& output : emits.outputs)
    for (const auto& component : frontend::components(output.type))
      csv += "," + output.name + component.access;
  csv += "\n";
  for (const InputPrimitive& input : emits.inputs) {
    for (const GeometryRun& run : input.runs) {
      for (std::size_t i = 0; i < run.outputs.size(); ++i) {
        const OutputPrimitive& output = run.outputs[i];
        for (std::size_t v = 0; v < output.vertices.size(); ++v) {
          csv += std::to_string(input.primitive) + "," + std::to_string(input.repeat) + "," +
                 std::to_string(run.invocation) + "," + std::to_string(output.stream) + "," +
                 std::to_string(i) + "," + std::to_string(v);
          for (std::size_t k = 0; k < emits.outputs.size(); ++k) {
            const instrumenter::Value value = emits.value(output.vertices[v], k);
            const bool has = emits.outputs[k].stream == output.stream;
            const std::uint32_t* word = value.words.data();
            for (const auto& component : frontend::components(value.type)) {
              csv += "," + (has ? session::formatComponent(component.basic, word) : "");
              word += session::wordsPerComponent(component.basic);
            }
          }
          csv += "\n";
        }
      }
    }
  }
  return csv;
}

void keepOne(GeometryEmits& emits, int primitive) {
  const auto other = [&](const InputPrimitive& input) { return input.primitive != primitive; };
  const std::size_t there = emits.inputs.size();
  const int last = emits.inputs.empty() ? 0 : emits.inputs.back().primitive;
  std::erase_if(emits.inputs, other);
  if (!emits.inputs.empty()) return;
  throw session::Error(
      session::Outcome::nothing_matches,
      "no input primitive " + std::to_string(primitive) + "; " +
          (there == 0 ? "the geometry shader got none" : "there are primitive 0 to " + std::to_string(last)));
}

int run(const Common& common, const Options& options) {
  session::Session session(common.launchOptions());
  session.runTo(common.frame, common.draw);
  GeometryEmits emits = session::geometryEmits(session);
  const GeometryEmits::Totals totals = emits.totals();
  if (options.primitive >= 0) keepOne(emits, options.primitive);
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), asCsv(emits));
  if (common.json)
    print(asJson(emits, totals));
  else
    printText(emits, totals);
  return emits.check.compared_at_all && !emits.check.identical() ? static_cast<int>(session::Outcome::failed)
                                                                 : 0;
}

}  // namespace

void addPrimitives(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("primitives", "what a geometry shader makes of each input primitive");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  command->add_option("--frame", common.frame, "the frame, 0-based")->type_name("N");
  command->add_option("--draw", common.draw, "the draw in its frame, 0-based")->type_name("N");
  command->add_option("--primitive", options->primitive, "of one input primitive, by gl_PrimitiveIDIn")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--csv", options->csv, "a row per emitted vertex")->type_name("F");
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
