#include "session/loops.h"

#include <algorithm>

namespace shadestep::session {
namespace {

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
  if (present.empty()) throw Error(Outcome::nothing_matches, "the fragment shader has no loop");
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

}  // namespace

LoopsReport profileLoops(Session& session, int line) {
  const Shader& shader = session.shader(Stage::fragment);
  const std::vector<StatementId> loops = selectLoops(shader, line);
  LoopsReport report;
  std::size_t done = 0;
  while (done < loops.size()) {
    const std::vector<StatementId> rest(loops.begin() + static_cast<std::ptrdiff_t>(done), loops.end());
    auto instrumented = instrumenter::instrumentLoops(shader, rest, session.target());
    if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) {
      throw Error(Outcome::cannot_debug, failure->reason);
    }
    const Captured captured = session.capture(std::get<instrumenter::AttachmentShader>(instrumented));
    const auto& fields = captured.layout.fields;
    const std::size_t taken = fields.size() / 3;
    if (taken == 0) {
      throw Error(Outcome::cannot_debug,
                  "the driver's " + std::to_string(session.facts().max_draw_buffers) +
                      " draw buffers (GL_MAX_DRAW_BUFFERS) leave no room for loop counters");
    }
    const std::size_t pixels =
        static_cast<std::size_t>(captured.threads.width) * static_cast<std::size_t>(captured.threads.height);
    const std::size_t stride = static_cast<std::size_t>(captured.layout.words);
    if (done == 0) {
      report.width = captured.threads.width;
      report.height = captured.threads.height;
      report.marks.resize(pixels);
      for (std::size_t p = 0; p < pixels; ++p) {
        report.marks[p] = static_cast<std::uint8_t>(
            instrumenter::decodeMark(captured.layout, captured.threads.data.data() + p * stride));
      }
      report.check = captured.execution.check;
    } else {
      report.check.merge(captured.execution.check);
    }
    for (std::size_t l = 0; l < taken; ++l) {
      LoopReport loop;
      loop.statement = rest[l];
      const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(loop.statement)];
      loop.line = statement.place.line;
      loop.function = shader.functions[static_cast<std::size_t>(statement.function)].name;
      loop.iterations.assign(pixels, 0);
      std::vector<std::uint32_t> longest;
      std::uint64_t sum = 0;
      for (std::size_t p = 0; p < pixels; ++p) {
        if (report.marks[p] == 0) continue;
        const std::uint32_t* words = captured.threads.data.data() + p * stride;
        const auto field = [&](std::size_t which) {
          return instrumenter::decode(captured.layout, fields[l * 3 + which], words).words.at(0);
        };
        const std::uint32_t entries = field(0);
        if (entries == 0) continue;
        ++loop.threads;
        loop.entries = std::max(loop.entries, entries);
        loop.iterations[p] = field(1);
        loop.max = std::max(loop.max, loop.iterations[p]);
        sum += loop.iterations[p];
        longest.push_back(field(2));
      }
      if (loop.threads > 0) loop.mean = static_cast<double>(sum) / static_cast<double>(loop.threads);
      countPerIteration(loop, longest);
      report.loops.push_back(std::move(loop));
    }
    done += taken;
  }
  return report;
}

}  // namespace shadestep::session
