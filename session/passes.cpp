// Capture passes at the draw at which the program stands.
#include <algorithm>

#include "session/discarded_threads.h"
#include "session/session_state.h"

namespace shadestep::session {
namespace {

constexpr std::uint32_t kFirstRoomPerThread = 1 << 16;  // words a recorded thread may write at the first try
constexpr std::uint32_t kThreadsPerPixel = 16;          // fragments expected at most on one pixel, first try
constexpr std::uint32_t kThreadsPerIdentity = 4;        // a vertex may be shaded several times
constexpr std::uint64_t kNoRoom = instrumenter::kDiscardedHeader;  // words of a storage buffer for no thread

}  // namespace

void raise(const wire::FailedT& failed) {
  switch (failed.kind) {
    case wire::ErrorKind::Compile:
      throw DriverRefusal("the driver refused the instrumented shader: ", failed.text);
    case wire::ErrorKind::Link:
      throw DriverRefusal("the driver could not link the instrumented program: ", failed.text);
    default:
      throw Error(Outcome::cannot_debug, failed.text);
  }
}

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
  differing = std::max(differing, other.differing);
  if (left_out.empty()) left_out = other.left_out;
  if (dropped.empty()) dropped = other.dropped;
}

std::uint32_t glUniformType(const frontend::Type& type) {
  using frontend::Basic;
  if (type.isArray() || type.rows > 4 || type.columns > 4) return 0;
  if (type.isMatrix()) {
    if (type.basic != Basic::float_) return 0;
    static constexpr std::uint32_t kMatrices[3][3] = {
        {0x8B5A, 0x8B65, 0x8B66}, {0x8B67, 0x8B5B, 0x8B68}, {0x8B69, 0x8B6A, 0x8B5C}};  // [columns-2][rows-2]
    return kMatrices[type.columns - 2][type.rows - 2];
  }
  static constexpr std::uint32_t kFloats[] = {0x1406, 0x8B50, 0x8B51, 0x8B52};
  static constexpr std::uint32_t kInts[] = {0x1404, 0x8B53, 0x8B54, 0x8B55};
  static constexpr std::uint32_t kUints[] = {0x1405, 0x8DC6, 0x8DC7, 0x8DC8};
  static constexpr std::uint32_t kBools[] = {0x8B56, 0x8B57, 0x8B58, 0x8B59};
  const int n = type.rows - 1;
  switch (type.basic) {
    case Basic::float_:
      return kFloats[n];
    case Basic::int_:
      return kInts[n];
    case Basic::uint_:
      return kUints[n];
    case Basic::bool_:
      return kBools[n];
    default:
      return 0;
  }
}

// ---- prepared programs

Prepared::Prepared(Prepared&& other) noexcept
    : compile_time(other.compile_time),
      storage(other.storage),
      session_(std::exchange(other.session_, nullptr)),
      handle_(other.handle_) {}

Prepared& Prepared::operator=(Prepared&& other) noexcept {
  if (this != &other) {
    if (session_ != nullptr) session_->release(handle_);
    session_ = std::exchange(other.session_, nullptr);
    handle_ = other.handle_;
    compile_time = other.compile_time;
    storage = other.storage;
  }
  return *this;
}

Prepared::~Prepared() {
  if (session_ != nullptr) session_->release(handle_);
}

// ---- capture passes

