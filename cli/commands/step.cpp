// shadestep step: stepping through the shader for all threads at once, by commands on stdin.
#include <unistd.h>

#include <iostream>
#include <map>
#include <sstream>

#include "cli/common.h"
#include "cli/fragment_options.h"
#include "cli/thread_options.h"
#include "session/own_way.h"
#include "session/stepper.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using session::Position;
using session::Stepper;

struct Options : ThreadOptions {
  std::string plan = "auto";
  FragmentOptions fragments;
};

constexpr const char* kHelp =
    "over         to the next statement; at a branch: follow the picked thread, or most threads\n"
    "into         into the next call of the statement, or of the loop's head that comes next\n"
    "out          back to the caller\n"
    "side NAME    at a branch: follow this side (true, false, case N, default)\n"
    "next         to the condition of the loop's next iteration\n"
    "leave        past the loop\n"
    "line N       to a line of this function\n"
    "print A,B    values here: range over all threads that are here, and the picked thread's\n"
    "choices      which operands of ?:, && and || the threads evaluate in this statement\n"
    "scope        the variables in scope here, and what the statement may change\n"
    "where        the calls and iterations that lead here\n"
    "restart      back to the start of main\n"
    "quit         end the program under debug\n";

constexpr const char* kNotWritten = "the picked thread has not written it on its way here";

// What a command found, as a document; `asText` says the same to a person.
class Dialogue {
 public:
  Dialogue(session::Session& session, const std::optional<session::ThreadName>& thread, session::Plan plan)
      : stepper_(session, thread, plan), picks_(thread) {
    if (thread) way_.emplace(session, *thread);
  }

  // Carries out a command; the empty one says where the threads are.
  Json carryOut(const std::string& line) {
    std::istringstream words(line);
    std::string command;
    std::string argument;
    words >> command;
    std::getline(words >> std::ws, argument);
    Json answer = {{"command", line}};
    try {
      answer.update(carryOut(command, argument));
    } catch (const session::Error& error) {
      answer["error"] = error.what();
    }
    return answer;
  }

  std::string sourceLine(int line) const {
    const auto& lines = stepper_.shader().lines;
    return line >= 1 && static_cast<std::size_t>(line) <= lines.size()
               ? lines[static_cast<std::size_t>(line) - 1]
               : "";
  }

 private:
  Json carryOut(const std::string& command, const std::string& argument) {
    if (command == "print") return values(argument);
    if (command == "scope") return scope();
    if (command == "where") return where();
    if (command == "choices") return choices();
    if (command == "restart") return moveTo(stepper_.navigation().start());
    if (command.empty()) return position();
    const std::optional<Position> to = destination(command, argument);
    if (to) return moveTo(*to);
    stepper_.choose(command == "side" ? argument : "");
    return position();
  }

  // Where a command leads; nothing at a branch that it decides.
  std::optional<Position> destination(const std::string& command, const std::string& argument) {
    const session::Navigation& navigation = stepper_.navigation();
    const Position& here = stepper_.position();
    static const std::map<std::string, std::string> kShort = {{"o", "over"}, {"i", "into"}};
    const auto full = kShort.find(command);
    const std::string& name = full == kShort.end() ? command : full->second;
    const bool steps = name == "over" || name == "into";
    if (!steps && name != "side" && name != "out" && name != "next" && name != "leave" && name != "line")
      throw session::Error(session::Outcome::usage, "no command '" + command + "'; 'help' lists them");
    if (stepper_.ended())
      throw session::Error(session::Outcome::nothing_matches,
                           "the threads have ended; 'restart' goes back to the start");
    if (name == "side" || (steps && here.condition)) return std::nullopt;
    if (name == "over") return navigation.over(here);
    if (name == "into") return navigation.into(here);
    if (name == "out") return navigation.out(here);
    if (name == "next") return navigation.nextIteration(here);
    if (name == "leave") return navigation.leaveLoop(here);
    return navigation.toLine(here, parseIntegers(argument, "line", 1, 1)[0]);
  }

