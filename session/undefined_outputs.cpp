#include "session/undefined_outputs.h"

#include <algorithm>

namespace shadestep::session {
namespace {

constexpr int kFills[] = {1, 3};  // quarters: not 0 and 1, at which blending may saturate

std::vector<ColorOutput> drawn(Session& session, const Prepared& prepared) {
  ExecuteOptions options;
  options.compare = false;
  options.read_outputs = true;
  return session.execute(prepared, options).outputs;
}

std::vector<ColorOutput> drawnFilled(Session& session, int fill) {
  const auto text =
      instrumenter::instrumentFilledOutputs(session.shader(Stage::fragment), session.target(), fill);
  if (const auto* failure = std::get_if<instrumenter::Failure>(&text)) {
    throw Error(Outcome::cannot_debug, failure->reason);
  }
  return drawn(session, session.prepareText(std::get<std::string>(text)));
}

// A buffer for which the shader has no output at all.
bool hasNoOutput(const frontend::Shader& shader, const Prepared& original, int draw_buffer) {
  if (shader.outputs.empty()) return !shader.traits.uses_frag_color && !shader.traits.uses_frag_data;
  return std::find(original.output_locations.begin(), original.output_locations.end(), draw_buffer) ==
         original.output_locations.end();
}

void compareFilled(Session& session, UndefinedOutputs& found) {
  const std::vector<ColorOutput> one = drawnFilled(session, kFills[0]);
  const std::vector<ColorOutput> other = drawnFilled(session, kFills[1]);
  for (std::size_t i = 0; i < found.original.size() && i < one.size() && i < other.size(); ++i) {
    for (std::size_t c = 0; c < found.undefined[i].size(); ++c) {
      if (one[i].words[c] != other[i].words[c]) found.undefined[i][c] = true;
    }
  }
}

}  // namespace

UndefinedOutputs findUndefinedOutputs(Session& session) {
  UndefinedOutputs found;
  const Prepared original = session.prepareOriginal();
  found.original = drawn(session, original);
  for (const ColorOutput& output : found.original) {
    const bool none = hasNoOutput(session.shader(Stage::fragment), original, output.draw_buffer);
    found.undefined.emplace_back(output.words.size(), none);
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

std::uint64_t differingDefined(const UndefinedOutputs& undefined, const std::vector<ColorOutput>& outputs) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < undefined.original.size() && i < outputs.size(); ++i) {
    const std::vector<std::uint32_t>& expected = undefined.original[i].words;
    for (std::size_t c = 0; c < expected.size() && c < outputs[i].words.size(); ++c) {
      count += !undefined.undefined[i][c] && outputs[i].words[c] != expected[c];
    }
  }
  return count;
}

}  // namespace shadestep::session