namespace {

std::vector<std::string> outputNames(const frontend::Shader& shader) {
  std::vector<std::string> names;
  for (const frontend::VariableId id : shader.outputs) {
    names.push_back(shader.variables[static_cast<std::size_t>(id)].name);
  }
  return names;
}

wire::PrepareT preparation(const frontend::Shader& shader, const std::string& text) {
  wire::PrepareT prepare;
  prepare.stage = static_cast<wire::Stage>(shader.stage);
  prepare.text = text;
  prepare.user_outputs = outputNames(shader);
  return prepare;
}

wire::PrepareT preparation(const frontend::Shader& shader, const std::string& text,
                           const instrumenter::AttachmentLayout& layout) {
  wire::PrepareT prepare = preparation(shader, text);
  const bool as_floats = layout.carrier == instrumenter::Carrier::float_attachments;
  prepare.first_frag_data = layout.outputs.empty() ? layout.first_frag_data : -1;
  for (int i = 0; i < layout.attachments(); ++i) {
    auto capture = std::make_unique<wire::CaptureOutputT>();
    if (!layout.outputs.empty()) capture->name = layout.outputs[static_cast<std::size_t>(i)];
    capture->format = as_floats ? wire::CaptureFormat::Float4 : wire::CaptureFormat::Uint4;
    prepare.captures.push_back(std::move(capture));
  }
  return prepare;
}

frontend::Type pixelType(std::uint32_t gl_type) {
  constexpr std::uint32_t kInt = 0x1404, kUnsignedInt = 0x1405;  // GL_INT, GL_UNSIGNED_INT
  frontend::Type type;
  type.basic = gl_type == kInt           ? frontend::Basic::int_
               : gl_type == kUnsignedInt ? frontend::Basic::uint_
                                         : frontend::Basic::float_;
  type.rows = 4;
  return type;
}

std::unique_ptr<wire::RasterT> raster(const FragmentChoice& choice) {
  if (!choice.forces()) return nullptr;
  const auto as_wire = [](FragmentChoice::Switch value) { return static_cast<wire::Switch>(value); };
  auto raster = std::make_unique<wire::RasterT>();
  raster->alpha_test = as_wire(choice.alpha_test);
  raster->depth_test = as_wire(choice.depth_test);
  raster->stencil_test = as_wire(choice.stencil_test);
  raster->blend = as_wire(choice.blend);
  raster->clear_buffers = choice.clear_buffers;
  return raster;
}

// The words of one range of the bulk memory; throws if the agent's numbers do not fit.
std::span<const std::uint32_t> wordsOf(const wire::SharedMemory& bulk, const wire::BulkRangeT* range) {
  if (range == nullptr || range->bytes == 0) return {};
  if (range->offset % 4 != 0 || range->offset > bulk.size() || range->bytes > bulk.size() - range->offset) {
    throw Error(Outcome::failed, "the agent's answer does not fit its memory; report this as a bug");
  }
  return {reinterpret_cast<const std::uint32_t*>(bulk.data() + range->offset), range->bytes / 4};
}

std::vector<std::uint32_t> copyOf(std::span<const std::uint32_t> words) {
  return {words.begin(), words.end()};
}

}  // namespace

// layout(origin_upper_left) in vec4 gl_FragCoord;
bool countsRowsFromTop(const frontend::Shader& shader) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [](const frontend::Token& token) { return token.text == "origin_upper_left"; });
}

void Session::choose(const FragmentChoice& choice) {
  const DrawFacts& draw = facts();
  const auto among = [](int chosen, int there, const std::string& what) {
    if (chosen >= 0 && chosen < std::max(there, 1)) return;
    throw Error(Outcome::nothing_matches,
                there == 0 ? "the draw's target has no " + what + "s to choose from"
                           : "no " + what + " " + std::to_string(chosen) + "; the draw's target has " +
                                 std::to_string(there) + ": 0 to " + std::to_string(there - 1));
  };
  among(choice.layer, draw.layers, "layer");
  among(choice.sample, draw.samples, "sample");
  if (choice.alpha_test == FragmentChoice::Switch::on && (draw.core || draw.es)) {
    throw Error(Outcome::cannot_debug, "there is no alpha test in " +
                                           std::string(draw.es ? "OpenGL ES" : "a core profile") +
                                           ", which the program uses");
  }
  state_->fragments = choice;
  state_->undefined.reset();
}

Prepared Session::send(wire::PrepareT&& prepare) {
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  Prepared prepared(this, reply.handle);
  prepared.compile_time = std::chrono::nanoseconds(reply.compile_ns);
  prepared.output_locations = reply.output_locations;
  return prepared;
}

Prepared Session::prepare(const instrumenter::AttachmentShader& instrumented) {
  requireCapturable();
  if (stage() != Stage::fragment) return prepareStages(instrumented.text, instrumented.layout);
  auto prepare = preparation(shader(), instrumented.text, instrumented.layout);
  prepare.storage_block = instrumented.layout.discarded_block;
  Prepared prepared = send(std::move(prepare));
  prepared.storage = !instrumented.layout.discarded_block.empty();
  return prepared;
}

Prepared Session::prepare(const instrumenter::RecordingShader& instrumented) {
  requireCapturable();
  if (stage() != Stage::fragment) return prepareStorage(instrumented.text, instrumented.layout.block);
  auto prepare = preparation(shader(), instrumented.text, instrumented.layout.attachment);
  prepare.storage_block = instrumented.layout.block;
  return send(std::move(prepare));
}

Prepared Session::prepareOriginal() {
  return prepareText("");
}

Prepared Session::prepareText(const std::string& text) {
  requireCapturable();
  if (stage() == Stage::fragment) return send(preparation(shader(), text));
  instrumenter::AttachmentLayout none;
  none.words = 0;
  return prepareStages(text, none);
}

Prepared Session::prepareStorage(const std::string& text, const std::string& block) {
  requireCapturable();
  if (stage() != Stage::fragment) {
    instrumenter::AttachmentLayout layout;
    layout.words = 0;
    layout.list_block = block;
    return prepareStages(text, layout);
  }
  wire::PrepareT prepare = preparation(shader(), text);
  prepare.storage_block = block;
  return send(std::move(prepare));
}

