#include "session/thread_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <span>

#include "glsl-frontend/watch.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::kNone;
using frontend::Shader;
using frontend::StatementId;
using frontend::StatementKind;
using instrumenter::Probe;

std::string lineRange(const Shader& shader) {
  int first = 0;
  int last = 0;
  for (const frontend::Statement& statement : shader.statements) {
    if (statement.kind == StatementKind::block || statement.place.line <= 0) continue;
    if (first == 0 || statement.place.line < first) first = statement.place.line;
    last = std::max(last, statement.place.line);
  }
  return "lines " + std::to_string(first) + " to " + std::to_string(last) + " hold statements";
}

StatementId statementAt(const Shader& shader, int line, int column) {
  const std::vector<StatementId> candidates = frontend::statementsAt(shader, line, column);
  if (candidates.empty()) {
    throw Error(Outcome::nothing_matches,
                "no statement at line " + std::to_string(line) +
                    (column > 0 ? ", column " + std::to_string(column) : std::string()) + "; " +
                    lineRange(shader) + " ('shadestep source' lists them)");
  }
  return candidates.front();
}

// The calls from main to the function, one per line of the user's --call, outermost first.
std::vector<frontend::CallId> callPath(const Shader& shader, frontend::FunctionId target,
                                       const std::vector<int>& lines) {
  std::vector<frontend::CallId> path;
  frontend::FunctionId in = shader.main;
  for (const int line : lines) {
    frontend::CallId found = kNone;
    std::string present;
    for (std::size_t id = 0; id < shader.calls.size(); ++id) {
      const frontend::Call& call = shader.calls[id];
      if (call.caller != in) continue;
      const int at = shader.tokens[static_cast<std::size_t>(call.name)].place.line;
      present += (present.empty() ? "" : ", ") + std::to_string(at);
      if (at == line && found == kNone) found = static_cast<frontend::CallId>(id);
    }
    const std::string& name = shader.functions[static_cast<std::size_t>(in)].name;
    if (found == kNone) {
      throw Error(Outcome::nothing_matches,
                  "'" + name + "' calls no function at line " + std::to_string(line) +
                      (present.empty() ? "; it calls none" : "; it does at line " + present));
    }
    path.push_back(found);
    in = shader.calls[static_cast<std::size_t>(found)].callee;
  }
  if (!lines.empty() && in != target) {
    throw Error(Outcome::nothing_matches, "the calls of --call lead to '" +
                                              shader.functions[static_cast<std::size_t>(in)].name +
                                              "', but the line is in '" +
                                              shader.functions[static_cast<std::size_t>(target)].name + "'");
  }
  return path;
}

}  // namespace

Probe probeAt(const Shader& shader, const PlaceSelection& place) {
  Probe probe;
  probe.statement = statementAt(shader, place.line, place.column);
  probe.when = place.after ? Probe::When::after : Probe::When::before;
  const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(probe.statement)];
  probe.call_path = callPath(shader, statement.function, place.call_lines);

  const std::size_t loops = instrumenter::numberedLoops(shader, probe).size();
  // A function that is looked at through any call may lie in loops of its callers that are not known here.
  const bool any_call = probe.call_path.empty() && statement.function != shader.main;
  if (place.iteration.size() > loops && !any_call) {
    throw Error(Outcome::nothing_matches, "line " + std::to_string(place.line) + " lies in " +
                                              std::to_string(loops) + (loops == 1 ? " loop" : " loops") +
                                              "; --iteration gave " + std::to_string(place.iteration.size()) +
                                              " numbers");
  }
  if (any_call && place.iteration.size() > loops) {
    throw Error(Outcome::nothing_matches,
                "line " + std::to_string(place.line) + " is in the function '" +
                    shader.functions[static_cast<std::size_t>(statement.function)].name +
                    "': say with --call from which line it is called, so that the loops of "
                    "its callers can be counted");
  }
  probe.iterations = place.iteration;
  return probe;
}

ThreadValues valuesAt(Session& session, const PlaceSelection& place,
                      const std::vector<std::string>& watches) {
  return valuesAt(session, probeAt(session.shader(), place), watches);
}

// Inside of a declaration's own expressions its names are not there yet; in the head of a `for` those of its
// init are.
frontend::WatchResult watchAt(const Shader& shader, const Probe& probe, const std::string& name) {
  const bool in_head =
      shader.statements[static_cast<std::size_t>(probe.statement)].kind == StatementKind::for_;
  const bool behind = probe.when == Probe::When::after && (probe.inside == kNone || in_head);
  return behind ? frontend::resolveWatchAfter(shader, probe.statement, name)
                : frontend::resolveWatch(shader, probe.statement, name);
}

