#include "session/session.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>

#include "session/programs.h"

namespace shadestep::session {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kFirstRoomPerThread = 1 << 16;  // words a recorded thread may write at the first try
constexpr std::uint32_t kThreadsPerPixel = 16;          // fragments expected at most on one pixel, first try
constexpr std::uint64_t kMostRecordingWords = 1ull << 28;  // 1 GiB

std::string providerName(wire::Provider provider) {
  switch (provider) {
    case wire::Provider::Glx:
      return "GLX";
    case wire::Provider::Egl:
      return "EGL";
    case wire::Provider::OsMesa:
      return "OSMesa";
    default:
      return "none";
  }
}

DrawFacts unpack(const wire::DrawT& draw) {
  DrawFacts facts;
  facts.provider = providerName(draw.provider);
  facts.version = draw.version;
  facts.renderer = draw.renderer;
  facts.vendor = draw.vendor;
  facts.glsl_version = draw.glsl_version;
  facts.es = draw.es;
  facts.core = draw.core;
  facts.major = draw.major;
  facts.minor = draw.minor;
  facts.extensions = draw.extensions;
  facts.program = draw.program;
  facts.program_reason = draw.program_reason;
  for (const auto& stage : draw.stages) {
    StageFacts one;
    one.stage = static_cast<Stage>(stage->stage);
    for (const auto& source : stage->sources) one.sources.push_back(source->text);
    one.reason = stage->reason;
    facts.stages.push_back(std::move(one));
  }
  facts.framebuffer = draw.framebuffer;
  facts.target_reason = draw.target_reason;
  for (std::size_t i = 0; i < 4 && i < draw.viewport.size(); ++i) facts.viewport[i] = draw.viewport[i];
  facts.width = draw.width;
  facts.height = draw.height;
  facts.draw_buffers = draw.draw_buffers;
  facts.max_draw_buffers = draw.max_draw_buffers;
  facts.max_storage_blocks = draw.max_storage_blocks;
  return facts;
}

std::string ordinalDraws(std::uint64_t draws) {
  if (draws == 0) return "has no draws";
  if (draws == 1) return "has 1 draw: 0";
  return "has " + std::to_string(draws) + " draws: 0 to " + std::to_string(draws - 1);
}

[[noreturn]] void raise(const wire::FailedT& failed) {
  switch (failed.kind) {
    case wire::ErrorKind::Compile:
      throw DriverRefusal("the driver refused the instrumented shader: ", failed.text);
    case wire::ErrorKind::Link:
      throw DriverRefusal("the driver could not link the instrumented program: ", failed.text);
    default:
      throw Error(Outcome::cannot_debug, failed.text);
  }
}

}  // namespace

std::string findInterceptor(const std::string& given) {
  if (!given.empty()) {
    if (!fs::exists(given)) throw Error(Outcome::usage, "no interceptor library at '" + given + "'");
    return fs::absolute(given);
  }
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place :
       {"../lib/libshadestep-gl.so", "libshadestep-gl.so", "../lib/shadestep/libshadestep-gl.so"}) {
    if (fs::exists(self / place)) return fs::weakly_canonical(self / place);
  }
  throw Error(Outcome::failed,
              "libshadestep-gl.so is not beside this executable; build the target shadestep-gl");
}

// ---- names ---------------------------------------------------------------------------------------------

namespace {
constexpr std::pair<Stage, const char*> kStageNames[] = {
    {Stage::vertex, "vertex"},     {Stage::tess_control, "tess-control"}, {Stage::tess_eval, "tess-eval"},
    {Stage::geometry, "geometry"}, {Stage::fragment, "fragment"},         {Stage::compute, "compute"},
};
}  // namespace

const char* stageName(Stage stage) {
  for (const auto& [value, name] : kStageNames) {
    if (value == stage) return name;
  }
  return "?";
}

