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
    auto instrumented =
        instrumenter::instrumentLoops(session.shader(), batch, session.target());
    if (const auto* shader = std::get_if<instrumenter::AttachmentShader>(&instrumented))
      return session.capture(*shader);
    if (count <= 1) throw Error(Outcome::cannot_debug, std::get<instrumenter::Failure>(instrumented).reason);
  }
}

LoopReport reportOf(const Shader& shader, StatementId id, const Captured& captured, std::size_t number,
                    const std::vector<std::uint8_t>& marks) {
  const std::size_t pixels = captured.threads.count();
  LoopReport loop;
  loop.statement = id;
  const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(id)];
  loop.line = statement.place.line;
  loop.function = shader.functions[static_cast<std::size_t>(statement.function)].name;
  loop.iterations.assign(pixels, 0);
  loop.longest.assign(pixels, 0);
  std::vector<std::uint32_t> longest;
  std::uint64_t sum = 0;
  std::vector<instrumenter::FieldDecoder> decoders;
  for (std::size_t which = 0; which < kFields; ++which)
    decoders.emplace_back(captured.layout, captured.layout.fields[number * kFields + which]);
  std::vector<std::uint32_t> words(static_cast<std::size_t>(captured.threads.words()));
  for (std::size_t p = 0; p < pixels; ++p) {
    if (marks[p] == 0) continue;
    captured.threads.read(p, words.data());
    const auto field = [&](std::size_t which) {
      std::uint32_t value = 0;
      decoders[which].decode(words.data(), &value);
      return value;
    };
    const std::uint32_t entries = field(0);
    if (entries == 0) continue;
    ++loop.threads;
    loop.entries = std::max(loop.entries, entries);
    loop.iterations[p] = field(1);
    loop.max = std::max(loop.max, loop.iterations[p]);
    sum += loop.iterations[p];
    loop.longest[p] = field(2);
    longest.push_back(loop.longest[p]);
    loop.cut += field(3) > 0 ? 1 : 0;
  }
  if (loop.threads > 0) loop.mean = static_cast<double>(sum) / static_cast<double>(loop.threads);
  countPerIteration(loop, longest);
  return loop;
}

}  // namespace

LoopsReport profileLoops(Session& session, int line, const std::vector<std::uint8_t>& only) {
  const Shader& shader = session.shader();
  const std::vector<StatementId> loops = selectLoops(shader, line);
  LoopsReport report;
  while (report.loops.size() < loops.size()) {
    const Captured captured = captureLoops(session, loops, report.loops.size());
    if (report.loops.empty()) {
      report.width = captured.threads.width();
      report.height = captured.threads.height();
      for (std::size_t p = 0; p < captured.threads.count(); ++p) {
        const auto mark = instrumenter::decodeMark(captured.layout, captured.threads.head(p));
        const bool wanted = only.empty() || only.at(p) != 0;
        report.marks.push_back(wanted ? static_cast<std::uint8_t>(mark) : 0);
      }
      report.check = captured.execution.check;
    } else {
      report.check.merge(captured.execution.check);
    }
    const std::size_t taken = captured.layout.fields.size() / kFields;
    for (std::size_t l = 0; l < taken; ++l)
      report.loops.push_back(reportOf(shader, loops[report.loops.size()], captured, l, report.marks));
  }
  return report;
}

}  // namespace shadestep::session
