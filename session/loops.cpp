#include "session/loops.h"

#include <algorithm>

#include "instrumenter/measures.h"

namespace shadestep::session {
namespace {

constexpr std::size_t kFields = 4;  // of instrumentLoops, per loop

using frontend::Shader;
using frontend::StatementId;
using frontend::StatementKind;

bool isLoop(const frontend::Statement& statement) {
  return statement.kind == StatementKind::for_ || statement.kind == StatementKind::while_ ||
         statement.kind == StatementKind::do_while;
}

std::vector<StatementId> selectLoops(const Shader& shader, int line) {
  std::vector<StatementId> chosen;
  std::string present;
  for (std::size_t id = 0; id < shader.statements.size(); ++id) {
    const frontend::Statement& statement = shader.statements[id];
    if (!isLoop(statement)) continue;
    present += (present.empty() ? "" : ", ") + std::to_string(statement.place.line);
    if (line <= 0 || statement.place.line == line) chosen.push_back(static_cast<StatementId>(id));
  }
  if (present.empty()) throw Error(Outcome::nothing_matches, "the shader has no loop");
  if (chosen.empty()) {
    throw Error(Outcome::nothing_matches,
                "no loop at line " + std::to_string(line) + "; there are loops at line " + present);
  }
  return chosen;
}

// Counts, from the longest entry of each thread, who begins iteration i and who goes no further.
void countPerIteration(LoopReport& loop, const std::vector<std::uint32_t>& longest) {
  const std::uint32_t most = longest.empty() ? 0 : *std::max_element(longest.begin(), longest.end());
  loop.left.assign(most, 0);
  loop.active.assign(most, 0);
  for (const std::uint32_t length : longest) {
    if (length > 0) ++loop.left[length - 1];
  }
  std::uint64_t active = 0;
  for (std::size_t i = most; i-- > 0;) {
    active += loop.left[i];
    loop.active[i] = active;
  }
}

// As many of the loops from `first` on as one draw's buffers hold.
Captured captureLoops(Session& session, const std::vector<StatementId>& loops, std::size_t first) {
  for (std::size_t count = loops.size() - first;; count /= 2) {
    const std::vector<StatementId> batch(
        loops.begin() + static_cast<std::ptrdiff_t>(first),
        loops.begin() + static_cast<std::ptrdiff_t>(first + std::max<std::size_t>(count, 1)));
    auto instrumented = instrumenter::instrumentLoops(session.shader(), batch, session.target());
    if (const auto* shader = std::get_if<instrumenter::AttachmentShader>(&instrumented))
      return session.capture(*shader);
    if (count <= 1) throw Error(Outcome::cannot_debug, std::get<instrumenter::Failure>(instrumented).reason);
  }
}

// `fields`: those of the loop, in instrumentLoops's order.
LoopReport reportOf(const Shader& shader, StatementId id, const std::vector<std::uint8_t>& marks,
                    const WatchedValues* fields) {
  const std::size_t threads = marks.size();
  LoopReport loop;
  loop.statement = id;
  const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(id)];
  loop.line = statement.place.line;
  loop.function = shader.functions[static_cast<std::size_t>(statement.function)].name;
  loop.iterations.assign(threads, 0);
  loop.longest.assign(threads, 0);
  std::vector<std::uint32_t> longest;
  std::uint64_t sum = 0;
  for (std::size_t t = 0; t < threads; ++t) {
    const std::uint32_t entries = *fields[0].at(t);
    if (marks[t] == 0 || entries == 0) continue;
    ++loop.threads;
    loop.entries = std::max(loop.entries, entries);
    loop.iterations[t] = *fields[1].at(t);
    loop.max = std::max(loop.max, loop.iterations[t]);
    sum += loop.iterations[t];
    loop.longest[t] = *fields[2].at(t);
    longest.push_back(loop.longest[t]);
    loop.cut += *fields[3].at(t) > 0 ? 1 : 0;
  }
  if (loop.threads > 0) loop.mean = static_cast<double>(sum) / static_cast<double>(loop.threads);
  countPerIteration(loop, longest);
  return loop;
}

// The threads that `only` names, or all.
std::vector<std::uint8_t> wantedMarks(const ThreadValues& threads, const std::vector<std::uint8_t>& only) {
  std::vector<std::uint8_t> marks;
  for (std::size_t t = 0; t < threads.marks.size(); ++t) {
    const bool wanted = only.empty() || only.at(t) != 0;
    marks.push_back(wanted ? threads.marks[t] : std::uint8_t{0});
  }
  return marks;
}

}  // namespace

LoopsReport profileLoops(Session& session, int line, const std::vector<std::uint8_t>& only) {
  session.requireCapturable();
  const Shader& shader = session.shader();
  const std::vector<StatementId> loops = selectLoops(shader, line);
  ThreadValues threads;
  while (threads.values.size() < loops.size() * kFields) {
    const Captured captured = captureLoops(session, loops, threads.values.size() / kFields);
    addPass(threads, captured.threads, captured.layout, captured.execution.check);
  }
  if (only.empty() && session.stage() != Stage::fragment)
    nameThreads(threads, session.stage(), session.stop());
  LoopsReport report;
  report.width = threads.width;
  report.height = threads.height;
  report.marks = wantedMarks(threads, only);
  report.check = std::move(threads.check);
  for (std::size_t l = 0; l < loops.size(); ++l)
    report.loops.push_back(reportOf(shader, loops[l], report.marks, &threads.values[l * kFields]));
  report.identity = std::move(threads.identity);
  return report;
}

}  // namespace shadestep::session
