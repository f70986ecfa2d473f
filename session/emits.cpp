#include "session/emits.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "instrumenter/streams.h"

namespace shadestep::session {
namespace {

using instrumenter::Field;

int leastVertices(const std::string& primitive) {
  return primitive == "points" ? 1 : primitive == "line_strip" ? 2 : 3;
}

// One of the list: a vertex that a thread emits, or its end.
struct Entry {
  int primitive = 0, invocation = 0;
  int thread = 0;    // order of its start
  int vertices = 0;  // that the thread emitted before
  bool end = false;
  const std::uint32_t* words = nullptr;

  bool operator<(const Entry& other) const {
    return std::tie(primitive, invocation, thread, vertices, end) <
           std::tie(other.primitive, other.invocation, other.thread, other.vertices, other.end);
  }
  bool sameThread(const Entry& other) const { return thread == other.thread; }
};

class Reader {
 public:
  explicit Reader(GeometryEmits& emits)
      : layout_(emits.captured.layout),
        threads_(emits.captured.threads),
        in_order_(emits.captured.layout.carrier != instrumenter::Carrier::list),
        points_(emits.primitive == "points"),
        least_(leastVertices(emits.primitive)),
        emits_(emits) {
    for (const Field& field : layout_.identity) identity_.emplace_back(layout_, field);
    for (int i = 0; i < instrumenter::kEmitFields; ++i)
      fields_.emplace_back(layout_, layout_.fields.at(static_cast<std::size_t>(i)));
  }

  void read() {
    for (std::size_t i = instrumenter::kEmitFields; i < layout_.fields.size(); ++i)
      emits_.outputs.push_back({layout_.fields[i].name, layout_.fields[i].type, 0});
    readEntries();
    // Spans point into these, which therefore stay where they are.
    emits_.all_vertices.reserve(entries_.size());
    emits_.all_primitives.reserve(entries_.size());
    emits_.all_runs.reserve(entries_.size());
    for (std::size_t first = 0; first < entries_.size();) {
      std::size_t end = first + 1;
      while (end < entries_.size() && entries_[end].sameThread(entries_[first])) ++end;
      addRun(std::span(entries_).subspan(first, end - first));
      first = end;
    }
    sortRuns();
    addInputs();
  }

 private:
  struct Key {
    int primitive = 0, repeat = 0, invocation = 0;
    std::size_t run = 0;

    bool operator<(const Key& other) const {
      return std::tie(primitive, repeat, invocation) <
             std::tie(other.primitive, other.repeat, other.invocation);
    }
  };
  struct Emitted {
    int stream = 0, strip = 0;
    const std::uint32_t* words = nullptr;

    bool operator<(const Emitted& other) const {
      return std::tie(stream, strip) < std::tie(other.stream, other.strip);
    }
    bool samePrimitive(const Emitted& other) const { return stream == other.stream && strip == other.strip; }
  };

  static int number(const instrumenter::FieldDecoder& field, const std::uint32_t* entry) {
    std::uint32_t word = 0;
    field.decode(entry, &word);
    return static_cast<std::int32_t>(word);
  }
  int number(instrumenter::EmitField field, const std::uint32_t* entry) const {
    return number(fields_[field], entry);
  }

  // By primitive, and by the order of their start where several threads have the same number. Where the list
  // does not say it, threads lie one behind the other.
  void readEntries() {
    int ended = 0;
    entries_.reserve(threads_.count());
    for (std::size_t i = 0; i < threads_.count(); ++i) {
      const std::uint32_t* words = threads_.head(i);
      Entry entry;
      entry.primitive = number(identity_.at(0), words);
      entry.invocation = identity_.size() > 1 ? number(identity_[1], words) : 0;
      entry.thread = in_order_ ? ended : number(instrumenter::kEmitThread, words);
      entry.vertices = number(instrumenter::kEmitVertices, words);
      entry.end = (instrumenter::decodeMark(layout_, words) & instrumenter::kReached) == 0;
      entry.words = words;
      ended += entry.end ? 1 : 0;
      entries_.push_back(entry);
    }
    if (!std::is_sorted(entries_.begin(), entries_.end())) std::sort(entries_.begin(), entries_.end());
  }

  // Of the entries of one thread, its end last.
  void addRun(std::span<const Entry> entries) {
    const Entry& end = entries.back();
    const std::size_t emitted = entries.size() - 1;
    const int listed = in_order_ ? std::min(end.vertices, emits_.max_vertices) : end.vertices;
    if (!end.end || emitted != static_cast<std::size_t>(listed))
      throw Error(Outcome::failed, "the list of emitted vertices is not complete; report this as a bug");
    const bool again = !keys_.empty() && keys_.back().primitive == end.primitive &&
                       keys_.back().invocation == end.invocation;
    const int repeat = again ? keys_.back().repeat + 1 : 0;
    emits_.repeats = emits_.repeats || again;
    keys_.push_back({end.primitive, repeat, end.invocation, keys_.size()});
    GeometryRun run;
    run.invocation = end.invocation;
    run.vertices = end.vertices;
    const std::size_t first = emits_.all_primitives.size();
    const std::size_t kept = emitted > 0 ? addPrimitives(entries.first(emitted)) : 0;
    run.beyond_limit = end.vertices - static_cast<int>(kept);
    run.outputs = std::span(emits_.all_primitives).subspan(first);
    emits_.all_runs.push_back(run);
  }

