#include "session/recording_plan.h"

#include <unordered_map>

#include "session/hit_values.h"
#include "session/recorded_visits.h"

namespace shadestep::session {
namespace {

using instrumenter::Probe;

void requireRecorded(const Probe& probe) {
  if (probe.call_path.empty() && probe.inside == frontend::kNone) return;
  throw Error(
      Outcome::cannot_debug,
      "a recording does not tell the calls of a function apart, nor the places inside of a statement; "
      "take --plan single");
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
      const std::uint32_t* words = recorded_->visible.at(x, y);
      const bool shows = instrumenter::decodeMark(attachment, words) != 0;
      const auto found =
          shows ? by_invocation.find(
                      instrumenter::decode(attachment, attachment.fields.at(0), words).words.at(0))
                : by_invocation.end();
      shown_.push_back(found == by_invocation.end() ? -1 : found->second);
    }
  }
}

ThreadValues RecordingPlan::valuesAt(const Probe& probe) {
  requireRecorded(probe);
  if (!recorded_) record();
  const frontend::Shader& shader = session_.shader(Stage::fragment);
  ThreadValues result;
  result.width = session_.facts().width;
  result.height = session_.facts().height;
  result.statement = probe.statement;
  result.check = recorded_->execution.check;
  if (shader.traits.uses_discard)
    result.check.left_out =
        "threads that end in a discard are left out by this plan; --plan single shows them";
  result.marks.resize(shown_.size());
  const auto add = [&](const std::string& name, const frontend::Type& type) {
    const auto words = static_cast<std::size_t>(frontend::wordCount(type));
    result.values.push_back({name, type, words, std::vector<std::uint32_t>(words * shown_.size())});
  };
  for (std::size_t p = 0; p < shown_.size(); ++p) {
    if (shown_[p] < 0) continue;
    result.marks[p] = instrumenter::kLaunched;
    ++result.launched;
    const auto visit = lastVisit(shader, recorded_->layout,
                                 recorded_->recording.threads[static_cast<std::size_t>(shown_[p])], probe);
    if (!visit) continue;
    result.marks[p] |= instrumenter::kReached;
    const bool first = result.reached++ == 0;
    if (first && probe.outcome) add("", visit->outcome.value().type);
    if (first) {
      for (const frontend::Watch& watch : probe.watches) add(watch.expression, watch.type);
    }
    std::size_t field = 0;
    const auto put = [&](const std::vector<std::uint32_t>& words) {
      WatchedValues& values = result.values[field++];
      std::copy(words.begin(), words.end(),
                values.words.begin() + static_cast<std::ptrdiff_t>(p * values.stride));
    };
    if (probe.outcome) put(visit->outcome.value().words);
    for (const frontend::Watch& watch : probe.watches) put(recordedValue(shader, *visit, watch).words);
  }
  return result;
}

}  // namespace shadestep::session
