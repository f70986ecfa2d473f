#include "cli/common.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "session/text.h"
#include "session/values.h"

namespace shadestep::cli {

namespace fs = std::filesystem;
using frontend::Basic;
using frontend::Type;
using session::Error;
using session::Outcome;

session::LaunchOptions Common::launchOptions() const {
  session::LaunchOptions options;
  options.command = program;
  options.program_output_to_stderr = json;
  options.ptrace = !no_ptrace;
  options.follow = !no_follow;
  options.timeout = std::chrono::seconds(timeout);
  return options;
}

std::string Common::inOut(const std::string& name) const {
  const fs::path path(name);
  const fs::path full = path.has_parent_path() ? path : fs::path(out) / path;
  if (full.has_parent_path()) {
    std::error_code error;
    fs::create_directories(full.parent_path(), error);
    if (error) {
      throw Error(Outcome::usage,
                  "cannot make the directory '" + full.parent_path().string() + "': " + error.message());
    }
  }
  return full.string();
}

void addCommonOptions(CLI::App& app, Common& common) {
  app.add_flag("--json", common.json, "one JSON document on stdout, everything else on stderr");
  app.add_option("--out", common.out, "directory for the files that the command writes")->type_name("DIR");
  app.add_option("--timeout", common.timeout, "give up after S seconds")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--no-ptrace", common.no_ptrace,
               "do not watch the program by ptrace (it is told how it ended, not where it crashed)");
  app.add_flag("--no-follow", common.no_follow,
               "only the process that is started here, not those that it starts");
  app.add_flag("--quiet", common.quiet, "no progress, no remarks");
}

void addSelectionOptions(CLI::App& app, Common& common) {
  app.add_option("--frame", common.frame, "frame, 0-based; one frame for programs that never present")
      ->type_name("N");
  app.add_option("--draw", common.draw, "draw in the frame, 0-based")->type_name("N");
  app.add_option("--stage", common.stage, "vertex, tess-control, tess-eval, geometry, fragment or compute")
      ->type_name("STAGE");
}

void addFrameOptions(CLI::App& command, Common& common, std::string& frames) {
  command.add_option("--frame", common.frame, "the frame, 0-based")->type_name("N");
  command.add_option("--frames", frames, "frames A to B (default 0..0)")->type_name("A..B");
}

std::pair<std::uint64_t, std::uint64_t> frameRange(const Common& common, const std::string& frames) {
  if (frames.empty()) return {common.frame, common.frame};
  std::string range = frames;
  if (const auto dots = range.find(".."); dots != std::string::npos) range.replace(dots, 2, ",");
  const std::vector<int> numbers = parseIntegers(range, "--frames", 1, 2);
  if (numbers.front() < 0 || numbers.back() < numbers.front()) {
    throw session::Error(session::Outcome::usage,
                         "--frames takes A..B with 0 <= A <= B, not '" + frames + "'");
  }
  return {static_cast<std::uint64_t>(numbers.front()), static_cast<std::uint64_t>(numbers.back())};
}

std::vector<int> parseIntegers(const std::string& text, const std::string& option, std::size_t at_least,
                               std::size_t at_most) {
  std::vector<int> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    int number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (next != end && *next != ',')) {
      throw Error(Outcome::usage, option + " takes integers with commas between them, not '" + text + "'");
    }
    numbers.push_back(number);
    if (next == end) break;
    at = next + 1;
  }
  if (numbers.size() < at_least || numbers.size() > at_most) {
    throw Error(Outcome::usage, option + " takes " + std::to_string(at_least) +
                                    (at_most == at_least ? "" : " or more") + " integers, not '" + text +
                                    "'");
  }
  return numbers;
}

std::vector<std::string> splitList(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '(') ++depth;
    if (c == ']' || c == ')') --depth;
    if (c == ',' && depth == 0) {
      parts.emplace_back();
    } else if (c != ' ' || !parts.back().empty()) {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part.erase(part.find_last_not_of(' ') + 1);
  std::erase(parts, "");
  return parts;
}

session::Stage selectedStage(const Common& common) {
  const auto stage = session::stageByName(common.stage);
  if (!stage) {
    throw Error(Outcome::usage,
                "no stage '" + common.stage +
                    "'; there are vertex, tess-control, tess-eval, geometry, fragment and compute");
  }
  return *stage;
}

void runToDraw(session::Session& session, const Common& common) {
  session.runTo(common.frame, common.draw);
  session.select(selectedStage(common));
}

void runToSelection(session::Session& session, const Common& common) {
  runToDraw(session, common);
  session.shader();  // exit 3 if there is none, 4 if it has no source or cannot be analysed
}