  Json moveTo(const Position& to) {
    if (to == stepper_.position())
      throw session::Error(session::Outcome::nothing_matches, "that leads nowhere from here");
    stepper_.moveTo(to);
    return position();
  }

  // ---- what is there

  Json position() {
    if (stepper_.ended()) return {{"ended", true}};
    const frontend::Shader& shader = stepper_.shader();
    const Position& here = stepper_.position();
    const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(here.statement)];
    Json json = {{"line", statement.place.line},
                 {"column", statement.place.column},
                 {"function", shader.functions[static_cast<std::size_t>(statement.function)].name},
                 {"iteration", here.iterations}};
    if (const frontend::CallId call = stepper_.navigation().callDone(here); call != frontend::kNone)
      json["returned"] = callAsJson(call);
    if (!here.condition) return json;
    Json sides = Json::array();
    for (const session::TakenSide& way : stepper_.sides()) {
      Json side = {{"name", way.side.name}, {"threads", way.threads}};
      if (picks_) side["picked"] = way.picked;
      sides.push_back(std::move(side));
    }
    json["sides"] = std::move(sides);
    return json;
  }

  Json callAsJson(frontend::CallId id) const {
    const frontend::Shader& shader = stepper_.shader();
    const frontend::Call& call = shader.calls[static_cast<std::size_t>(id)];
    const frontend::Place place = shader.tokens[static_cast<std::size_t>(call.name)].place;
    return {{"function", shader.functions[static_cast<std::size_t>(call.callee)].name},
            {"line", place.line},
            {"column", place.column}};
  }

  Json values(const std::string& names) {
    session::ThreadValues threads = stepper_.look(splitList(names));
    session::leaveOutUnwritten(stepper_.shader(), stepper_.position(), threads);
    Json json = {{"threads", {{"launched", threads.launched}, {"reached", threads.reached}}},
                 {"check", toJson(threads.check)},
                 {"check_text", describe(threads.check)}};
    const std::optional<std::size_t> picked = stepper_.pickedIn(threads);
    Json list = Json::array();
    for (const session::WatchedValues& watched : threads.values) {
      Json one = {{"name", watched.name}, {"type", glslName(watched.type)}};
      if (picks_) one["picked"] = nullptr;
      if (!watched.no_value.empty()) {
        one["no_value"] = watched.no_value;
        if (picks_) one["picked_text"] = "no value: " + watched.no_value;
      } else if (picked && threads.reachedAt(*picked) &&
                 !way_->hasWritten(stepper_.position(), watched.name)) {
        one["picked_no_value"] = kNotWritten;
        one["picked_text"] = std::string("no value: ") + kNotWritten;
      } else if (picked && threads.reachedAt(*picked)) {
        one["picked"] = toJson(watched.valueAt(*picked));
        one["picked_text"] = session::formatValue(watched.valueAt(*picked));
      }
      Json components = Json::array();
      for (const auto& component : session::statistics(threads, watched)) {
        const bool any = component.finite > 0;
        components.push_back({{"component", component.access},
                              {"min", any ? number(component.min) : Json(nullptr)},
                              {"max", any ? number(component.max) : Json(nullptr)},
                              {"mean", any ? number(component.mean) : Json(nullptr)},
                              {"nan", component.nan},
                              {"inf", component.inf}});
      }
      one["components"] = std::move(components);
      list.push_back(std::move(one));
    }
    json["values"] = std::move(list);
    return json;
  }

  Json choices() {
    Json list = Json::array();
    for (const session::TakenChoice& choice : stepper_.choices()) {
      Json one = {{"operator", choice.operation},
                  {"line", choice.place.line},
                  {"column", choice.place.column},
                  {"true", choice.yes},
                  {"false", choice.no},
                  {"check", toJson(choice.outcome.check)}};
      if (picks_) {
        const std::optional<std::size_t> picked = stepper_.pickedIn(choice.outcome);
        one["picked"] = picked && choice.outcome.reachedAt(*picked)
                            ? Json(*choice.outcome.values.front().at(*picked) != 0)
                            : Json(nullptr);
      }
      list.push_back(std::move(one));
    }
    return {{"choices", std::move(list)}};
  }

  Json scope() {
    if (stepper_.ended()) return {{"ended", true}};
    const auto list = [&](const std::vector<frontend::VariableId>& ids) {
      Json names = Json::array();
      for (const frontend::VariableId id : ids) {
        const frontend::Variable& variable = stepper_.shader().variables[static_cast<std::size_t>(id)];
        names.push_back({{"type", glslName(variable.type)}, {"name", variable.name}});
      }
      return names;
    };
    return {{"scope", list(stepper_.scope())}, {"may_change", list(stepper_.mayChange())}};
  }

  Json where() {
    Json calls = Json::array();
    for (const frontend::CallId id : stepper_.position().call_path) calls.push_back(callAsJson(id));
    Json json = position();
    json["calls"] = std::move(calls);
    return json;
  }

  Stepper stepper_;
  bool picks_;                          // a thread is picked
  std::optional<session::OwnWay> way_;  // its
};