StatementId scopeAt(const Shader& shader, const Probe& probe) {
  const frontend::Statement& statement = shader.statements[static_cast<std::size_t>(probe.statement)];
  const bool in_head = statement.kind == StatementKind::for_ && probe.when == Probe::When::after;
  // A variable that the condition declares is in the body's scope, but not yet there when its value is
  // evaluated.
  return in_head && !statement.condition_declares ? statement.children.back() : probe.statement;
}

std::vector<frontend::Watch> watchesAt(const Shader& shader, const Probe& probe,
                                       const std::vector<std::string>& names) {
  std::vector<frontend::Watch> watches;
  for (const std::string& text : names) {
    frontend::WatchResult resolved = watchAt(shader, probe, text);
    if (!resolved.watch) throw Error(Outcome::nothing_matches, resolved.error);
    if (frontend::wordCount(resolved.watch->type) == 0) {
      throw Error(Outcome::nothing_matches, "'" + text + "' is a " + glslName(resolved.watch->type) +
                                                ", which holds no value to print");
    }
    watches.push_back(std::move(*resolved.watch));
  }
  return watches;
}

namespace {

constexpr std::size_t kBlock = 512;  // threads whose words stay in the nearest cache
constexpr std::uint8_t kAnyMark = 0xFF;

// Fields of all threads, to be filled in block by block.
struct FieldValues {
  FieldValues(const instrumenter::AttachmentLayout& layout, const std::vector<instrumenter::Field>& fields,
              std::size_t threads) {
    for (const instrumenter::Field& field : fields) {
      decoders.emplace_back(layout, field);
      const std::size_t words = decoders.back().words();
      values.push_back({field.name, field.type, words, std::vector<std::uint32_t>(threads * words)});
    }
  }
  // Of a block that begins with thread `first`, those of its threads whose marks have one of `bits`.
  void decode(std::size_t first, const ThreadWords::Block& block, std::span<const std::uint8_t> marks,
              std::uint8_t bits) {
    const bool all =
        std::all_of(marks.begin(), marks.end(), [&](std::uint8_t mark) { return (mark & bits) != 0; });
    for (std::size_t f = 0; f < decoders.size(); ++f) {
      const std::size_t stride = values[f].stride;
      std::uint32_t* to = values[f].words.data() + first * stride;
      if (all) decoders[f].decode(block.words, block.stride, marks.size(), to);
      for (std::size_t i = 0; !all && i < marks.size(); ++i)
        if ((marks[i] & bits) != 0) decoders[f].decode(block.at(i), to + i * stride);
    }
  }
  std::vector<instrumenter::FieldDecoder> decoders;
  std::vector<WatchedValues> values;
};

[[noreturn]] void disagree() {
  throw Unsteady(
      "two passes of one probe disagree about which threads got there; "
      "the draw does not repeat exactly, so its values cannot be trusted");
}

void requireSameThreads(const std::vector<WatchedValues>& known, const std::vector<WatchedValues>& now) {
  for (std::size_t i = 0; i < std::min(known.size(), now.size()); ++i)
    if (now[i].words != known[i].words) disagree();
}

}  // namespace

void addPass(ThreadValues& result, const ThreadWords& threads, const instrumenter::AttachmentLayout& layout,
             const Check& check) {
  const bool first = result.marks.empty();
  if (first) {
    result.width = threads.width();
    result.height = threads.height();
    result.marks.resize(threads.count());
    result.check = check;
  } else {
    result.check.merge(check);
    if (threads.count() != result.marks.size()) disagree();
  }
  FieldValues fields(layout, layout.fields, threads.count());
  FieldValues identity(layout, layout.identity, threads.count());
  std::vector<std::uint32_t> scratch;
  for (std::size_t at = 0; at < threads.count(); at += kBlock) {
    const std::size_t count = std::min(kBlock, threads.count() - at);
    const ThreadWords::Block block = threads.block(at, count, scratch);
    const std::span<std::uint8_t> marks(result.marks.data() + at, count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto mark = static_cast<std::uint8_t>(instrumenter::decodeMark(layout, block.at(i)));
      if (!first && mark != marks[i]) disagree();
      marks[i] = mark;
      if (!first) continue;
      result.launched += mark != 0 ? 1 : 0;
      result.reached += (mark & instrumenter::kReached) != 0 ? 1 : 0;
      result.discarded += (mark & instrumenter::kDiscarded) != 0 ? 1 : 0;
    }
    identity.decode(at, block, marks, kAnyMark);
    fields.decode(at, block, marks, instrumenter::kReached);
  }
  if (first)
    result.identity = std::move(identity.values);
  else
    requireSameThreads(result.identity, identity.values);
  std::move(fields.values.begin(), fields.values.end(), std::back_inserter(result.values));
}

