#include "session/window.h"

#include <algorithm>
#include <deque>

namespace shadestep::session {

using instrumenter::Probe;

namespace {

constexpr std::uint32_t kInt = 0x1404;  // GL_INT

bool samePlace(const Probe& a, const Probe& b) {
  return a.statement == b.statement && a.when == b.when && a.inside == b.inside &&
         a.call_path == b.call_path && a.iterations.size() == b.iterations.size();
}

bool captures(const Probe& probe, const Probe& wanted) {
  const auto watched = [&](const frontend::Watch& watch) {
    return std::any_of(probe.watches.begin(), probe.watches.end(),
                       [&](const frontend::Watch& one) { return one.expression == watch.expression; });
  };
  return (probe.outcome || !wanted.outcome) &&
         std::all_of(wanted.watches.begin(), wanted.watches.end(), watched);
}

instrumenter::WindowShader instrumented(Session& session, const std::vector<Probe>& probes) {
  auto result = instrumenter::instrumentWindow(session.shader(), probes, session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&result))
    throw Error(Outcome::cannot_debug, failure->reason);
  return std::get<instrumenter::WindowShader>(std::move(result));
}

}  // namespace

bool probeServes(const Probe& probe, const Probe& wanted) {
  return samePlace(probe, wanted) && captures(probe, wanted);
}

Window::Window(Session& session, std::vector<Probe> probes) : session_(session), probes_(std::move(probes)) {
  instrumenter::WindowShader shader = instrumented(session, probes_);
  layout_ = std::move(shader.layout);
  prepared_ = session.prepare(instrumenter::AttachmentShader{std::move(shader.text), layout_.capture});
}

std::size_t Window::find(const Probe& wanted) const {
  const auto found = std::find_if(probes_.begin(), probes_.end(),
                                  [&](const Probe& probe) { return probeServes(probe, wanted); });
  return static_cast<std::size_t>(found - probes_.begin());
}

ThreadValues Window::valuesAt(const Probe& wanted) {
  const std::size_t chosen = find(wanted);
  ExecuteOptions options;
  options.uniforms.push_back({layout_.probe_uniform, kInt, {static_cast<std::uint32_t>(chosen)}});
  for (std::size_t i = 0; i < wanted.iterations.size(); ++i)
    options.uniforms.push_back(
        {layout_.iteration_uniforms[i], kInt, {static_cast<std::uint32_t>(wanted.iterations[i])}});
  const Captured captured = session_.capture(prepared_, layout_.probes[chosen], options);
  if (!captured.execution.times.empty()) draw_time_ = captured.execution.times.front();

  ThreadValues values;
  values.statement = wanted.statement;
  addPass(values, captured.threads, captured.layout, captured.execution.check);
  if (session_.stage() != Stage::fragment) nameThreads(values, session_.stage(), session_.stop());
  return values;
}

Probe probeAt(const frontend::Shader& shader, const Position& position) {
  Probe probe;
  if (const frontend::CallId call = Navigation(shader).callDone(position); call != frontend::kNone) {
    probe.inside = shader.calls[static_cast<std::size_t>(call)].close;
    probe.when = Probe::When::after;
    probe.statement = position.statement;
    probe.call_path = position.call_path;
    probe.iterations = position.iterations;
    return probe;
  }
  probe.when = position.condition ? Probe::When::after : Probe::When::before;
  probe.outcome = position.condition;
  probe.statement = position.statement;
  probe.call_path = position.call_path;
  probe.iterations = position.iterations;
  return probe;
}

namespace {

Position positionOf(const frontend::Shader& shader, const Probe& probe) {
  Position position;
  position.call_path = probe.call_path;
  position.statement = probe.statement;
  position.iterations = probe.iterations;
  position.condition = probe.outcome && probe.inside == frontend::kNone;
  for (const frontend::CallId call : shader.statements[static_cast<std::size_t>(probe.statement)].calls)
    if (shader.calls[static_cast<std::size_t>(call)].close == probe.inside)
      return Navigation(shader).afterCall(position, call);
  return position;
}

void watchInScope(const frontend::Shader& shader, const std::vector<std::string>& names, Probe& probe) {
  probe.watches.clear();
  for (const std::string& name : names) {
    frontend::WatchResult found = watchAt(shader, probe, name);
    if (found.watch && frontend::wordCount(found.watch->type) > 0)
      probe.watches.push_back(std::move(*found.watch));
  }
}

}  // namespace

std::vector<Probe> probesAround(const frontend::Shader& shader, const Probe& first,
                                const std::vector<std::string>& names, std::size_t most) {
  const Navigation navigation(shader);
  std::vector<Probe> probes;
  const auto add = [&](Probe probe) {
    const auto same = [&](const Probe& known) { return samePlace(known, probe); };
    if (std::any_of(probes.begin(), probes.end(), same)) return false;
    watchInScope(shader, names, probe);
    probes.push_back(std::move(probe));
    return true;
  };
  std::deque<Position> ahead;
  const auto goOn = [&](const Position& position) {
    for (const Side& side : navigation.sides(position)) ahead.push_back(side.next);
    if (position.condition) return;
    ahead.push_back(navigation.over(position));
    ahead.push_back(navigation.into(position));
  };
  add(first);
  // Steps lead from one iteration to another; where any iteration is meant, there are none.
  if (first.iterations.size() == instrumenter::numberedLoops(shader, first).size())
    goOn(positionOf(shader, first));
  while (!ahead.empty() && probes.size() < most) {
    const Position position = std::move(ahead.front());
    ahead.pop_front();
    if (!position.ended() && add(probeAt(shader, position))) goOn(position);
  }
  return probes;
}

}  // namespace shadestep::session
