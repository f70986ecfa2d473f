#include "session/verify_draw.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "session/recorded_visits.h"
#include "session/thread_run.h"
#include "session/values.h"
#include "session/verify_findings.h"
#include "session/verify_measures.h"
#include "session/verify_plans.h"
#include "session/verify_samples.h"

namespace shadestep::session {
namespace {

using Clock = std::chrono::steady_clock;
using frontend::kNone;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using instrumenter::Probe;
using instrumenter::Value;
using Kind = VerifyFailure::Kind;

constexpr int kWatchedWords = 96;  // at one site; with more in scope the sites take turns with the variables

bool hasCondition(StatementKind kind) {
  return kind == StatementKind::if_ || kind == StatementKind::switch_ || kind == StatementKind::for_ ||
         kind == StatementKind::while_ || kind == StatementKind::do_while;
}

bool isJump(StatementKind kind) {
  return kind == StatementKind::return_ || kind == StatementKind::break_ ||
         kind == StatementKind::continue_ || kind == StatementKind::discard;
}

std::string hexWords(const std::vector<std::uint32_t>& words) {
  std::string text;
  for (const std::uint32_t word : words) {
    char hex[12];
    std::snprintf(hex, sizeof hex, "%s%08x", text.empty() ? "" : " ", word);
    text += hex;
    if (text.size() > 80) return text + " ...";
  }
  return text;
}

// One draw's checks.
class DrawCheck {
 public:
  DrawCheck(Session& session, const VerifyOptions& options, VerifyReport& report)
      : session_(session),
        options_(options),
        shader_(session.shader()),
        findings_(session, report),
        windows_(session, findings_, windowStride()) {}

  void run() {
    const auto before = session_.glState();
    look();
    compareState(before, session_.glState());
  }

 private:
  void look() {
    if (!copyIsFaithful()) return;
    if (!findThreads()) return;
    record();
    checkSites();
    windows_.finish();
    checkLoops(session_, findings_, recorded_);
    checkCounts(session_, findings_, recorded_, options_.counted_statements);
    checkClock(session_, findings_);
    if (!recorded_.empty() && options_.redrawn_steps > 0)
      checkRedrawnRun(session_, findings_, recorded_.front(), options_.redrawn_steps);
  }

  // Every how many probes one goes into a window as well.
  std::size_t windowStride() const {
    const std::size_t probes = 2 * shader_.statements.size();
    return (probes + options_.window_probes - 1) / std::max<std::size_t>(options_.window_probes, 1);
  }

  void checkSites() {
    for (StatementId id = 0; id < static_cast<StatementId>(shader_.statements.size()); ++id) {
      if (Clock::now() > deadline_)
        return findings_.skip("the time for one draw ran out before all its sites were seen");
      checkSite(id);
    }
  }

  // ---- the program's state
  // ---------------------------------------------------------------------------------

  using GlState = std::vector<std::pair<std::string, std::string>>;
  void compareState(const GlState& before, const GlState& after) {
    for (std::size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
      if (i >= before.size() || i >= after.size() || before[i].first != after[i].first) {
        return findings_.fail(Kind::state, nullptr, "state", "",
                              "the driver answers other questions than before");
      }
      if (before[i].second != after[i].second) {
        findings_.fail(Kind::state, nullptr, "state", before[i].first,
                       "was " + before[i].second + ", is " + after[i].second);
      }
    }
  }

  // ---- the draw without instrumentation
  // --------------------------------------------------------------------

  // The program's own text in a program of ours must draw what the program's own program draws. If it draws
  // different things twice, the driver (or a race in the shader) makes comparisons meaningless.
  bool copyIsFaithful() {
    Check check;
    const bool ran = findings_.attempt(nullptr, "copy", [&] {
      const Prepared copy = session_.prepareOriginal();
      check = session_.execute(copy).check;
    });
    if (!ran) return false;
    if (!check.compared_at_all) {
      findings_.skip(check.reason);
      return false;
    }
    return findings_.checkOutputs(nullptr, "copy", check);
  }

  // ---- which threads
  // ---------------------------------------------------------------------------------------

  bool findThreads() {
    Probe start;
    start.statement = shader_.functions[static_cast<std::size_t>(shader_.main)].body;
    const Statement& at = shader_.statements[static_cast<std::size_t>(start.statement)];
    if (!findings_.attempt(&at, "single before", [&] { all_ = valuesAt(session_, start); })) return false;
    findings_.checkOutputs(&at, "single before", all_.check);
    chosen_ = chooseThreads(all_, options_.threads);
    if (chosen_.empty()) {
      findings_.skip(session_.stage() == Stage::fragment
                         ? "no fragment of the draw is visible: values are not compared"
                         : "the draw runs no thread of the stage: values are not compared");
    }
    return true;
  }

  // ---- recording
  // -------------------------------------------------------------------------------------------

