#include "session/emits.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace shadestep::session {
namespace {

using instrumenter::Field;

int leastVertices(const std::string& primitive) {
  return primitive == "points" ? 1 : primitive == "line_strip" ? 2 : 3;
}

// The entries of one thread of the list, in the order in which it made them.
struct Thread {
  int primitive = 0, invocation = 0;
  std::vector<const std::uint32_t*> emits;
  int vertices = 0;
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
      emits_.outputs.push_back({layout_.fields[i].name, layout_.fields[i].type});
    for (std::size_t i = 0; i < threads_.count(); ++i) sort(threads_.head(i));
    // By primitive, and by the order of their start where several have the same number.
    std::vector<const Thread*> ordered;
    for (const auto& [number, thread] : by_start_) ordered.push_back(&thread);
    std::stable_sort(ordered.begin(), ordered.end(), [](const Thread* a, const Thread* b) {
      return std::tie(a->primitive, a->invocation) < std::tie(b->primitive, b->invocation);
    });
    for (std::size_t i = 0; i < ordered.size(); ++i) {
      const Thread& thread = *ordered[i];
      const bool again = i > 0 && thread.primitive == ordered[i - 1]->primitive &&
                         thread.invocation == ordered[i - 1]->invocation;
      repeat_ = again ? repeat_ + 1 : 0;
      emits_.repeats = emits_.repeats || again;
      InputPrimitive& input = inputs_[{thread.primitive, repeat_}];
      input.primitive = thread.primitive;
      input.repeat = repeat_;
      input.runs.push_back(run(thread));
    }
    for (auto& [key, input] : inputs_) emits_.inputs.push_back(std::move(input));
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

  void sort(const std::uint32_t* entry) {
    Thread& thread = by_start_[in_order_ ? ended_ : number(instrumenter::kEmitThread, entry)];
    thread.primitive = number(identity_.at(0), entry);
    thread.invocation = identity_.size() > 1 ? number(identity_[1], entry) : 0;
    if ((instrumenter::decodeMark(layout_, entry) & instrumenter::kReached) != 0) {
      thread.emits.push_back(entry);
    } else {
      thread.vertices = number(instrumenter::kEmitVertices, entry);
      ++ended_;
    }
  }

  GeometryRun run(Thread thread) const {
    const auto order = [&](const std::uint32_t* a, const std::uint32_t* b) {
      return number(instrumenter::kEmitVertices, a) < number(instrumenter::kEmitVertices, b);
    };
    std::sort(thread.emits.begin(), thread.emits.end(), order);
    const int listed = in_order_ ? std::min(thread.vertices, emits_.max_vertices) : thread.vertices;
    if (thread.emits.size() != static_cast<std::size_t>(listed))
      throw Error(Outcome::failed, "the list of emitted vertices is not complete; report this as a bug");
    GeometryRun run;
    run.invocation = thread.invocation;
    run.vertices = thread.vertices;
    run.beyond_limit = thread.vertices - listed;
    std::map<std::pair<int, int>, OutputPrimitive> outputs;  // by stream and strip
    for (const std::uint32_t* entry : thread.emits) {
      if (emits_.max_vertices >= 0 && number(instrumenter::kEmitVertices, entry) >= emits_.max_vertices) {
        ++run.beyond_limit;
        continue;
      }
      const int stream = number(instrumenter::kEmitStream, entry);
      const bool points = emits_.primitive == "points";
      const int strip = number(points ? instrumenter::kEmitVertices : instrumenter::kEmitStrip, entry);
      OutputPrimitive& output = outputs[{stream, strip}];
      output.stream = stream;
      output.vertices.push_back(vertex(entry));
    }
    const int least = leastVertices(emits_.primitive);
    for (auto& [key, output] : outputs) {
      const int count = static_cast<int>(output.vertices.size());
      output.parts = std::max(count - least + 1, 0);
      output.ill_formed = output.parts == 0;
      run.outputs.push_back(std::move(output));
    }
    return run;
  }

  EmittedVertex vertex(const std::uint32_t* entry) const {
    EmittedVertex vertex;
    for (std::size_t i = instrumenter::kEmitFields; i < fields_.size(); ++i) {
      instrumenter::Value value{layout_.fields[i].type, std::vector<std::uint32_t>(fields_[i].words())};
      fields_[i].decode(entry, value.words.data());
      vertex.values.push_back(std::move(value));
    }
    return vertex;
  }

  const instrumenter::AttachmentLayout& layout_;
  const ThreadWords& threads_;
  bool in_order_;  // thread by thread, each with its end; else as `thread` says
  int ended_ = 0;
  GeometryEmits& emits_;
  std::vector<instrumenter::FieldDecoder> identity_, fields_;
  std::map<int, Thread> by_start_;
  std::map<std::pair<int, int>, InputPrimitive> inputs_;  // by primitive and repeat
  int repeat_ = 0;
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
