#include "session/recording_plan.h"

#include <algorithm>
#include <unordered_map>

#include "session/discarded_threads.h"
#include "session/hit_values.h"
#include "session/recorded_visits.h"

namespace shadestep::session {
namespace {

using instrumenter::Probe;

void requireRecorded(const Session& session, const Probe& probe) {
  if (session.stage() != Stage::fragment)
    throw Error(Outcome::cannot_debug,
                "all threads are recorded of fragment shaders only; take --plan single");
  if (probe.call_path.empty() && probe.inside == frontend::kNone) return;
  throw Error(
      Outcome::cannot_debug,
      "a recording does not tell the calls of a function apart, nor the places inside of a statement; "
      "take --plan single");
}

// What no statement sets, inputs, uniforms and constants, has no record, and the same value all the time.
bool isGiven(const frontend::Shader& shader, const frontend::Watch& watch) {
  if (watch.variable == frontend::kNone || shader.variables[static_cast<std::size_t>(watch.variable)].written)
    return false;
  const frontend::StatementId body = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const frontend::Scope& scope = shader.statements[static_cast<std::size_t>(body)].scope;
  return std::find(scope.begin(), scope.end(), watch.variable) != scope.end();
}

}  // namespace

void RecordingPlan::record() {
  const DrawFacts& facts = session_.facts();
  recorded_ = session_.record(0, 0, facts.width, facts.height);
  std::unordered_map<std::uint32_t, int> by_invocation;
  const auto& threads = recorded_->recording.threads;
  for (std::size_t i = 0; i < threads.size(); ++i)
    by_invocation.emplace(threads[i].invocation, static_cast<int>(i));
  const instrumenter::AttachmentLayout& attachment = recorded_->layout.attachment;
  for (int y = 0; y < facts.height; ++y) {
    for (int x = 0; x < facts.width; ++x) {
      const std::uint32_t* words = recorded_->visible.head(recorded_->visible.index(x, y));
      const bool shows = instrumenter::decodeMark(attachment, words) != 0;
      const auto found =
          shows ? by_invocation.find(
                      instrumenter::decode(attachment, attachment.fields.at(0), words).words.at(0))
                : by_invocation.end();
      shown_.push_back(found == by_invocation.end() ? -1 : found->second);
    }
  }
  showDiscarded();
}

// Where the draw shows no thread: the one that ends in a discard there. Which of several is the nearest a
// recording does not say.
void RecordingPlan::showDiscarded() {
  if (severalPlanes(session_.facts())) return;
  const auto& threads = recorded_->recording.threads;
  std::unordered_map<std::size_t, std::vector<int>> ended;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const std::size_t pixel =
        static_cast<std::size_t>(threads[i].y) * static_cast<std::size_t>(session_.facts().width) +
        static_cast<std::size_t>(threads[i].x);
    if (threads[i].discarded && pixel < shown_.size() && shown_[pixel] < 0)
      ended[pixel].push_back(static_cast<int>(i));
  }
  for (const auto& [pixel, candidates] : ended) {
    if (candidates.size() == 1)
      shown_[pixel] = candidates.front();
    else
      ++unclear_;
  }
}

// The values of the watches that no statement sets, from a probe at main's start.
ThreadValues RecordingPlan::given(const std::vector<frontend::Watch>& watches) {
  const frontend::Shader& shader = session_.shader(Stage::fragment);
  Probe start;
  start.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  for (const frontend::Watch& watch : watches)
    if (isGiven(shader, watch)) start.watches.push_back(watch);
  return start.watches.empty() ? ThreadValues() : session::valuesAt(session_, start);
}

ThreadValues RecordingPlan::look(const Probe& probe) {
  requireRecorded(session_, probe);
  if (!recorded_) record();
  const frontend::Shader& shader = session_.shader(Stage::fragment);
  const ThreadValues given = this->given(probe.watches);
  ThreadValues result;
  result.width = session_.facts().width;
  result.height = session_.facts().height;
  result.statement = probe.statement;
  result.check = recorded_->execution.check;
  if (!given.values.empty()) result.check.merge(given.check);
  int unclear = unclear_;
  result.marks.resize(shown_.size());
  const auto add = [&](const std::string& name, const frontend::Type& type) {
    const auto words = static_cast<std::size_t>(frontend::wordCount(type));
    result.values.push_back({name, type, words, std::vector<std::uint32_t>(words * shown_.size())});
  };
  for (std::size_t p = 0; p < shown_.size(); ++p) {
    if (shown_[p] < 0) continue;
    if (!given.values.empty() && !given.reachedAt(p)) {
      ++unclear;
      continue;
    }
    const auto& thread = recorded_->recording.threads[static_cast<std::size_t>(shown_[p])];
    result.marks[p] = static_cast<std::uint8_t>(instrumenter::kLaunched |
                                                (thread.discarded ? instrumenter::kDiscarded : 0));
    ++result.launched;
    result.discarded += thread.discarded ? 1 : 0;
    const auto visit = lastVisit(shader, recorded_->layout, thread, probe);
    if (!visit) continue;
    result.marks[p] |= instrumenter::kReached;
    const bool first = result.reached++ == 0;
    if (first && probe.outcome) add("", visit->outcome.value().type);
    if (first) {
      for (const frontend::Watch& watch : probe.watches) add(watch.expression, watch.type);
    }
    std::size_t field = 0;
    const auto put = [&](const std::uint32_t* words) {
      WatchedValues& values = result.values[field++];
      std::copy_n(words, values.stride,
                  values.words.begin() + static_cast<std::ptrdiff_t>(p * values.stride));
    };
    if (probe.outcome) put(visit->outcome.value().words.data());
    auto next = given.values.begin();
    for (const frontend::Watch& watch : probe.watches) {
      if (isGiven(shader, watch))
        put((next++)->at(p));
      else
        put(recordedValue(shader, *visit, watch).words.data());
    }
  }
  const auto& threads = recorded_->recording.threads;
  const bool any_discarded =
      std::any_of(threads.begin(), threads.end(), [](const auto& thread) { return thread.discarded; });
  if (severalPlanes(session_.facts()) && any_discarded) result.check.left_out = kDiscardedPlanes;
  if (unclear > 0)
    result.check.left_out = "on " + std::to_string(unclear) +
                            " pixels several threads end in a discard and are left out by this plan; --plan "
                            "single shows the nearest";
  return result;
}

}  // namespace shadestep::session