  void record() {
    if (chosen_.empty()) return;
    std::vector<RecordedThread> recorded;
    const bool ran = findings_.attempt(nullptr, "recording", [&] {
      const Session::PreparedRecording prepared = session_.prepareRecording();
      for (const ChosenThread& chosen : chosen_) {
        RecordedThread one = session_.stage() == Stage::fragment ? recordPixel(prepared, chosen)
                                                                 : recordNamed(prepared, chosen);
        const bool trusted = findings_.checkOutputs(nullptr, "recording", one.recorded.execution.check);
        one.recorded.execution = {};
        if (!trusted) continue;
        if (one.thread < 0 && chosen.discarded) {
          findings_.skip(
              "several threads of a pixel end in a discard: a recording does not say which one the probes "
              "see");
        } else if (one.thread < 0) {
          findings_.fail(
              Kind::value, nullptr, "recording", "",
              where(chosen.name) + ": a probe sees this thread, but the recording does not show it");
        } else {
          recorded.push_back(std::move(one));
        }
      }
    });
    if (ran) recorded_ = std::move(recorded);
  }

  RecordedThread recordPixel(const Session::PreparedRecording& prepared, const ChosenThread& chosen) {
    const int x = chosen.name[0].second;
    const int y = chosen.name[1].second;
    RecordedThread one{chosen, session_.record(prepared, x, y, 1, 1), -1};
    one.thread = chosen.discarded ? onlyDiscarded(one.recorded.recording) : visibleThread(one.recorded, x, y);
    return one;
  }

  RecordedThread recordNamed(const Session::PreparedRecording& prepared, const ChosenThread& chosen) {
    ThreadRecord record = recordThread(session_, prepared, all_, all_.find(chosen.name).value());
    return {chosen, std::move(record.recorded), record.thread};
  }

  static int onlyDiscarded(const instrumenter::Recording& recording) {
    const auto& threads = recording.threads;
    const auto ends = [](const instrumenter::ThreadRecording& thread) { return thread.discarded; };
    if (std::count_if(threads.begin(), threads.end(), ends) != 1) return -1;
    return static_cast<int>(std::find_if(threads.begin(), threads.end(), ends) - threads.begin());
  }

  // ---- single probes
  // ---------------------------------------------------------------------------------------

  void checkSite(StatementId id) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(id)];
    if (at.function == kNone || at.kind == StatementKind::case_label || at.kind == StatementKind::block)
      return;
    findings_.site();
    Probe probe;
    probe.statement = id;
    checkProbe(probe);
    checkInside(id);
    if (isJump(at.kind)) return;
    probe.when = Probe::When::after;
    probe.outcome = hasCondition(at.kind);
    checkProbe(probe);
    if (const auto iterations = someIterations(probe)) {
      probe.iterations = *iterations;
      checkProbe(probe);
    }
  }

  // Places inside of the statement's own expressions: behind the operand that decides at an operator, and
  // behind a call.
  void checkInside(StatementId id) {
    Probe probe;
    probe.statement = id;
    probe.when = Probe::When::after;
    probe.outcome = true;
    for (const frontend::TokenIndex op : instrumenter::choicesOf(shader_, id)) {
      probe.inside = op;
      checkChoice(probe);
    }
    probe.outcome = false;
    for (const frontend::CallId call : shader_.statements[static_cast<std::size_t>(id)].calls) {
      probe.inside = shader_.calls[static_cast<std::size_t>(call)].close;
      checkBehindCall(probe);
    }
  }

