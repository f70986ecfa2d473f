#include "session/verify_plans.h"

#include <algorithm>

#include "glsl-frontend/watch.h"
#include "session/probed_run.h"
#include "session/thread_run.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::Shader;
using frontend::Statement;
using instrumenter::Probe;
using Kind = VerifyFailure::Kind;

constexpr std::size_t kProbesAtOnce = 4;
constexpr int kListedWords = 64;  // of a thread of another stage, by lists, which have room for more
constexpr int kNumbers = 8;       // words of its mark and of what tells who it is

const Statement& statementOf(const Shader& shader, frontend::StatementId id) {
  return shader.statements[static_cast<std::size_t>(id)];
}

// Words that one window's probe may take; below GLSL 1.30 most components take two channels.
int roomFor(Session& session, const Probe& probe) {
  const instrumenter::Target target = session.target();
  const bool by_lists = session.stage() != Stage::fragment && target.feedback_components == 0;
  const int channels = session.stage() == Stage::fragment
                           ? 4 * (target.max_draw_buffers - target.used_draw_buffers) - 1
                           : (by_lists ? kListedWords : target.feedback_components) - kNumbers;
  return (session.shader().version < 130 ? channels / 2 : channels) - (probe.outcome ? 1 : 0);
}

bool sameThreads(const std::vector<WatchedValues>& some, const std::vector<WatchedValues>& others) {
  return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                    [](const auto& one, const auto& other) { return one.words == other.words; });
}

}  // namespace

// ---- windows ---------------------------------------------------------------------------------------------

void WindowCheck::add(const Probe& probe, const std::vector<Part>& parts, const ThreadValues& found) {
  if (given_++ % stride_ != 0) return;
  Item item{probe, {}, {}};
  item.probe.watches.clear();
  int room = roomFor(session_, probe);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int words = frontend::wordCount(parts[i].type);
    if (words > room) break;
    room -= words;
    item.parts.push_back(parts[i]);
    item.probe.watches.push_back(probe.watches.at(i));
  }
  item.found = found;
  item.found.values.resize(item.parts.size() + (probe.outcome ? 1 : 0));
  if (session_.stage() == Stage::vertex) {
    // Of vertices that agree in what is left of them, one stays.
    nameThreads(item.found, Stage::vertex, session_.stop());
  }
  waiting_.push_back(std::move(item));
  if (waiting_.size() >= kProbesAtOnce) finish();
}

void WindowCheck::finish() {
  if (waiting_.empty()) return;
  const std::vector<Item> items = std::exchange(waiting_, {});
  std::vector<Probe> probes;
  for (const Item& item : items) probes.push_back(item.probe);
  findings_.attempt(nullptr, "window", [&] {
    Window window(session_, probes);
    for (const Item& item : items) compare(window, item);
  });
}

void WindowCheck::compare(Window& window, const Item& item) {
  const Shader& shader = session_.shader();
  const Statement& at = statementOf(shader, item.probe.statement);
  const ThreadValues again = window.valuesAt(item.probe);
  if (!findings_.checkOutputs(&at, "window", again.check)) return;
  if (again.marks != item.found.marks || !sameThreads(again.identity, item.found.identity)) {
    findings_.fail(Kind::value, &at, "window", "", "other threads get here than by a single probe");
    return;
  }
  const std::size_t first = item.probe.outcome ? 1 : 0;
  for (std::size_t i = 0; i < item.found.values.size(); ++i) {
    const WatchedValues& one = item.found.values[i];
    const WatchedValues& other = again.values.at(i);
    const auto same = [&](std::size_t p) {
      return i < first ? std::equal(one.at(p), one.at(p) + one.stride, other.at(p))
                       : agree(shader, item.parts[i - first], one.at(p), other.at(p));
    };
    std::size_t differing = 0;
    std::size_t example = 0;
    for (std::size_t p = 0; p < again.marks.size(); ++p) {
      if (!again.reachedAt(p) || same(p)) continue;
      ++differing;
      example = p;
    }
    findings_.compared();
    if (differing == 0) continue;
    if (i >= first && mayBeUndefined(shader, item.parts[i - first].variable)) continue;
    findings_.fail(Kind::value, &at, "window", one.name,
                   std::to_string(differing) + " threads differ from a single probe, such as " +
                       where(nameOf(again, example)) + ": " + formatValue(other.valueAt(example)) +
                       " instead of " + formatValue(one.valueAt(example)));
  }
}