Prepared Session::prepareCovering(const std::string& fragment_text, const std::string& vertex_text) {
  requireCapturable();
  wire::PrepareT prepare = preparation(shader(), fragment_text);
  prepare.geometry = wire::Geometry::Covering;
  prepare.vertex_text = vertex_text;
  return send(std::move(prepare));
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
  execute.storage_words = std::max<std::uint64_t>(options.storage_words, prepared.storage ? kNoRoom : 0);
  execute.compare = options.compare;
  execute.read_outputs = options.read_outputs;
  execute.read_captures = options.read_captures;
  execute.repeats = static_cast<std::uint32_t>(options.repeats);
  execute.covering_size = options.covering_size;
  execute.layer = state_->fragments.layer;
  execute.sample = state_->fragments.sample;
  execute.raster = raster(state_->fragments);

  auto [reply, descriptor] = state_->ask<wire::ExecutedT>(std::move(execute));
  Execution result;
  result.memory = std::make_shared<wire::SharedMemory>(wire::SharedMemory::map(std::move(descriptor)));
  const wire::SharedMemory& bulk = *result.memory;
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
  result.storage = copyOf(wordsOf(bulk, reply.storage.get()));
  result.feedback = wordsOf(bulk, reply.feedback.get());
  result.feedback_words = static_cast<int>(reply.feedback_words);
  for (const std::uint64_t ns : reply.times_ns) result.times.emplace_back(ns);
  for (const std::uint64_t ns : reply.cpu_ns) result.cpu_times.emplace_back(ns);
  result.check.compared_at_all = options.compare && reply.compare_reason.empty();
  result.check.compared = reply.compared;
  result.check.differing = reply.differing;
  result.check.reason = options.compare ? reply.compare_reason : "not asked for";
  if (options.compare) result.check.left_out = prepared.uncompared;
  // What is looked at there is one plane of the target.
  const bool one_plane = facts().layers <= 1 && facts().samples <= 1;
  if (stage() == Stage::fragment && reply.differing + reply.unstable > 0 && reply.outside_colors == 0 &&
      one_plane) {
    leaveOutUndefined(prepared, options, reply.unstable, result.check);
  }
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
  const std::uint64_t differing = differingDefined(undefined, execute(prepared, again).outputs);
  if (unstable > 0 && differing > 0) return;  // the draw is unstable beyond that, as the agent says
  check.compared_at_all = true;
  check.reason.clear();
  check.differing = differing;
  check.undefined = std::min(check.compared + unstable, undefined.count);
  check.compared = check.compared + unstable - check.undefined;
}

ThreadWords joinAttachments(const Execution& execution, int words) {
  ThreadWords joined;
  joined.width = execution.width;
  joined.height = execution.height;
  joined.words = words;
  const std::size_t pixels =
      static_cast<std::size_t>(execution.width) * static_cast<std::size_t>(execution.height);
  const auto width = static_cast<std::size_t>(words);
  joined.data.assign(pixels * width, 0);
  for (std::size_t a = 0; a < execution.attachments.size(); ++a) {
    const std::size_t first = a * 4;
    if (first >= width) break;
    const std::size_t take = std::min<std::size_t>(4, width - first);
    const std::uint32_t* from = execution.attachments[a].data();
    for (std::size_t p = 0; p < pixels; ++p) {
      std::copy_n(from + p * 4, take, joined.data.begin() + static_cast<std::ptrdiff_t>(p * width + first));
    }
  }
  return joined;
}

Captured Session::capture(const instrumenter::AttachmentShader& instrumented, const ExecuteOptions& options) {
  return capture(prepare(instrumented), instrumented.layout, options);
}

Captured Session::capture(const Prepared& prepared, const instrumenter::AttachmentLayout& layout,
                          const ExecuteOptions& options) {
  if (stage() != Stage::fragment) return captureThreads(prepared, layout, options);
  Captured captured;
  captured.layout = layout;
  if (layout.discarded_block.empty()) {
    captured.execution = execute(prepared, options);
    captured.threads = joinAttachments(captured.execution, layout.words);
    if (shader().traits.uses_discard) {
      captured.execution.check.left_out =
          "threads that end in a discard write nothing and are left out (this driver or dialect has no "
          "storage "
          "buffers for them); 'debug --pixel' follows them";
    }
  } else {
    const instrumenter::DiscardedThreads discarded = executeWithList(prepared, options, captured);
    captured.threads = joinAttachments(captured.execution, layout.words);
    captured.execution.check.left_out =
        addDiscarded(captured.threads, layout, discarded, countsRowsFromTop(shader()));
    captured.execution.storage.clear();
  }
  captured.execution.attachments.clear();
  return captured;
}