void join(ThreadValues& all, ThreadValues&& part) {
  if (part.marks != all.marks) disagree();
  requireSameThreads(all.identity, part.identity);
  all.check.merge(part.check);
  std::move(part.values.begin(), part.values.end(), std::back_inserter(all.values));
}

ThreadValues onePass(Session& session, const instrumenter::AttachmentShader& shader) {
  const Captured captured = session.capture(shader);
  ThreadValues threads;
  addPass(threads, captured.threads, captured.layout, captured.execution.check);
  if (session.stage() != Stage::fragment) nameThreads(threads, session.stage(), session.stop());
  return threads;
}

ThreadValues valuesAt(Session& session, Probe probe, const std::vector<std::string>& watches) {
  probe.watches = watchesAt(session.shader(), probe, watches);
  return valuesAt(session, std::move(probe));
}

ThreadValues valuesAt(Session& session, Probe probe) {
  const Shader& shader = session.shader();
  const std::vector<frontend::Watch> wanted = std::move(probe.watches);
  ThreadValues result;
  result.statement = probe.statement;
  std::size_t done = 0;
  do {
    probe.watches.assign(wanted.begin() + static_cast<std::ptrdiff_t>(done), wanted.end());
    auto instrumented = instrumenter::instrumentSingle(shader, probe, session.target());
    if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) {
      throw Error(Outcome::cannot_debug, failure->reason);
    }
    const auto& attachment_shader = std::get<instrumenter::AttachmentShader>(instrumented);
    const Captured captured = session.capture(attachment_shader);
    const std::size_t fields = captured.layout.fields.size();
    const std::size_t watched = fields - (probe.outcome ? 1 : 0);
    if (watched == 0 && done < wanted.size()) {
      throw Error(Outcome::cannot_debug, "'" + wanted[done].expression +
                                             "' is larger than what this driver lets a pass capture; print a "
                                             "part of it");
    }

    addPass(result, captured.threads, captured.layout, captured.execution.check);
    done += watched;
    probe.outcome = false;  // the first pass has it
  } while (done < wanted.size());
  if (session.stage() != Stage::fragment) nameThreads(result, session.stage(), session.stop());
  return result;
}

namespace {

// `number` gives the component as a double. One kind of component at a time: there are many threads.
template <class Number>
void count(const ThreadValues& threads, const WatchedValues& values, std::size_t word, Number number,
           ComponentStatistics& one) {
  double sum = 0;
  const std::uint32_t* at = values.words.data() + word;
  for (std::size_t p = 0; p < threads.marks.size(); ++p, at += values.stride) {
    if (!threads.reachedAt(p)) continue;
    const double value = number(at);
    if (!std::isfinite(value)) {
      ++(std::isnan(value) ? one.nan : one.inf);
      continue;
    }
    one.min = one.finite == 0 ? value : std::min(one.min, value);
    one.max = one.finite == 0 ? value : std::max(one.max, value);
    sum += value;
    ++one.finite;
  }
  if (one.finite > 0) one.mean = sum / static_cast<double>(one.finite);
}

}  // namespace

std::vector<ComponentStatistics> statistics(const ThreadValues& threads, const WatchedValues& values) {
  std::vector<ComponentStatistics> result;
  if (!values.no_value.empty()) return result;
  std::size_t word = 0;
  for (const frontend::Component& component : frontend::components(values.type)) {
    ComponentStatistics one;
    one.access = component.access;
    if (component.basic == frontend::Basic::float_) {
      count(
          threads, values, word,
          [](const std::uint32_t* at) { return static_cast<double>(std::bit_cast<float>(*at)); }, one);
    } else {
      count(
          threads, values, word,
          [basic = component.basic](const std::uint32_t* at) { return componentAsDouble(basic, at); }, one);
    }
    result.push_back(std::move(one));
    word += static_cast<std::size_t>(wordsPerComponent(component.basic));
  }
  return result;
}

}  // namespace shadestep::session