std::optional<Stage> stageByName(const std::string& text) {
  for (const auto& [value, name] : kStageNames) {
    if (text == name) return value;
  }
  return std::nullopt;
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

bool DrawFacts::has(const std::string& extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

void Check::merge(const Check& other) {
  const bool fresh = !compared_at_all && reason.empty();
  if (fresh) {
    *this = other;
    return;
  }
  if (!other.compared_at_all && compared_at_all) reason = other.reason;
  compared_at_all = compared_at_all && other.compared_at_all;
  compared = std::max(compared, other.compared);
  differing = std::max(differing, other.differing);
}

// ---- prepared programs ---------------------------------------------------------------------------------

Prepared::Prepared(Prepared&& other) noexcept
    : compile_time(other.compile_time),
      session_(std::exchange(other.session_, nullptr)),
      handle_(other.handle_) {}

Prepared& Prepared::operator=(Prepared&& other) noexcept {
  if (this != &other) {
    if (session_ != nullptr) session_->release(handle_);
    session_ = std::exchange(other.session_, nullptr);
    handle_ = other.handle_;
    compile_time = other.compile_time;
  }
  return *this;
}

Prepared::~Prepared() {
  if (session_ != nullptr) session_->release(handle_);
}

// ---- the session ---------------------------------------------------------------------------------------

struct Session::State {
  State(const LaunchOptions& options, const std::string& interceptor)
      : programs(options.command, interceptor, options.program_output_to_stderr) {
    if (options.timeout.count() > 0) deadline = std::chrono::steady_clock::now() + options.timeout;
  }

  Programs programs;
  Programs::Deadline deadline;
  std::optional<DrawStop> stop;
  std::optional<DrawFacts> facts;
  std::map<Stage, frontend::Shader> shaders;

  void leaveStop() {
    stop.reset();
    facts.reset();
    shaders.clear();
  }

  wire::Packet request(wire::MessageT& message) { return programs.request(message, deadline); }

  template <class Reply, class Request>
  std::pair<Reply, wire::Descriptor> ask(Request&& request_body) {
    if (!stop) throw Error(Outcome::failed, "select a draw first");
    wire::MessageT message;
    message.body.Set(std::forward<Request>(request_body));
    wire::Packet packet = request(message);
    std::unique_ptr<wire::MessageT> reply(wire::UnPackMessage(packet.bytes.data()));
    if (const wire::FailedT* failed = reply->body.AsFailed()) raise(*failed);
    if (reply->body.type != wire::BodyTraits<typename Reply::TableType>::enum_value) {
      throw Error(Outcome::failed, "the agent answered something else than was asked; report this as a bug");
    }
    return {std::move(*static_cast<Reply*>(reply->body.value)), std::move(packet.bulk)};
  }
};

Session::Session(const LaunchOptions& options) {
  if (options.command.empty()) throw Error(Outcome::usage, "no program given; put it after '--'");
  state_ = std::make_unique<State>(options, findInterceptor(options.interceptor));
}

Session::~Session() = default;

DrawStop Session::runTo(std::uint64_t frame, std::uint64_t draw) {
  wire::ResumeT policy;
  policy.stop = true;
  policy.frame = frame;
  policy.draw = draw;
  state_->leaveStop();
  state_->programs.setPolicy(policy);
  state_->programs.resumeStopped();

  const auto message = state_->programs.waitForStop(state_->deadline);
  if (message == nullptr) {
    const LastSeen& last = state_->programs.lastSeen();
    if (last.used_gl && last.orderly && last.frame == frame) {
      throw Error(Outcome::nothing_matches, "no draw " + std::to_string(draw) + " in frame " +
                                                std::to_string(frame) + ", which " +
                                                ordinalDraws(last.draws));
    }
    throw Error(Outcome::ended, state_->programs.describeEnd() + ", before frame " + std::to_string(frame) +
                                    ", draw " + std::to_string(draw));
  }
  if (const wire::FrameEndedT* ended = message->body.AsFrameEnded()) {
    throw Error(Outcome::nothing_matches, "no draw " + std::to_string(draw) + " in frame " +
                                              std::to_string(ended->frame) + ", which " +
                                              ordinalDraws(ended->draws));
  }
  const wire::StoppedT* stopped = message->body.AsStopped();
  state_->stop = DrawStop{stopped->frame, stopped->draw,  stopped->call,
                          stopped->mode,  stopped->count, stopped->instances};
  return *state_->stop;
}

std::vector<std::uint64_t> Session::forEachDraw(std::uint64_t first, std::uint64_t last,
                                                const std::function<void(const DrawStop&)>& visit) {
  std::vector<std::uint64_t> draws_per_frame;
  wire::ResumeT policy;
  policy.stop = true;
  policy.report_frames = true;
  policy.frame = first;
  policy.draw = 0;
  std::uint64_t frame = first;
  std::uint64_t draws = 0;
  while (frame <= last) {
    state_->leaveStop();
    state_->programs.setPolicy(policy);
    state_->programs.resumeStopped();
    const auto message = state_->programs.waitForStop(state_->deadline);
    if (message == nullptr) break;
    if (const wire::FrameEndedT* ended = message->body.AsFrameEnded()) {
      if (ended->frame < first) continue;
      draws_per_frame.push_back(ended->draws);
      policy.frame = frame = ended->frame + 1;
      policy.draw = draws = 0;
      continue;
    }
    const wire::StoppedT* stopped = message->body.AsStopped();
    state_->stop = DrawStop{stopped->frame, stopped->draw,  stopped->call,
                            stopped->mode,  stopped->count, stopped->instances};
    if (stopped->frame > last) break;
    visit(*state_->stop);
    frame = stopped->frame;
    draws = stopped->draw + 1;
    policy.frame = frame;
    policy.draw = draws;
  }
  // The last, never presented frame.
  if (frame <= last && !state_->programs.isStopped()) {
    const LastSeen& seen = state_->programs.lastSeen();
    if (!seen.used_gl || seen.frame < first || !seen.orderly) {
      throw Error(Outcome::ended,
                  state_->programs.describeEnd() + ", before frame " + std::to_string(first) + " ended");
    }
    if (seen.frame == frame && (seen.draws > 0 || draws_per_frame.empty()))
      draws_per_frame.push_back(seen.draws);
  }
  return draws_per_frame;
}

int Session::runToEnd() {
  state_->leaveStop();
  state_->programs.setPolicy(wire::ResumeT{});
  state_->programs.resumeStopped();
  while (state_->programs.waitForStop(state_->deadline) != nullptr) state_->programs.resumeStopped();
  const auto& status = state_->programs.exitStatus();
  return status ? status->shellStatus() : 0;
}

void Session::quit() {
  state_->leaveStop();
  state_->programs.quit();
}

Progress Session::progress() {
  const LastSeen& last = state_->programs.lastSeen();
  return {last.frames, last.total_draws};
}

const DrawStop& Session::stop() const {
  if (!state_->stop) throw Error(Outcome::failed, "the program under debug is not stopped at a draw");
  return *state_->stop;
}

const DrawFacts& Session::facts() {
  if (!state_->facts) state_->facts = unpack(state_->ask<wire::DrawT>(wire::DescribeT{}).first);
  return *state_->facts;
}

const frontend::Shader& Session::shader(Stage stage) {
  if (const auto known = state_->shaders.find(stage); known != state_->shaders.end()) return known->second;
  const DrawFacts& draw = facts();
  if (!draw.program_reason.empty()) throw Error(Outcome::cannot_debug, draw.program_reason);

  std::string present;
  for (const StageFacts& one : draw.stages) {
    present += (present.empty() ? "" : ", ") + std::string(stageName(one.stage));
    if (one.stage != stage) continue;
    if (!one.reason.empty()) {
      throw Error(Outcome::cannot_debug,
                  "the " + std::string(stageName(stage)) + " shader cannot be debugged: " + one.reason);
    }
    frontend::PreprocessorFacts driver;
    driver.extensions = draw.extensions;
    driver.es = draw.es;
    frontend::Analysis analysis = frontend::analyse(stage, one.sources, driver);
    if (!analysis.shader) {
      throw Error(Outcome::cannot_debug,
                  "the " + std::string(stageName(stage)) + " shader cannot be analysed: " + analysis.error);
    }
    return state_->shaders.emplace(stage, std::move(*analysis.shader)).first->second;
  }
  throw Error(Outcome::nothing_matches,
              "the draw's program has no " + std::string(stageName(stage)) + " shader; it has: " + present);
}

std::vector<std::pair<std::string, std::string>> Session::glState() {
  const auto [reply, bulk] = state_->ask<wire::StateT>(wire::DescribeStateT{});
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& one : reply.values) values.emplace_back(one->name, one->value);
  return values;
}

void Session::requireCapturable() {
  shader(Stage::fragment);  // throws if it cannot be analysed
  const DrawFacts& draw = facts();
  if (!draw.target_reason.empty()) throw Error(Outcome::cannot_debug, draw.target_reason);
}

instrumenter::Target Session::target() {
  const DrawFacts& draw = facts();
  const int version = draw.major * 100 + draw.minor * 10;
  instrumenter::Target target;
  target.storage_buffers = draw.max_storage_blocks > 0;
  target.bit_encoding = draw.has("GL_ARB_shader_bit_encoding") || (draw.es ? version >= 300 : version >= 330);
  target.shader_clock = draw.has("GL_ARB_shader_clock");
  target.es_draw_buffers = draw.has("GL_EXT_draw_buffers");
  target.max_draw_buffers = draw.max_draw_buffers;
  target.used_draw_buffers = draw.draw_buffers;
  return target;
}

// ---- capture passes ------------------------------------------------------------------------------------

namespace {

std::vector<std::string> outputNames(const frontend::Shader& shader) {
  std::vector<std::string> names;
  for (const frontend::VariableId id : shader.outputs) {
    names.push_back(shader.variables[static_cast<std::size_t>(id)].name);
  }
  return names;
}

wire::PrepareT preparation(const frontend::Shader& shader, const std::string& text,
                           const instrumenter::AttachmentLayout& layout) {
  wire::PrepareT prepare;
  prepare.stage = static_cast<wire::Stage>(shader.stage);
  prepare.text = text;
  prepare.user_outputs = outputNames(shader);
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

// layout(origin_upper_left) in vec4 gl_FragCoord;
bool countsRowsFromTop(const frontend::Shader& shader) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [](const frontend::Token& token) { return token.text == "origin_upper_left"; });
}

// The words of one range of the bulk memory; throws if the agent's numbers do not fit.
std::vector<std::uint32_t> wordsOf(const wire::SharedMemory& bulk, const wire::BulkRangeT* range) {
  if (range == nullptr || range->bytes == 0) return {};
  if (range->offset > bulk.size() || range->bytes > bulk.size() - range->offset) {
    throw Error(Outcome::failed, "the agent's answer does not fit its memory; report this as a bug");
  }
  std::vector<std::uint32_t> words(range->bytes / 4);
  std::memcpy(words.data(), bulk.data() + range->offset, words.size() * 4);
  return words;
}

}  // namespace

