#include "session/undefined_outputs.h"

#include <algorithm>

namespace shadestep::session {
namespace {

using Outputs = std::vector<std::vector<std::uint32_t>>;

constexpr int kFills[] = {1, 3};  // quarters: not 0 and 1, at which blending may saturate

// Behind the captures of each record of transform feedback stand `record_words` of outputs.
Outputs outputsOf(const Execution& execution, int record_words) {
  Outputs outputs;
  for (const ColorOutput& output : execution.outputs) outputs.push_back(output.words);
  if (record_words == 0) return outputs;
  const auto stride = static_cast<std::size_t>(execution.feedback_words);
  const auto words = static_cast<std::size_t>(record_words);
  std::vector<std::uint32_t>& records = outputs.emplace_back();
  if (stride < words) throw Error(Outcome::failed, "the agent's answer lacks outputs; report this as a bug");
  for (std::size_t at = stride - words; at + words <= execution.feedback.size(); at += stride) {
    const auto first = execution.feedback.begin() + static_cast<std::ptrdiff_t>(at);
    records.insert(records.end(), first, first + record_words);
  }
  return outputs;
}

Execution drawn(Session& session, const Prepared& prepared) {
  ExecuteOptions options;
  options.compare = false;
  options.read_outputs = true;
  return session.execute(prepared, options);
}

Outputs drawnFilled(Session& session, int fill, int record_words) {
  const auto text =
      instrumenter::instrumentFilledOutputs(session.shader(session.stage()), session.target(), fill);
  if (const auto* failure = std::get_if<instrumenter::Failure>(&text)) {
    throw Error(Outcome::cannot_debug, failure->reason);
  }
  return outputsOf(drawn(session, session.prepareText(std::get<std::string>(text))), record_words);
}

// A buffer for which the shader has no output at all.
bool hasNoOutput(const frontend::Shader& shader, const Prepared& original, int draw_buffer) {
  if (shader.outputs.empty()) return !shader.traits.uses_frag_color && !shader.traits.uses_frag_data;
  return std::find(original.output_locations.begin(), original.output_locations.end(), draw_buffer) ==
         original.output_locations.end();
}

void compareFilled(Session& session, UndefinedOutputs& found) {
  const Outputs one = drawnFilled(session, kFills[0], found.record_words);
  const Outputs other = drawnFilled(session, kFills[1], found.record_words);
  for (std::size_t i = 0; i < found.original.size() && i < one.size() && i < other.size(); ++i) {
    if (one[i].size() != found.original[i].size() || other[i].size() != one[i].size()) continue;
    for (std::size_t c = 0; c < one[i].size(); ++c) {
      if (one[i][c] != other[i][c]) found.undefined[i][c] = true;
    }
  }
}

}  // namespace

bool tellsUndefinedOutputs(Session& session) {
  if (session.stage() == Stage::fragment) return session.facts().layers <= 1 && session.facts().samples <= 1;
  return session.stage() == Stage::vertex || session.stage() == Stage::tess_eval;
}

UndefinedOutputs findUndefinedOutputs(Session& session) {
  UndefinedOutputs found;
  const Prepared original = session.prepareOriginal();
  const Execution execution = drawn(session, original);
  found.record_words = execution.feedback_words;
  found.original = outputsOf(execution, found.record_words);
  for (const std::vector<std::uint32_t>& words : found.original)
    found.undefined.emplace_back(words.size(), false);
  for (std::size_t i = 0; i < execution.outputs.size(); ++i) {
    if (hasNoOutput(session.shader(Stage::fragment), original, execution.outputs[i].draw_buffer))
      found.undefined[i].assign(found.undefined[i].size(), true);
  }
  try {
    compareFilled(session, found);
  } catch (const Error& error) {
    if (error.outcome() != Outcome::cannot_debug) throw;
  }
  for (const std::vector<bool>& one : found.undefined) {
    found.count += static_cast<std::uint64_t>(std::count(one.begin(), one.end(), true));
  }
  return found;
}

std::uint64_t differingDefined(const UndefinedOutputs& undefined, const Execution& execution) {
  const Outputs outputs = outputsOf(execution, undefined.record_words);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < undefined.original.size(); ++i) {
    const std::vector<std::uint32_t>& expected = undefined.original[i];
    for (std::size_t c = 0; c < expected.size(); ++c) {
      const bool there = i < outputs.size() && c < outputs[i].size();
      count += !undefined.undefined[i][c] && !(there && outputs[i][c] == expected[c]);
    }
    if (i < outputs.size() && outputs[i].size() > expected.size())
      count += outputs[i].size() - expected.size();
  }
  return count;
}

}  // namespace shadestep::session