// ---- redraws ---------------------------------------------------------------------------------------------

namespace {

// What main itself did; how calls inside of its statements are shown differs.
std::vector<Step> ownSteps(const std::vector<Step>& steps) {
  std::vector<Step> own;
  for (const Step& step : steps) {
    if (step.depth == 0 && (step.kind == Step::Kind::statement || step.kind == Step::Kind::condition))
      own.push_back(step);
  }
  return own;
}

void compareChanges(const Shader& shader, Findings& findings, const ThreadName& thread, const Step& redrawn,
                    const Step& recorded) {
  const Statement& at = statementOf(shader, redrawn.statement);
  for (const NamedValue& value : redrawn.changed) {
    const auto same = [&](const NamedValue& other) { return other.name == value.name; };
    const auto other = std::find_if(recorded.changed.begin(), recorded.changed.end(), same);
    if (other == recorded.changed.end()) continue;
    const frontend::WatchResult meant = frontend::resolveWatchAfter(shader, redrawn.statement, value.name);
    if (!meant.watch || meant.watch->variable == frontend::kNone ||
        mayBeUndefined(shader, meant.watch->variable))
      continue;
    findings.compared();
    if (value.value == other->value) continue;
    findings.fail(
        Kind::value, &at, "redraws", value.name,
        where(thread) + ": " + formatValue(value.value) + ", recorded " + formatValue(other->value));
  }
}

ThreadRun followByProbes(Session& session, const ThreadName& thread, std::size_t most_steps) {
  if (session.stage() != Stage::fragment) return followThreadByProbes(session, thread, most_steps);
  return followPixelByProbes(session, thread[0].second, thread[1].second, most_steps);
}

}  // namespace

void checkRedrawnRun(Session& session, Findings& findings, const RecordedThread& one,
                     std::size_t most_steps) {
  const Shader& shader = session.shader();
  ThreadRun run;
  if (!findings.attempt(nullptr, "redraws",
                        [&] { run = followByProbes(session, one.chosen.name, most_steps); }))
    return;
  if (!findings.checkOutputs(nullptr, "redraws", run.check)) return;
  const std::vector<Step> redrawn = ownSteps(run.steps);
  const std::vector<Step> recorded = ownSteps(stepsOf(shader, one.recorded.layout, one.run()));
  for (std::size_t i = 0; i < std::min(redrawn.size(), recorded.size()); ++i) {
    const Statement& at = statementOf(shader, redrawn[i].statement);
    findings.compared();
    if (redrawn[i].statement != recorded[i].statement || redrawn[i].iteration != recorded[i].iteration ||
        redrawn[i].outcome != recorded[i].outcome) {
      return findings.fail(Kind::value, &at, "redraws", "",
                           where(one.chosen.name) + ": step " + std::to_string(i) + " of main is \"" +
                               redrawn[i].outcome + "\" here, recorded at line " +
                               std::to_string(recorded[i].line) + " \"" + recorded[i].outcome + "\"");
    }
    compareChanges(shader, findings, one.chosen.name, redrawn[i], recorded[i]);
  }
  if ((run.complete && redrawn.size() != recorded.size()) || redrawn.size() > recorded.size()) {
    findings.fail(Kind::value, nullptr, "redraws", "",
                  where(one.chosen.name) + ": " + std::to_string(redrawn.size()) +
                      " steps of main, recorded " + std::to_string(recorded.size()));
  }
}

}  // namespace shadestep::session