  // Against what the recordings say that the operand was when it was last evaluated, and by a window.
  void checkChoice(const Probe& probe) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(probe.statement)];
    ThreadValues found;
    if (!findings_.attempt(&at, "choice", [&] { found = valuesAt(session_, probe); })) return;
    if (!findings_.checkOutputs(&at, "choice", found.check)) return;
    windows_.add(probe, {}, found);
    for (const RecordedThread& one : recorded_) {
      const auto place = found.find(one.chosen.name);
      const bool reached = place && found.reachedAt(*place);
      const Value* recorded = lastChoice(one, probe);
      findings_.compared();
      const bool same =
          (recorded != nullptr) == reached &&
          (recorded == nullptr || recorded->words == found.values.front().valueAt(*place).words);
      if (same) continue;
      findings_.fail(Kind::value, &at, "choice", "",
                     where(one.chosen.name) + ": the operand is " +
                         (reached ? formatValue(found.values.front().valueAt(*place)) : "not evaluated") +
                         ", recorded " + (recorded != nullptr ? formatValue(*recorded) : "not evaluated"));
    }
  }

  static const Value* lastChoice(const RecordedThread& one, const Probe& probe) {
    const auto& records = one.run().records;
    for (auto record = records.rbegin(); record != records.rend(); ++record) {
      const auto& layout = one.recorded.layout.records[static_cast<std::size_t>(record->layout)];
      if (layout.event == instrumenter::Event::choice && layout.statement == probe.statement &&
          layout.token == probe.inside)
        return &record->values.at(0);
    }
    return nullptr;
  }

  // By a single probe: that it compiles and leaves the outputs alone. No other plan tells the same values:
  // recordings hold none between a call and the statement's end, and in windows Mesa turns some zeros there
  // into -0.
  void checkBehindCall(Probe probe) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(probe.statement)];
    watch(probe);
    ThreadValues found;
    if (!findings_.attempt(&at, "behind a call", [&] { found = valuesAt(session_, probe); })) return;
    findings_.checkOutputs(&at, "behind a call", found.check);
  }

  // The iterations of a visit in the middle of those that the last recorded thread makes; none if there is no
  // loop.
  std::optional<std::vector<int>> someIterations(const Probe& probe) const {
    std::vector<std::vector<int>> visits;
    if (recorded_.empty()) return std::nullopt;
    const RecordedThread& one = recorded_.back();
    forEachVisit(shader_, one.recorded.layout, one.run(), [&](const Visit& visit) {
      if (visit.statement == probe.statement && visit.when == probe.when) visits.push_back(visit.iterations);
    });
    if (visits.empty() || visits.front().empty()) return std::nullopt;
    return visits[visits.size() / 2];
  }

  void checkProbe(Probe probe) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(probe.statement)];
    const bool after = probe.when == Probe::When::after;
    std::string plan = after ? "single after" : "single before";
    for (const int i : probe.iterations)
      plan += (plan.back() == 'r' ? ", iteration " : ",") + std::to_string(i);
    const std::vector<Part> watched = watch(probe);
    ThreadValues found;
    if (!findings_.attempt(&at, plan, [&] { found = valuesAt(session_, probe); })) return;
    if (!findings_.checkOutputs(&at, plan, found.check)) return;
    windows_.add(probe, watched, found);
    if (after && isForInit(shader_, at)) return;  // a recording has no record between init and condition

    for (const RecordedThread& one : recorded_) {
      const auto place = found.find(one.chosen.name);
      const auto visit =
          isForInit(shader_, at) ? std::nullopt : lastVisit(shader_, one.recorded.layout, one.run(), probe);
      if (!isForInit(shader_, at) && visit.has_value() != (place && found.reachedAt(*place))) {
        findings_.fail(Kind::value, &at, plan, "",
                       where(one.chosen.name) + ": " +
                           (visit ? "the recording gets here, the probe does not"
                                  : "the probe gets here, the recording does not"));
        continue;
      }
      if (!visit) continue;
      std::size_t next = 0;
      if (probe.outcome)
        compareOutcome(at, plan, one.chosen.name, found.values.at(next++).valueAt(*place), *visit);
      for (const Part& part : watched)
        comparePart(at, plan, one.chosen.name, part, found.values.at(next++).valueAt(*place), *visit);
    }
  }

  void compareOutcome(const Statement& at, const std::string& plan, const ThreadName& thread,
                      const Value& found, const LastVisit& visit) {
    if (!visit.outcome) return;
    findings_.compared();
    if (found.words == visit.outcome->words) return;
    findings_.fail(
        Kind::value, &at, plan, "",
        where(thread) + ": outcome " + formatValue(found) + ", recorded " + formatValue(*visit.outcome));
  }

  void comparePart(const Statement& at, const std::string& plan, const ThreadName& thread, const Part& part,
                   const Value& found, const LastVisit& visit) {
    const auto known = visit.known.find(part.variable);
    if (known == visit.known.end()) return;
    findings_.compared();
    const auto from = known->second.value.words.begin() + static_cast<std::ptrdiff_t>(part.first_word);
    const Value recorded{part.type, {from, from + static_cast<std::ptrdiff_t>(found.words.size())}};
    if (found.words == recorded.words) return;
    for (std::size_t i = 0; i < found.words.size(); ++i) {
      if (!known->second.defined[part.first_word + i] || found.words[i] == recorded.words[i]) continue;
      findings_.fail(Kind::value, &at, plan, part.expression,
                     where(thread) + ": " + formatValue(found) + " (" + hexWords(found.words) +
                         "), recorded " + formatValue(recorded) + " (" + hexWords(recorded.words) + ")");
      return;
    }
    findings_.skip("a value that the shader never defined differs between two plans");
  }

  // Fills the probe's watches with what is in scope there, as much as one site may take.
  std::vector<Part> watch(Probe& probe) {
    std::vector<Part> candidates = partsInScope(shader_, probe);
    if (candidates.size() > 1) {
      std::rotate(candidates.begin(),
                  candidates.begin() + static_cast<std::ptrdiff_t>(turn_ % candidates.size()),
                  candidates.end());
    }
    int words = 0;
    std::size_t taken = 0;
    while (taken < candidates.size() && words < kWatchedWords) {
      words += frontend::wordCount(candidates[taken++].type);
    }
    if (taken < candidates.size()) turn_ += taken;
    candidates.resize(taken);
    for (const Part& part : candidates) probe.watches.push_back({part.expression, part.variable, part.type});
    return candidates;
  }

  Session& session_;
  const VerifyOptions& options_;
  const Shader& shader_;
  Findings findings_;
  WindowCheck windows_;
  Clock::time_point deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(options_.seconds_per_draw));
  ThreadValues all_;
  std::vector<ChosenThread> chosen_;
  std::vector<RecordedThread> recorded_;
  std::size_t turn_ = 0;
};

}  // namespace

void verifyThisDraw(Session& session, const VerifyOptions& options, VerifyReport& report) {
  DrawCheck(session, options, report).run();
}

}  // namespace shadestep::session