std::size_t pixelIndex(session::Session& session, const std::string& text) {
  const std::vector<int> xy = parseIntegers(text, "--pixel", 2, 2);
  const session::DrawFacts& facts = session.facts();
  if (xy[0] < 0 || xy[1] < 0 || xy[0] >= facts.width || xy[1] >= facts.height) {
    throw Error(Outcome::nothing_matches, "pixel " + text + " is outside the target of " +
                                              std::to_string(facts.width) + " x " +
                                              std::to_string(facts.height) + " pixels");
  }
  return static_cast<std::size_t>(xy[1]) * static_cast<std::size_t>(facts.width) +
         static_cast<std::size_t>(xy[0]);
}

void print(const Json& document) {
  std::cout << document.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
}

Json toJson(const session::Check& check) {
  Json json;
  json["outputs"] = !check.compared_at_all ? "not compared" : check.identical() ? "identical" : "differ";
  json["compared"] = check.compared;
  json["differing"] = check.differing;
  json["largest"] = check.largest ? Json{{"by", number(check.largest->by)},
                                         {"expected", number(check.largest->expected)},
                                         {"got", number(check.largest->got)},
                                         {"in", check.largest->where}}
                                  : Json(nullptr);
  json["undefined"] = check.undefined;
  json["reason"] = check.reason.empty() ? Json(nullptr) : Json(check.reason);
  json["left_out"] = check.left_out.empty() ? Json(nullptr) : Json(check.left_out);
  json["dropped"] = check.dropped.empty() ? Json(nullptr) : Json(check.dropped);
  return json;
}

Json number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return value;
}

namespace {

Json scalar(Basic basic, const std::uint32_t* words) {
  switch (basic) {
    case Basic::bool_:
      return words[0] != 0;
    case Basic::int_:
      return static_cast<std::int32_t>(words[0]);
    case Basic::uint_:
      return words[0];
    case Basic::float_:
      return number(session::shortestDouble(std::bit_cast<float>(words[0])));
    case Basic::int64_:
      return static_cast<std::int64_t>(words[0] | (static_cast<std::uint64_t>(words[1]) << 32));
    case Basic::uint64_:
      return words[0] | (static_cast<std::uint64_t>(words[1]) << 32);
    default:
      return number(session::componentAsDouble(basic, words));
  }
}

Json nested(const Type& type, const std::uint32_t*& word) {
  if (type.isScalar()) {
    Json json = scalar(type.basic, word);
    word += session::wordsPerComponent(type.basic);
    return json;
  }
  if (!type.isArray() && type.basic == Basic::struct_) {
    Json json = Json::object();
    for (const frontend::Member& member : type.members->members)
      json[member.name] = nested(member.type, word);
    return json;
  }
  Json json = Json::array();
  Type part = type;
  int parts = 0;
  if (type.isArray()) {
    part = type.element();
    parts = type.array.front();
  } else if (type.isMatrix()) {
    part.columns = 1;
    parts = type.columns;
  } else {
    part.rows = 1;
    parts = type.rows;
  }
  for (int i = 0; i < parts; ++i) json.push_back(nested(part, word));
  return json;
}

}  // namespace

Json toJson(const instrumenter::Value& value) {
  if (value.words.empty()) return nullptr;
  const std::uint32_t* word = value.words.data();
  return nested(value.type, word);
}

namespace {

// A number where the whole text is one, else the text.
Json asJson(const std::string& value) {
  const char* end = value.data() + value.size();
  std::int64_t integer = 0;
  if (const auto [at, error] = std::from_chars(value.data(), end, integer); error == std::errc() && at == end)
    return integer;
  double real = 0;
  if (const auto [at, error] = std::from_chars(value.data(), end, real); error == std::errc() && at == end)
    return number(real);
  return value;
}

}  // namespace

Json toJson(const session::LoggedCall& call) {
  Json arguments = Json::array();
  for (const auto& [name, value] : call.arguments)
    arguments.push_back({{"name", name}, {"value", asJson(value)}});
  Json json;
  json["frame"] = call.frame;
  json["index"] = call.index;
  json["thread"] = call.thread;
  json["name"] = call.name;
  json["args"] = std::move(arguments);
  json["result"] = call.result.empty() ? Json(nullptr) : asJson(call.result);
  json["error"] = call.error == 0 ? Json(nullptr) : Json(session::errorName(call.error));
  if (call.skipped) json["skipped"] = true;
  if (!call.returned) json["returned"] = false;
  return json;
}

}  // namespace shadestep::cli
