#include "session/verify_measures.h"

#include <algorithm>
#include <optional>
#include <set>

#include "instrumenter/measures.h"
#include "session/loops.h"

namespace shadestep::session {
namespace {

using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using instrumenter::Event;
using Kind = VerifyFailure::Kind;

bool isLoop(const Statement& statement) {
  return statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
         statement.kind == StatementKind::do_while;
}

// The event that has one record each time that the statement runs, or that its condition is evaluated.
Event eventOf(const Statement& statement) {
  switch (statement.kind) {
    case StatementKind::if_:
    case StatementKind::switch_:
    case StatementKind::for_:
    case StatementKind::while_:
    case StatementKind::do_while:
      return Event::condition;
    case StatementKind::return_:
      return Event::return_;
    case StatementKind::break_:
    case StatementKind::continue_:
    case StatementKind::discard:
      return Event::jump;
    default:
      return Event::statement;
  }
}

std::uint32_t records(const RecordedThread& one, StatementId id, Event event) {
  std::uint32_t count = 0;
  for (const instrumenter::Record& record : one.run().records) {
    const auto& layout = one.recorded.layout.records[static_cast<std::size_t>(record.layout)];
    if (layout.statement == id && layout.event == event) ++count;
  }
  return count;
}

// `counted`: nothing where the pass does not show the thread.
void expect(Findings& findings, const Statement& at, const std::string& plan, const RecordedThread& one,
            std::optional<std::uint32_t> counted, std::uint32_t recorded) {
  findings.compared();
  if (counted == recorded) return;
  findings.fail(Kind::value, &at, plan, "",
                where(one.chosen.name) + ": " +
                    (counted ? "counted " + std::to_string(*counted) : "the pass does not show it") +
                    ", recorded " + std::to_string(recorded));
}

// The functions that the initializers of globals call: a count has those runs too, a recording begins with
// main.
std::set<frontend::FunctionId> runBeforeMain(const Shader& shader) {
  std::set<frontend::FunctionId> found;
  for (const frontend::Call& call : shader.calls)
    if (call.statement == frontend::kNone) found.insert(call.callee);
  for (std::size_t known = 0; known != found.size();) {
    known = found.size();
    for (const frontend::Call& call : shader.calls)
      if (found.contains(call.caller)) found.insert(call.callee);
  }
  return found;
}

}  // namespace

void checkLoops(Session& session, Findings& findings, const std::vector<RecordedThread>& recorded) {
  const Shader& shader = session.shader();
  if (std::none_of(shader.statements.begin(), shader.statements.end(), isLoop)) return;
  LoopsReport report;
  if (!findings.attempt(nullptr, "loops", [&] { report = profileLoops(session); })) return;
  if (!findings.checkOutputs(nullptr, "loops", report.check)) return;
  ThreadValues threads;
  threads.width = report.width;
  threads.height = report.height;
  threads.marks = report.marks;
  threads.identity = report.identity;
  for (const LoopReport& loop : report.loops) {
    const Statement& at = shader.statements[static_cast<std::size_t>(loop.statement)];
    for (const RecordedThread& one : recorded) {
      const auto place = threads.find(one.chosen.name);
      expect(findings, at, "loops", one, place ? std::optional(loop.iterations.at(*place)) : std::nullopt,
             records(one, loop.statement, Event::iteration));
    }
  }
}

void checkCounts(Session& session, Findings& findings, const std::vector<RecordedThread>& recorded,
                 std::size_t most) {
  const Shader& shader = session.shader();
  const std::set<frontend::FunctionId> before_main = runBeforeMain(shader);
  std::vector<StatementId> all;
  for (std::size_t id = 0; id < shader.statements.size(); ++id) {
    const Statement& at = shader.statements[id];
    if (at.function != frontend::kNone && !before_main.contains(at.function) &&
        at.kind != StatementKind::block && at.kind != StatementKind::case_label && !isForInit(shader, at))
      all.push_back(static_cast<StatementId>(id));
  }
  std::vector<StatementId> chosen;
  const std::size_t stride = (all.size() + most - 1) / std::max<std::size_t>(most, 1);
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(stride, 1)) chosen.push_back(all[i]);
  if (chosen.empty()) return;

  ThreadValues threads;
  if (!findings.attempt(nullptr, "count", [&] {
        std::vector<instrumenter::Counted> runs;
        for (const StatementId id : chosen) runs.push_back({instrumenter::Counted::Kind::runs, id});
        auto result = instrumenter::instrumentCount(shader, runs, session.target());
        if (const auto* failure = std::get_if<instrumenter::Failure>(&result))
          throw Error(Outcome::cannot_debug, failure->reason);
        threads = onePass(session, std::get<instrumenter::AttachmentShader>(result));
      }))
    return;
  if (!findings.checkOutputs(nullptr, "count", threads.check)) return;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const StatementId id = chosen[i];
    const Statement& at = shader.statements[static_cast<std::size_t>(id)];
    for (const RecordedThread& one : recorded) {
      const auto place = threads.find(one.chosen.name);
      expect(findings, at, "count", one,
             place ? std::optional(*threads.values.at(i).at(*place)) : std::nullopt,
             records(one, id, eventOf(at)));
    }
  }
}

void checkClock(Session& session, Findings& findings) {
  if (session.stage() != Stage::fragment) return;
  const auto result = instrumenter::instrumentClock(session.shader(), session.target());
  const auto* shader = std::get_if<instrumenter::AttachmentShader>(&result);
  if (shader == nullptr) return;
  findings.attempt(nullptr, "clock", [&] {
    findings.checkOutputs(nullptr, "clock", session.capture(*shader).execution.check);
  });
}

}  // namespace shadestep::session