// ---- for a person

std::string threadCount(const Json& threads) {
  return withThousands(threads.get<std::uint64_t>()) + (threads == 1 ? " thread" : " threads");
}

void showPosition(const Dialogue& dialogue, const Json& answer) {
  const int line = answer["line"];
  std::cout << "line " << line << "  " << answer["function"].get<std::string>();
  for (const Json& iteration : answer["iteration"]) std::cout << " [" << iteration << "]";
  std::cout << "  " << dialogue.sourceLine(line) << "\n";
  if (answer.contains("returned")) {
    const Json& call = answer["returned"];
    std::cout << "  " << call["function"].get<std::string>() << ", called at " << call["line"] << ":"
              << call["column"] << ", has returned\n";
  }
  if (!answer.contains("sides")) return;
  for (const Json& side : answer["sides"]) {
    std::cout << "  " << side["name"].get<std::string>() << ": " << threadCount(side["threads"]);
    if (side.value("picked", false)) std::cout << ", the picked one too";
    std::cout << "\n";
  }
}

void showCalls(const Json& calls) {
  std::cout << "main";
  for (const Json& call : calls)
    std::cout << " -> " << call["function"].get<std::string>() << " (called at " << call["line"] << ":"
              << call["column"] << ")";
  std::cout << "\n";
}

void showValues(const Json& answer) {
  const Json& threads = answer["threads"];
  std::cout << withThousands(threads["reached"]) << " of " << withThousands(threads["launched"])
            << " threads are here; " << answer["check_text"].get<std::string>() << "\n";
  for (const Json& value : answer["values"]) {
    std::cout << "  " << value["name"].get<std::string>() << " (" << value["type"].get<std::string>() << ")";
    if (value.contains("picked_text"))
      std::cout << " = " << value["picked_text"].get<std::string>();
    else if (value.contains("picked"))
      std::cout << ": the picked thread is not here";
    std::cout << "\n";
    for (const Json& component : value["components"]) {
      const auto access = component["component"].get<std::string>();
      std::cout << "    " << (access.empty() ? "range" : access) << " ";
      if (component["min"].is_null())
        std::cout << "has no finite value";
      else
        std::cout << component["min"].dump() << " to " << component["max"].dump() << ", mean "
                  << component["mean"].dump();
      if (component["nan"] > 0) std::cout << ", NaN in " << withThousands(component["nan"]);
      if (component["inf"] > 0) std::cout << ", infinite in " << withThousands(component["inf"]);
      std::cout << "\n";
    }
  }
}

void showChoices(const Json& choices) {
  if (choices.empty()) std::cout << "no ?:, && or || is evaluated here\n";
  for (const Json& choice : choices) {
    std::cout << "  " << choice["operator"].get<std::string>() << " at " << choice["line"] << ":"
              << choice["column"] << "  true: " << threadCount(choice["true"])
              << ", false: " << threadCount(choice["false"]);
    if (choice.contains("picked"))
      std::cout << (choice["picked"].is_null() ? ", the picked one does not get there"
                    : choice["picked"]         ? ", the picked one: true"
                                               : ", the picked one: false");
    std::cout << "\n";
  }
}