Prepared Session::prepare(const instrumenter::AttachmentShader& instrumented) {
  requireCapturable();
  auto prepare = preparation(shader(Stage::fragment), instrumented.text, instrumented.layout);
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  Prepared prepared(this, reply.handle);
  prepared.compile_time = std::chrono::nanoseconds(reply.compile_ns);
  return prepared;
}

Prepared Session::prepare(const instrumenter::RecordingShader& instrumented) {
  requireCapturable();
  auto prepare = preparation(shader(Stage::fragment), instrumented.text, instrumented.layout.attachment);
  prepare.storage_block = instrumented.layout.block;
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  Prepared prepared(this, reply.handle);
  prepared.compile_time = std::chrono::nanoseconds(reply.compile_ns);
  return prepared;
}

Prepared Session::prepareOriginal() {
  requireCapturable();
  wire::PrepareT prepare;
  prepare.stage = wire::Stage::Fragment;
  prepare.user_outputs = outputNames(shader(Stage::fragment));  // their places are the program's choice
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  return Prepared(this, reply.handle);
}

Prepared Session::prepareCovering(const std::string& fragment_text, const std::string& vertex_text) {
  requireCapturable();
  wire::PrepareT prepare;
  prepare.stage = wire::Stage::Fragment;
  prepare.text = fragment_text;
  prepare.geometry = wire::Geometry::Covering;
  prepare.vertex_text = vertex_text;
  prepare.user_outputs = outputNames(shader(Stage::fragment));
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  return Prepared(this, reply.handle);
}

