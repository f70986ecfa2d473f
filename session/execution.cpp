// Prepared programs, their executions at the draw at which the program stands, and the checks of these.
#include <algorithm>

#include "session/dropped_uniforms.h"
#include "session/session_state.h"

namespace shadestep::session {
namespace {

constexpr std::size_t kLargestKept = std::size_t{256} << 20;  // bytes for the next answer to be written to

frontend::Type pixelType(std::uint32_t gl_type) {
  constexpr std::uint32_t kInt = 0x1404, kUnsignedInt = 0x1405;  // GL_INT, GL_UNSIGNED_INT
  frontend::Type type;
  type.basic = gl_type == kInt           ? frontend::Basic::int_
               : gl_type == kUnsignedInt ? frontend::Basic::uint_
                                         : frontend::Basic::float_;
  type.rows = 4;
  return type;
}

std::unique_ptr<wire::RasterT> raster(const FragmentChoice& choice, Provoking provoking) {
  if (!choice.forces() && provoking == Provoking::keep) return nullptr;
  const auto as_wire = [](FragmentChoice::Switch value) { return static_cast<wire::Switch>(value); };
  auto raster = std::make_unique<wire::RasterT>();
  raster->alpha_test = as_wire(choice.alpha_test);
  raster->depth_test = as_wire(choice.depth_test);
  raster->stencil_test = as_wire(choice.stencil_test);
  raster->blend = as_wire(choice.blend);
  raster->clear_buffers = choice.clear_buffers;
  raster->provoking = static_cast<wire::Provoking>(provoking);
  return raster;
}

// The words of one range of the bulk memory; throws if the agent's numbers do not fit.
std::span<std::uint32_t> wordsOf(const wire::SharedMemory& bulk, const wire::BulkRangeT* range) {
  if (range == nullptr || range->bytes == 0) return {};
  if (range->offset % 4 != 0 || range->offset > bulk.size() || range->bytes > bulk.size() - range->offset) {
    throw Error(Outcome::failed, "the agent's answer does not fit its memory; report this as a bug");
  }
  return {reinterpret_cast<std::uint32_t*>(bulk.data() + range->offset), range->bytes / 4};
}

std::vector<std::uint32_t> copyOf(std::span<const std::uint32_t> words) {
  return {words.begin(), words.end()};
}

}  // namespace

void Check::merge(const Check& other) {
  const bool fresh = !compared_at_all && reason.empty();
  if (fresh) {
    *this = other;
    return;
  }
  if (!other.compared_at_all && compared_at_all) reason = other.reason;
  compared_at_all = compared_at_all && other.compared_at_all;
  undefined = std::max(undefined, other.undefined);
  compared = std::max(compared, other.compared);
  if (differing == 0 ||
      (largest && other.differing > 0 && (!other.largest || other.largest->by > largest->by)))
    largest = other.largest;
  differing = std::max(differing, other.differing);
  if (left_out.empty()) left_out = other.left_out;
  if (dropped.empty()) dropped = other.dropped;
}

Prepared::Prepared(Prepared&& other) noexcept
    : compile_time(other.compile_time),
      storage(other.storage),
      output_locations(std::move(other.output_locations)),
      uncompared(std::move(other.uncompared)),
      session_(std::exchange(other.session_, nullptr)),
      handle_(other.handle_) {}

Prepared& Prepared::operator=(Prepared&& other) noexcept {
  if (this != &other) {
    if (session_ != nullptr) session_->release(handle_);
    session_ = std::exchange(other.session_, nullptr);
    handle_ = other.handle_;
    compile_time = other.compile_time;
    storage = other.storage;
    output_locations = std::move(other.output_locations);
    uncompared = std::move(other.uncompared);
  }
  return *this;
}

Prepared::~Prepared() {
  if (session_ != nullptr) session_->release(handle_);
}

BoxTimes Session::timeBoxes(const std::vector<Box>& boxes, int repeats) {
  wire::TimeBoxesT request;
  for (const Box& box : boxes) request.boxes.emplace_back(box.x, box.y, box.width, box.height);
  request.repeats = static_cast<std::uint32_t>(repeats);
  const auto [reply, bulk] = state_->ask<wire::BoxTimesT>(std::move(request));
  const std::size_t expected = boxes.size() * static_cast<std::size_t>(repeats);
  if (reply.times_ns.size() != expected || reply.cpu_ns.size() != expected)
    throw Error(Outcome::failed, "the agent's answer is incomplete; report this as a bug");
  BoxTimes result;
  for (const std::uint64_t ns : reply.times_ns) result.times.emplace_back(ns);
  for (const std::uint64_t ns : reply.cpu_ns) result.cpu_times.emplace_back(ns);
  return result;
}

const std::string& Session::State::droppedOf(Stage of) {
  const auto known = dropped.find(of);
  if (known != dropped.end()) return known->second;
  const auto shader = shaders.find(of);
  static const std::string kNone;  // what was not analysed is shown no values of
  if (shader == shaders.end() || !facts) return kNone;
  return dropped.emplace(of, droppedUniforms(*shader->second, *facts)).first->second;
}

Execution Session::execute(const Prepared& prepared, const ExecuteOptions& options) {
  wire::ExecuteT execute;
  execute.handle = prepared.handle();
  const auto packed = [](const std::vector<Uniform>& uniforms) {
    std::vector<std::unique_ptr<wire::UniformValueT>> values;
    for (const Uniform& uniform : uniforms) {
      auto value = std::make_unique<wire::UniformValueT>();
      value->name = uniform.name;
      value->gl_type = uniform.gl_type;
      value->words = uniform.words;
      values.push_back(std::move(value));
    }
    return values;
  };
  execute.uniforms = packed(options.uniforms);
  for (const std::vector<Uniform>& set : options.sets) {
    execute.sets.push_back(std::make_unique<wire::UniformSetT>());
    execute.sets.back()->uniforms = packed(set);
  }
  execute.storage = options.storage;
  // Without a buffer it would write to whatever the program has bound there; one of zeros has room for
  // nothing.
  execute.storage_words =
      std::max<std::uint64_t>(options.storage_words, prepared.storage ? instrumenter::kDiscardedHeader : 0);
  execute.compare = options.compare;
  execute.read_outputs = options.read_outputs;
  execute.read_captures = options.read_captures;
  execute.repeats = static_cast<std::uint32_t>(options.repeats);
  execute.covering_size = options.covering_size;
  execute.plain_units = options.plain_units;
  execute.plain_levels = options.plain_levels;
  execute.layer = state_->fragments.layer;
  execute.sample = state_->fragments.sample;
  execute.raster = raster(state_->fragments, options.provoking);

  const std::uint64_t given_back = state_->answered.use_count() == 1 ? state_->answered_number : 0;
  execute.given_back = given_back;
  auto [reply, descriptor] = state_->ask<wire::ExecutedT>(std::move(execute));
  const bool known = descriptor || (reply.memory != 0 && reply.memory == given_back);
  if (descriptor) {
    state_->answered = std::make_shared<wire::SharedMemory>(wire::SharedMemory::map(std::move(descriptor)));
    state_->answered_number = reply.memory;
  }
  Execution result;
  result.memory = known ? state_->answered : std::make_shared<const wire::SharedMemory>();
  const wire::SharedMemory& bulk = *result.memory;
  if (bulk.size() > kLargestKept) state_->answered.reset();
  result.width = reply.width;
  result.height = reply.height;
  const std::size_t per_plane =
      static_cast<std::size_t>(reply.width) * static_cast<std::size_t>(reply.height) * 4;
  for (const auto& range : reply.attachments) {
    result.attachments.push_back(wordsOf(bulk, range.get()));
    if (result.attachments.back().size() != per_plane) {
      throw Error(Outcome::failed, "the agent's answer has the wrong size; report this as a bug");
    }
  }
  if (reply.output_draw_buffers.size() != reply.outputs.size() ||
      reply.output_types.size() != reply.outputs.size()) {
    throw Error(Outcome::failed, "the agent's answer is incomplete; report this as a bug");
  }
  for (std::size_t i = 0; i < reply.outputs.size(); ++i) {
    ColorOutput output;
    output.draw_buffer = reply.output_draw_buffers[i];
    output.type = pixelType(reply.output_types[i]);
    output.words = copyOf(wordsOf(bulk, reply.outputs[i].get()));
    result.outputs.push_back(std::move(output));
  }
  result.storage = wordsOf(bulk, reply.storage.get());
  result.feedback = wordsOf(bulk, reply.feedback.get());
  result.feedback_words = static_cast<int>(reply.feedback_words);
  for (const std::uint64_t ns : reply.times_ns) result.times.emplace_back(ns);
  for (const std::uint64_t ns : reply.cpu_ns) result.cpu_times.emplace_back(ns);
  result.check.compared_at_all = options.compare && reply.compare_reason.empty();
  result.check.compared = reply.compared;
  result.check.differing = reply.differing;
  if (reply.largest)
    result.check.largest = {reply.largest->by, reply.largest->expected, reply.largest->got,
                            reply.largest->where};
  result.check.dropped = state_->droppedOf(stage());
  result.check.reason = options.compare ? reply.compare_reason : "not asked for";
  if (options.compare && reply.compare_reason == wire::kNothingToCompare && !prepared.uncompared.empty())
    result.check.reason = prepared.uncompared;
  else if (options.compare)
    result.check.left_out = prepared.uncompared;
  if (reply.differing + reply.unstable > 0 && reply.outside_outputs == 0 && tellsUndefinedOutputs(*this))
    leaveOutUndefined(prepared, options, reply.unstable, result.check);
  return result;
}

// What a shader leaves undefined may differ between two draws, and proves nothing.
void Session::leaveOutUndefined(const Prepared& prepared, const ExecuteOptions& options,
                                std::uint64_t unstable, Check& check) {
  if (!state_->undefined) state_->undefined = findUndefinedOutputs(*this);
  const UndefinedOutputs& undefined = *state_->undefined;
  if (undefined.count == 0) return;
  ExecuteOptions again = options;
  again.compare = false;
  again.read_captures = false;
  again.read_outputs = true;
  again.repeats = 1;
  const std::uint64_t differing = differingDefined(undefined, execute(prepared, again));
  if (unstable > 0 && differing > 0) return;  // the draw is unstable beyond that, as the agent says
  check.compared_at_all = true;
  check.reason.clear();
  check.differing = differing;
  check.largest.reset();
  check.undefined = std::min(check.compared + unstable, undefined.count);
  check.compared = check.compared + unstable - check.undefined;
}

ThreadWords threadWords(const Execution& execution, int words) {
  std::vector<std::uint32_t*> planes;
  for (const std::span<std::uint32_t>& attachment : execution.attachments)
    planes.push_back(attachment.data());
  if (static_cast<int>(planes.size()) * 4 < words)
    throw Error(Outcome::failed, "the agent's answer lacks captured values; report this as a bug");
  return {execution.width, execution.height, words, std::move(planes), execution.memory};
}

}  // namespace shadestep::session