void showScope(const Json& answer) {
  const auto list = [](const char* title, const Json& names) {
    std::cout << title;
    for (const Json& one : names)
      std::cout << "  " << one["type"].get<std::string>() << " " << one["name"].get<std::string>();
    std::cout << "\n";
  };
  list("in scope:", answer["scope"]);
  list("may change:", answer["may_change"]);
}

void show(const Dialogue& dialogue, const Json& answer) {
  if (answer.contains("error")) std::cout << answer["error"].get<std::string>() << "\n";
  if (answer.contains("ended")) std::cout << "the threads end here\n";
  if (answer.contains("calls")) showCalls(answer["calls"]);
  if (answer.contains("line")) showPosition(dialogue, answer);
  if (answer.contains("values")) showValues(answer);
  if (answer.contains("choices")) showChoices(answer["choices"]);
  if (answer.contains("scope")) showScope(answer);
}

// In JSON the whole dialogue is one document, printed at its end.
void converse(Dialogue& dialogue, session::Stage stage, bool json) {
  const bool prompt = !json && isatty(STDIN_FILENO) != 0;
  Json steps = Json::array();
  const auto answer = [&](const std::string& line) {
    Json one = dialogue.carryOut(line);
    if (json) {
      one.erase("check_text");
      steps.push_back(std::move(one));
    } else {
      show(dialogue, one);
    }
  };
  answer("");
  std::string line;
  while ((prompt ? std::cout << "> " << std::flush : std::cout) && std::getline(std::cin, line)) {
    if (line == "quit" || line == "q") break;
    if (line == "help" && !json)
      std::cout << kHelp;
    else if (!line.empty())
      answer(line);
  }
  if (json) print({{"stage", session::stageName(stage)}, {"steps", std::move(steps)}});
}

// The thread that the options name, which must be there; nothing if they name none.
std::optional<session::ThreadName> pickedThread(session::Session& session, const Options& options) {
  if (!options.pixel.empty()) {
    const int width = session.facts().width;
    const auto pixel = static_cast<int>(pixelIndex(session, options.pixel));
    return session::pixelName(pixel % width, pixel / width);
  }
  const std::optional<session::ThreadName> thread = chosenThread(session.stage(), options, false);
  if (thread) session::requireThread(Stepper(session).look({}), *thread);
  return thread;
}

int run(const Common& common, const Options& options) {
  chosenThread(selectedStage(common), options, false);  // throws before the work begins
  const std::optional<session::Plan> plan = session::planByName(options.plan);
  session::Session session(common.launchOptions());
  runToSelection(session, common);
  session.requireCapturable();
  choose(session, options.fragments);
  const std::string forced = describe(options.fragments);
  if (!forced.empty() && !common.json) std::cout << forced << "\n";
  Dialogue dialogue(session, pickedThread(session, options), plan.value_or(session::Plan::automatic));
  converse(dialogue, session.stage(), common.json);
  return 0;
}

}  // namespace

void addStep(CLI::App& app, Common& common, Action& action) {
  CLI::App* command =
      app.add_subcommand("step", "step through the shader for all threads at once, by commands on stdin");
  auto options = std::make_shared<Options>();
  addCommonOptions(*command, common);
  addSelectionOptions(*command, common);
  addThreadOptions(*command, *options, "the picked thread: its values are shown, its side is followed");
  command
      ->add_option(
          "--plan", options->plan,
          "single: one compilation per step; window: one for the steps around; recording: one draw for "
          "all steps; auto: what fits")
      ->check(CLI::IsMember({"auto", "single", "window", "recording"}));
  addFragmentOptions(*command, options->fragments);
  command->footer(kHelp);
  command->callback(
      [&common, &action, options] { action = [&common, options] { return run(common, *options); }; });
}

}  // namespace shadestep::cli
