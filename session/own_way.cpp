#include "session/own_way.h"

#include <algorithm>

#include "session/run_positions.h"
#include "session/window.h"

namespace shadestep::session {
namespace {

bool isKnown(const frontend::Shader& shader, const Position& position) {
  if (position.ended()) return false;
  const auto& statement = shader.statements[static_cast<std::size_t>(position.statement)];
  return statement.function == shader.main || !position.call_path.empty();
}

}  // namespace

void leaveOutUnwritten(const frontend::Shader& shader, const Position& position, ThreadValues& threads) {
  if (!isKnown(shader, position)) return;
  for (WatchedValues& one : threads.values) {
    const auto watch = watchAt(shader, probeAt(shader, position), one.name).watch;
    if (one.no_value.empty() && watch && !mayBeWritten(shader, position, *watch))
      one.no_value = "no thread has written it on the way here";
  }
}

bool OwnWay::hasWritten(const Position& position, const std::string& name) {
  const frontend::Shader& shader = session_.shader();
  if (!isKnown(shader, position)) return true;
  const auto watch = watchAt(shader, probeAt(shader, position), name).watch;
  if (!watch || session::hasWritten(shader, {}, 0, position, *watch)) return true;
  if (!recorded_) {
    recorded_ = true;
    try {
      const bool fragment = session_.stage() == Stage::fragment;
      steps_ = (fragment ? followPixel(session_, thread_[0].second, thread_[1].second)
                         : followThread(session_, thread_))
                   .steps;
      positions_ = positionsOf(shader, steps_);
    } catch (const Error& error) {
      if (error.outcome() == Outcome::ended || error.outcome() == Outcome::failed) throw;
    }
  }
  const auto step = stepOf(position);
  return !step || session::hasWritten(shader, steps_, *step, position, *watch);
}

std::optional<std::size_t> OwnWay::stepOf(const Position& position) const {
  const frontend::Shader& shader = session_.shader();
  const auto& iterations = position.iterations;
  if (iterations.size() >= instrumenter::numberedLoops(shader, probeAt(shader, position)).size())
    return stepAt(positions_, position);
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (!positions_[i] || positions_[i]->statement != position.statement ||
        positions_[i]->call_path != position.call_path)
      continue;
    const auto& there = positions_[i]->iterations;
    if (there.size() >= iterations.size() && std::equal(iterations.begin(), iterations.end(), there.begin()))
      last = i;
  }
  return last;
}

}  // namespace shadestep::session
