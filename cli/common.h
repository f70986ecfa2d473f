// What all commands share: the selection, the common options, and how results and errors leave the program.
// The promises to users stand in docs/cli.md.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "session/session.h"
#include "session/text.h"

namespace shadestep::cli {

// JSON documents keep the order in which they are written.
using Json = nlohmann::ordered_json;

struct Common {
  std::vector<std::string> program;  // after "--"
  std::uint64_t frame = 0;
  std::uint64_t draw = 0;
  std::string stage = "fragment";
  bool json = false;
  bool quiet = false;
  bool no_ptrace = false;
  bool no_follow = false;
  std::string out = ".";  // directory for files without a path of their own
  int timeout = 0;        // seconds; 0 = none

  session::LaunchOptions launchOptions() const;
  // The path of a file that the user named, or of one of ours in --out (which is made).
  std::string inOut(const std::string& name) const;
};

// What a command does once the command line is understood; its result is the exit code.
using Action = std::function<int()>;

void addCommonOptions(CLI::App&, Common&);
void addSelectionOptions(CLI::App&, Common&);  // --frame --draw --stage

// --frame N, or --frames A..B into `frames`; what they mean: first and last. Throws usage.
void addFrameOptions(CLI::App&, Common&, std::string& frames);
std::pair<std::uint64_t, std::uint64_t> frameRange(const Common&, const std::string& frames);

// "X,Y" or "A,B,C" as integers; throws Error{usage} naming the option.
std::vector<int> parseIntegers(const std::string& text, const std::string& option, std::size_t at_least,
                               std::size_t at_most);
std::vector<std::string> splitList(const std::string& text);  // at commas, blanks trimmed; brackets respected

// The selected stage; throws usage for a name that is none.
session::Stage selectedStage(const Common&);
// Runs to the selected draw and selects its stage, whatever is there.
void runToDraw(session::Session&, const Common&);
// Runs to the selected draw and selects its stage, which must be there and can be analysed.
void runToSelection(session::Session&, const Common&);

// "X,Y" as an index into the target of the current draw, rows bottom up. Throws usage, nothing_matches.
std::size_t pixelIndex(session::Session&, const std::string& text);

void print(const Json& document);  // one document on stdout
Json toJson(const session::Check&);
using session::describe;                  // of a check
Json toJson(const instrumenter::Value&);  // exact: shortest digits; NaN and infinities as strings
Json toJson(const session::LoggedCall&);
Json number(double value);  // NaN and infinities as strings
using session::withThousands;

// ---- the commands, a file each --------------------------------------------------------------------------
void addRun(CLI::App&, Common&, Action&);
void addDraws(CLI::App&, Common&, Action&);
void addCalls(CLI::App&, Common&, Action&);
void addBreak(CLI::App&, Common&, Action&);
void addSource(CLI::App&, Common&, Action&);
void addState(CLI::App&, Common&, Action&);
void addDebug(CLI::App&, Common&, Action&);
void addStep(CLI::App&, Common&, Action&);
void addLoops(CLI::App&, Common&, Action&);
void addPrimitives(CLI::App&, Common&, Action&);
void addProfile(CLI::App&, Common&, Action&);
void addDoctor(CLI::App&, Common&, Action&);
void addVerify(CLI::App&, Common&, Action&);
void addGui(CLI::App&, Common&, Action&);

}  // namespace shadestep::cli