Execution Session::execute(const Prepared& prepared, const ExecuteOptions& options) {
  wire::ExecuteT execute;
  execute.handle = prepared.handle();
  for (const Uniform& uniform : options.uniforms) {
    auto value = std::make_unique<wire::UniformValueT>();
    value->name = uniform.name;
    value->gl_type = uniform.gl_type;
    value->words = uniform.words;
    execute.uniforms.push_back(std::move(value));
  }
  execute.storage = options.storage;
  execute.storage_words = options.storage_words;
  execute.compare = options.compare;
  execute.read_outputs = options.read_outputs;
  execute.read_captures = options.read_captures;
  execute.repeats = static_cast<std::uint32_t>(options.repeats);
  execute.covering_size = options.covering_size;

  auto [reply, descriptor] = state_->ask<wire::ExecutedT>(std::move(execute));
  const wire::SharedMemory bulk = wire::SharedMemory::map(std::move(descriptor));
  Execution result;
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
    output.words = wordsOf(bulk, reply.outputs[i].get());
    result.outputs.push_back(std::move(output));
  }
  result.storage = wordsOf(bulk, reply.storage.get());
  for (const std::uint64_t ns : reply.times_ns) result.times.emplace_back(ns);
  result.check.compared_at_all = options.compare && reply.compare_reason.empty();
  result.check.compared = reply.compared;
  result.check.differing = reply.differing;
  result.check.reason = options.compare ? reply.compare_reason : "not asked for";
  return result;
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
  const Prepared prepared = prepare(instrumented);
  Captured captured;
  captured.layout = instrumented.layout;
  captured.execution = execute(prepared, options);
  captured.threads = joinAttachments(captured.execution, instrumented.layout.words);
  captured.execution.attachments.clear();
  if (shader(Stage::fragment).traits.uses_discard) {
    captured.execution.check.left_out =
        "threads that end in a discard write nothing and are left out; 'debug --pixel' follows them";
  }
  return captured;
}