// Executes with room for the list of discarded threads, once more if there are more of them than before. The
// list points into `captured`'s storage.
instrumenter::DiscardedThreads Session::executeWithList(const Prepared& prepared, ExecuteOptions options,
                                                        Captured& captured) {
  const auto words = static_cast<std::uint64_t>(captured.layout.discarded_words);
  const std::uint64_t most = (kMostWords - kNoRoom) / words;
  while (true) {
    const std::uint64_t room = std::min(state_->discarded_room, most);
    options.storage = {0, static_cast<std::uint32_t>(room), 0, 0};
    options.storage_words = kNoRoom + room * words;
    captured.execution = execute(prepared, options);
    const auto discarded = instrumenter::decodeDiscarded(captured.layout, captured.execution.storage);
    if (discarded.ended <= room || room == most) return discarded;
    state_->discarded_room = discarded.ended;
  }
}

Session::PreparedRecording Session::prepareRecording() {
  auto instrumented = instrumenter::instrumentRecording(shader(), target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) {
    throw Error(Outcome::cannot_debug, failure->reason);
  }
  auto& recording_shader = std::get<instrumenter::RecordingShader>(instrumented);
  Prepared prepared = prepare(recording_shader);
  return {std::move(recording_shader), std::move(prepared)};
}

Session::Recorded Session::record(int x, int y, int width, int height) {
  return record(prepareRecording(), x, y, width, height);
}

Session::Recorded Session::record(const PreparedRecording& prepared, int x, int y, int width, int height) {
  // The shader compares with gl_FragCoord, which may count rows from the top.
  const bool from_top = countsRowsFromTop(shader());
  const int first_row = from_top ? facts().height - y - height : y;
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const std::uint64_t room = pixels == 1 ? kFirstRoomPerThread : 4096;
  Recorded recorded = recordWith(prepared,
                                 {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(first_row),
                                  static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
                                 pixels * kThreadsPerPixel, room);
  if (from_top) {
    for (auto& thread : recorded.recording.threads) thread.y = facts().height - 1 - thread.y;
  }
  recorded.visible = joinAttachments(recorded.execution, recorded.layout.attachment.words);
  return recorded;
}

Session::Recorded Session::record(const PreparedRecording& prepared,
                                  const std::vector<std::int32_t>& identity) {
  std::vector<std::uint32_t> thread(4);
  for (std::size_t i = 0; i < identity.size() && i < thread.size(); ++i)
    thread[i] = static_cast<std::uint32_t>(identity[i]);
  return recordWith(prepared, thread, kThreadsPerIdentity, kFirstRoomPerThread);
}

// With as much room as is needed: `threads` and `room` (words each) are the first try.
Session::Recorded Session::recordWith(const PreparedRecording& prepared,
                                      const std::vector<std::uint32_t>& which, std::uint64_t threads,
                                      std::uint64_t room) {
  const instrumenter::RecordingLayout& layout = prepared.shader.layout;
  while (true) {
    const std::uint64_t words = instrumenter::kRecordingHeader + threads * room;
    if (words > kMostWords) {
      throw Error(Outcome::cannot_debug, "the recording of these threads would take " +
                                             std::to_string(words * 4 >> 20) +
                                             " MiB; record fewer of them at once");
    }
    ExecuteOptions options;
    options.uniforms.push_back({layout.pixel_uniform, 0x8B55, which});
    options.storage = {0, static_cast<std::uint32_t>(room), static_cast<std::uint32_t>(threads), 0};
    options.storage_words = words;
    options.read_outputs = true;
    Recorded recorded;
    recorded.execution = execute(prepared.program, options);
    recorded.layout = layout;
    recorded.recording = instrumenter::decodeRecording(layout, recorded.execution.storage);
    if (!recorded.recording.error.empty()) throw Error(Outcome::failed, recorded.recording.error);

    std::uint64_t wanted = 0;
    for (const auto& thread : recorded.recording.threads) {
      if (!thread.complete) wanted = std::max<std::uint64_t>(wanted, thread.wanted);
    }
    if (wanted == 0 && recorded.recording.started <= threads) return recorded;
    threads = std::max<std::uint64_t>(recorded.recording.started, 1);
    room = std::max<std::uint64_t>(room, wanted + instrumenter::kThreadHeader);
  }
}

void Session::release(std::uint32_t handle) noexcept {
  if (!state_->stop || !state_->programs.isStopped()) return;
  try {
    wire::ReleaseT release;
    release.handle = handle;
    state_->ask<wire::DoneT>(std::move(release));
  } catch (const Error&) {
    // The program is gone or will be: nothing is left to release.
  }
}

}  // namespace shadestep::session
