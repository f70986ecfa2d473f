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
  Reader(const Captured& captured, GeometryEmits& emits)
      : layout_(captured.layout),
        threads_(captured.threads),
        in_order_(captured.layout.carrier != instrumenter::Carrier::list),
        emits_(emits) {
    for (const Field& field : layout_.identity) identity_.emplace_back(layout_, field);
    for (const Field& field : layout_.fields) fields_.emplace_back(layout_, field);
  }

  void read() {
    for (std::size_t i = instrumenter::kEmitFields; i < layout_.fields.size(); ++i)
      emits_.outputs.push_back({layout_.fields[i].name, layout_.fields[i].type, 0});
    readEntries();
    for (std::size_t first = 0; first < entries_.size();) {
      std::size_t end = first + 1;
      while (end < entries_.size() && entries_[end].sameThread(entries_[first])) ++end;
      addRun(std::span(entries_).subspan(first, end - first));
      first = end;
    }
    sortInputs();
  }

 private:
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
    keys_.push_back({end.primitive, repeat, end.invocation, runs_.size()});
    runs_.push_back(run(end, entries.first(emitted)));
    runs_.back().beyond_limit += end.vertices - listed;
  }

  GeometryRun run(const Entry& end, std::span<const Entry> emits) const {
    GeometryRun run;
    run.invocation = end.invocation;
    run.vertices = end.vertices;
    const bool points = emits_.primitive == "points";
    std::vector<int> strips;  // of run.outputs
    for (const Entry& entry : emits) {
      if (emits_.max_vertices >= 0 && entry.vertices >= emits_.max_vertices) {
        ++run.beyond_limit;
        continue;
      }
      const int stream = number(instrumenter::kEmitStream, entry.words);
      const int strip = points ? entry.vertices : number(instrumenter::kEmitStrip, entry.words);
      std::size_t output = points ? 0 : run.outputs.size();
      while (output > 0 && (run.outputs[output - 1].stream != stream || strips[output - 1] != strip))
        --output;
      if (output == 0) {
        run.outputs.emplace_back().stream = stream;
        strips.push_back(strip);
        output = run.outputs.size();
      }
      run.outputs[output - 1].vertices.push_back(vertex(entry.words));
    }
    const int least = leastVertices(emits_.primitive);
    for (OutputPrimitive& output : run.outputs) {
      output.parts = std::max(static_cast<int>(output.vertices.size()) - least + 1, 0);
      output.ill_formed = output.parts == 0;
    }
    std::stable_sort(run.outputs.begin(), run.outputs.end(),
                     [](const OutputPrimitive& a, const OutputPrimitive& b) { return a.stream < b.stream; });
    return run;
  }

  EmittedVertex vertex(const std::uint32_t* entry) const {
    EmittedVertex vertex;
    vertex.values.reserve(fields_.size() - instrumenter::kEmitFields);
    for (std::size_t i = instrumenter::kEmitFields; i < fields_.size(); ++i) {
      instrumenter::Value value{layout_.fields[i].type, std::vector<std::uint32_t>(fields_[i].words())};
      fields_[i].decode(entry, value.words.data());
      vertex.values.push_back(std::move(value));
    }
    return vertex;
  }

  // All invocations on one primitive together.
  void sortInputs() {
    const auto before = [](const Key& a, const Key& b) {
      return std::tie(a.primitive, a.repeat, a.invocation) < std::tie(b.primitive, b.repeat, b.invocation);
    };
    if (!std::is_sorted(keys_.begin(), keys_.end(), before)) std::sort(keys_.begin(), keys_.end(), before);
    emits_.inputs.reserve(keys_.size());
    for (const Key& key : keys_) {
      std::vector<InputPrimitive>& inputs = emits_.inputs;
      if (inputs.empty() || inputs.back().primitive != key.primitive || inputs.back().repeat != key.repeat) {
        inputs.emplace_back();
        inputs.back().primitive = key.primitive;
        inputs.back().repeat = key.repeat;
      }
      inputs.back().runs.push_back(std::move(runs_[key.run]));
    }
  }

  struct Key {
    int primitive = 0, repeat = 0, invocation = 0;
    std::size_t run = 0;
  };

  const instrumenter::AttachmentLayout& layout_;
  const ThreadWords& threads_;
  bool in_order_;  // thread by thread, each with its end; else as `thread` says
  GeometryEmits& emits_;
  std::vector<instrumenter::FieldDecoder> identity_, fields_;
  std::vector<Entry> entries_;
  std::vector<GeometryRun> runs_;
  std::vector<Key> keys_;  // of the runs
};

}  // namespace

GeometryEmits geometryEmits(Session& session) {
  session.select(Stage::geometry);
  session.requireCapturable();
  auto instrumented = instrumenter::instrumentEmits(session.shader(), session.target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented))
    throw Error(Outcome::cannot_debug, failure->reason);
  const auto& shader = std::get<instrumenter::EmitsShader>(instrumented);
  const Captured captured = session.capture(instrumenter::AttachmentShader{shader.text, shader.layout});

  GeometryEmits emits;
  const instrumenter::EmitLimits limits = instrumenter::emitLimits(session.shader());
  emits.primitive = limits.primitive;
  emits.max_vertices = limits.max_vertices;
  emits.check = captured.execution.check;
  std::string left_out;
  for (const std::string& name : shader.left_out) left_out += (left_out.empty() ? "" : ", ") + name;
  if (!left_out.empty())
    emits.check.left_out += (emits.check.left_out.empty() ? "" : "; ") +
                            ("not listed with each vertex, too large or of unknown size: " + left_out);
  if (emits.max_vertices < 0)
    emits.check.left_out +=
        (emits.check.left_out.empty() ? "" : "; ") +
        std::string("max_vertices is no plain number: vertices beyond it are listed, too");
  Reader(captured, emits).read();
  for (GeometryEmits::Output& output : emits.outputs)
    output.stream = instrumenter::streamOf(session.shader(), output.name);
  return emits;
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