Session::PreparedRecording Session::prepareRecording() {
  auto instrumented = instrumenter::instrumentRecording(shader(Stage::fragment), target());
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
  const instrumenter::RecordingShader& recording_shader = prepared.shader;
  // The shader compares with gl_FragCoord, which may count rows from the top.
  const bool from_top = countsRowsFromTop(shader(Stage::fragment));
  const int first_row = from_top ? facts().height - y - height : y;
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  std::uint64_t threads = pixels * kThreadsPerPixel;
  std::uint64_t room = pixels == 1 ? kFirstRoomPerThread : 4096;
  while (true) {
    const std::uint64_t words = instrumenter::kRecordingHeader + threads * room;
    if (words > kMostRecordingWords) {
      throw Error(Outcome::cannot_debug, "the recording of these pixels would take " +
                                             std::to_string(words * 4 >> 20) +
                                             " MiB; record fewer pixels at once");
    }
    ExecuteOptions options;
    options.uniforms.push_back({recording_shader.layout.pixel_uniform,
                                0x8B55,
                                {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(first_row),
                                 static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}});
    options.storage = {0, static_cast<std::uint32_t>(room), static_cast<std::uint32_t>(threads), 0};
    options.storage_words = words;
    options.read_outputs = true;
    Recorded recorded;
    recorded.execution = execute(prepared.program, options);
    recorded.layout = recording_shader.layout;
    recorded.recording = instrumenter::decodeRecording(recording_shader.layout, recorded.execution.storage);
    if (!recorded.recording.error.empty()) throw Error(Outcome::failed, recorded.recording.error);

    std::uint64_t wanted = 0;
    for (const auto& thread : recorded.recording.threads) {
      if (!thread.complete) wanted = std::max<std::uint64_t>(wanted, thread.wanted);
    }
    if (wanted == 0 && recorded.recording.started <= threads) {
      for (auto& thread : recorded.recording.threads) {
        if (from_top) thread.y = facts().height - 1 - thread.y;
      }
      recorded.visible = joinAttachments(recorded.execution, recording_shader.layout.attachment.words);
      return recorded;
    }
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