  // Of the vertices of one thread, stream by stream; how many are in them.
  std::size_t addPrimitives(std::span<const Entry> emits) {
    emitted_.clear();
    for (const Entry& entry : emits) {
      if (emits_.max_vertices >= 0 && entry.vertices >= emits_.max_vertices) continue;
      emitted_.push_back({number(instrumenter::kEmitStream, entry.words),
                          points_ ? entry.vertices : number(instrumenter::kEmitStrip, entry.words),
                          entry.words});
    }
    if (!std::is_sorted(emitted_.begin(), emitted_.end())) std::stable_sort(emitted_.begin(), emitted_.end());
    for (std::size_t first = 0; first < emitted_.size();) {
      OutputPrimitive output;
      output.stream = emitted_[first].stream;
      const std::size_t at = emits_.all_vertices.size();
      std::size_t end = first;
      for (; end < emitted_.size() && emitted_[end].samePrimitive(emitted_[first]); ++end)
        emits_.all_vertices.push_back({emitted_[end].words});
      output.vertices = std::span(emits_.all_vertices).subspan(at);
      output.parts = std::max(static_cast<int>(end - first) - least_ + 1, 0);
      output.ill_formed = output.parts == 0;
      emits_.all_primitives.push_back(output);
      first = end;
    }
    return emitted_.size();
  }

  // All invocations on one primitive together.
  void sortRuns() {
    if (std::is_sorted(keys_.begin(), keys_.end())) return;
    std::sort(keys_.begin(), keys_.end());
    std::vector<GeometryRun> runs;
    runs.reserve(keys_.size());
    for (const Key& key : keys_) runs.push_back(emits_.all_runs[key.run]);
    emits_.all_runs = std::move(runs);
  }

  void addInputs() {
    emits_.inputs.reserve(keys_.size());
    for (std::size_t first = 0; first < keys_.size();) {
      std::size_t end = first + 1;
      while (end < keys_.size() && keys_[end].primitive == keys_[first].primitive &&
             keys_[end].repeat == keys_[first].repeat)
        ++end;
      emits_.inputs.push_back({keys_[first].primitive, keys_[first].repeat,
                               std::span(emits_.all_runs).subspan(first, end - first)});
      first = end;
    }
  }

  const instrumenter::AttachmentLayout& layout_;
  const ThreadWords& threads_;
  bool in_order_;  // thread by thread, each with its end; else as `thread` says
  bool points_;
  int least_;  // vertices of an output primitive
  GeometryEmits& emits_;
  std::vector<instrumenter::FieldDecoder> identity_, fields_;
  std::vector<Entry> entries_;
  std::vector<Emitted> emitted_;  // by one thread
  std::vector<Key> keys_;         // of the runs
};

}  // namespace

GeometryEmits geometryEmits(Session& session) {
  session.select(Stage::geometry);
  session.requireCapturable();
  auto instrumented = instrumenter::instrumentEmits(session.shader(), session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented))
    throw Error(Outcome::cannot_debug, failure->reason);
  const auto& shader = std::get<instrumenter::EmitsShader>(instrumented);
  GeometryEmits emits;
  emits.captured = session.capture(instrumenter::AttachmentShader{shader.text, shader.layout});
  const instrumenter::EmitLimits limits = instrumenter::emitLimits(session.shader());
  emits.primitive = limits.primitive;
  emits.max_vertices = limits.max_vertices;
  emits.check = emits.captured.execution.check;
  std::string left_out;
  for (const std::string& name : shader.left_out) left_out += (left_out.empty() ? "" : ", ") + name;
  if (!left_out.empty())
    emits.check.left_out += (emits.check.left_out.empty() ? "" : "; ") +
                            ("not listed with each vertex, too large or of unknown size: " + left_out);
  if (emits.max_vertices < 0)
    emits.check.left_out +=
        (emits.check.left_out.empty() ? "" : "; ") +
        std::string("max_vertices is no plain number: vertices beyond it are listed, too");
  Reader(emits).read();
  for (GeometryEmits::Output& output : emits.outputs)
    output.stream = instrumenter::streamOf(session.shader(), output.name);
  return emits;
}

instrumenter::Value GeometryEmits::value(const EmittedVertex& vertex, std::size_t output) const {
  return instrumenter::decode(captured.layout, captured.layout.fields[instrumenter::kEmitFields + output],
                              vertex.words);
}

GeometryEmits::Totals GeometryEmits::totals() const {
  Totals totals;
  totals.inputs = inputs.size();
  for (const InputPrimitive& input : inputs) {
    totals.runs += input.runs.size();
    for (const GeometryRun& run : input.runs) {
      totals.silent_runs += run.vertices == 0 ? 1 : 0;
      totals.vertices += static_cast<std::uint64_t>(run.vertices);
      totals.beyond_limit += static_cast<std::uint64_t>(run.beyond_limit);
      totals.outputs += run.outputs.size();
      for (const OutputPrimitive& output : run.outputs) {
        totals.ill_formed += output.ill_formed ? 1 : 0;
        totals.parts += static_cast<std::uint64_t>(output.parts);
      }
    }
  }
  return totals;
}

}  // namespace shadestep::session
