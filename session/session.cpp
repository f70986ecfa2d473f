#include "session/session.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "session/session_state.h"

namespace shadestep::session {
namespace {

namespace fs = std::filesystem;

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
  for (const auto& object : draw.stages) {
    const Stage stage = static_cast<Stage>(object->stage);
    const auto known = std::find_if(facts.stages.begin(), facts.stages.end(),
                                    [stage](const StageFacts& one) { return one.stage == stage; });
    StageFacts& one = known != facts.stages.end() ? *known : facts.stages.emplace_back();
    one.stage = stage;
    if (one.reason.empty()) one.reason = object->reason;
    frontend::ShaderObject& text = one.objects.emplace_back();
    for (const auto& source : object->sources) text.strings.push_back(source->text);
    for (const auto& string : object->named_strings)
      text.includes.named.emplace_back(string->name, string->text);
    text.includes.search_paths = object->search_paths;
  }
  facts.framebuffer = draw.framebuffer;
  facts.target_reason = draw.target_reason;
  for (std::size_t i = 0; i < 4 && i < draw.viewport.size(); ++i) facts.viewport[i] = draw.viewport[i];
  facts.width = draw.width;
  facts.height = draw.height;
  facts.draw_buffers = draw.draw_buffers;
  facts.max_draw_buffers = draw.max_draw_buffers;
  facts.max_storage_blocks = draw.max_storage_blocks;
  facts.layers = draw.layers;
  facts.samples = draw.samples;
  for (const auto& uniform : draw.uniforms) facts.active_uniforms[uniform->name] = uniform->size;
  for (const auto& one : draw.uniforms_elsewhere) {
    DrawFacts::Uniforms& uniforms = facts.uniforms_elsewhere[static_cast<Stage>(one->stage)];
    for (const auto& uniform : one->uniforms) uniforms[uniform->name] = uniform->size;
  }
  facts.replay_reason = draw.replay_reason;
  facts.feedback_components = draw.feedback_components;
  facts.draws_points = draw.draws_points;
  for (std::size_t i = 0; i < 6 && i < draw.storage_blocks.size(); ++i)
    facts.storage_blocks[i] = draw.storage_blocks[i];
  return facts;
}

std::string ordinalDraws(std::uint64_t draws) {
  if (draws == 0) return "has no draws";
  if (draws == 1) return "has 1 draw: 0";
  return "has " + std::to_string(draws) + " draws: 0 to " + std::to_string(draws - 1);
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

bool drawsOnce(const DrawStop& stop) {
  return stop.instances == 1 && stop.call.find("Multi") == std::string::npos &&
         stop.call.find("CallList") == std::string::npos;
}

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

const DrawFacts::Uniforms& DrawFacts::uniformsOf(Stage stage) const {
  const auto elsewhere = uniforms_elsewhere.find(stage);
  return elsewhere == uniforms_elsewhere.end() ? active_uniforms : elsewhere->second;
}

bool DrawFacts::has(const std::string& extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

// ---- the session ---------------------------------------------------------------------------------------

Session::Session(const LaunchOptions& options) {
  if (options.command.empty()) throw Error(Outcome::usage, "no program given; put it after '--'");
  state_ = std::make_unique<State>(options, findInterceptor(options.interceptor));
}

Session::~Session() = default;

int Session::processId() const {
  return state_->programs.processId();
}

DrawStop Session::runTo(std::uint64_t frame, std::uint64_t draw) {
  wire::ResumeT policy;
  policy.stop = true;
  policy.frame = frame;
  policy.draw = draw;
  const RunEnd at_end(state_->programs);
  const auto message = state_->run(policy);
  if (message == nullptr) {
    const LastSeen& last = state_->programs.lastSeen();
    if (last.used_gl && last.orderly && last.frame == frame) {
      throw Error(Outcome::nothing_matches, "no draw " + std::to_string(draw) + " in frame " +
                                                std::to_string(frame) + ", which " +
                                                ordinalDraws(last.draws));
    }
    throw Error(Outcome::ended, state_->programs.describeEnd("frame " + std::to_string(frame) + ", draw " +
                                                             std::to_string(draw)));
  }
  if (const wire::FrameEndedT* ended = message->body.AsFrameEnded()) {
    throw Error(Outcome::nothing_matches, "no draw " + std::to_string(draw) + " in frame " +
                                              std::to_string(ended->frame) + ", which " +
                                              ordinalDraws(ended->draws));
  }
  return state_->enter(*message->body.AsStopped());
}

std::vector<std::uint64_t> Session::forEachDraw(std::uint64_t first, std::uint64_t last,
                                                const std::function<void(const DrawStop&)>& visit) {
  const RunEnd at_end(state_->programs);
  std::vector<std::uint64_t> draws_per_frame;
  wire::ResumeT policy;
  policy.stop = true;
  policy.report_frames = true;
  policy.frame = first;
  policy.draw = 0;
  std::uint64_t frame = first;
  std::uint64_t draws = 0;
  while (frame <= last) {
    const auto message = state_->run(policy);
    if (message == nullptr) break;
    if (const wire::FrameEndedT* ended = message->body.AsFrameEnded()) {
      if (ended->frame < first) continue;
      draws_per_frame.push_back(ended->draws);
      policy.frame = frame = ended->frame + 1;
      policy.draw = draws = 0;
      continue;
    }
    const DrawStop stop = state_->enter(*message->body.AsStopped());
    if (stop.frame > last) break;
    visit(stop);
    frame = stop.frame;
    draws = stop.draw + 1;
    policy.frame = frame;
    policy.draw = draws;
  }
  // The last, never presented frame.
  if (frame <= last && !state_->programs.isStopped()) {
    const LastSeen& seen = state_->programs.lastSeen();
    if (!seen.used_gl || seen.frame < first || !seen.orderly) {
      throw Error(Outcome::ended, state_->programs.describeEnd("frame " + std::to_string(first) + " ended"));
    }
    if (seen.frame == frame && (seen.draws > 0 || draws_per_frame.empty()))
      draws_per_frame.push_back(seen.draws);
  }
  return draws_per_frame;
}

DrawStop Session::State::enter(const wire::StoppedT& stopped) {
  stop = DrawStop{stopped.frame, stopped.draw, stopped.call, stopped.mode, stopped.count, stopped.instances};
  return *stop;
}

int Session::runToEnd() {
  const RunEnd at_end(state_->programs);
  while (state_->run(wire::ResumeT{}) != nullptr) {
  }
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
  if (const auto known = state_->shaders.find(stage); known != state_->shaders.end()) return *known->second;
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
    const frontend::Analysis& analysis = state_->analyses.of(stage, one.objects, driver);
    if (!analysis.shader) {
      throw Error(Outcome::cannot_debug,
                  "the " + std::string(stageName(stage)) + " shader cannot be analysed: " + analysis.error);
    }
    return *state_->shaders.emplace(stage, &*analysis.shader).first->second;
  }
  throw Error(Outcome::nothing_matches,
              "the draw's program has no " + std::string(stageName(stage)) + " shader; it has: " + present);
}

std::vector<SampledTexture> Session::textures(const std::vector<SamplerName>& samplers) {
  wire::DescribeTexturesT request;
  request.stage = static_cast<wire::Stage>(stage());
  for (const SamplerName& sampler : samplers) {
    request.samplers.push_back(std::make_unique<wire::SamplerNameT>());
    request.samplers.back()->name = sampler.uniform;
    request.samplers.back()->target = sampler.target;
  }
  const auto [reply, bulk] = state_->ask<wire::TexturesT>(std::move(request));
  if (reply.textures.size() != samplers.size())
    throw Error(Outcome::failed, "the agent's answer is incomplete; report this as a bug");
  std::vector<SampledTexture> textures;
  for (const auto& told : reply.textures) {
    SampledTexture texture;
    texture.uniform = told->name;
    texture.reason = told->reason;
    texture.unit = told->unit;
    texture.texture = told->texture;
    texture.min_filter = told->min_filter;
    texture.mag_filter = told->mag_filter;
    for (std::size_t i = 0; i < std::min<std::size_t>(told->wrap.size(), 3); ++i)
      texture.wrap[i] = told->wrap[i];
    texture.min_lod = told->min_lod;
    texture.max_lod = told->max_lod;
    texture.lod_bias = told->lod_bias;
    texture.anisotropy = told->anisotropy;
    texture.base_level = told->base_level;
    texture.samples = told->samples;
    for (const auto& size : told->levels) texture.levels.push_back({size->width, size->height, size->depth});
    textures.push_back(std::move(texture));
  }
  return textures;
}

std::vector<BoundBuffer> Session::buffers() {
  const auto [reply, bulk] = state_->ask<wire::BuffersT>(wire::DescribeBuffersT{});
  std::vector<BoundBuffer> buffers;
  for (const auto& told : reply.buffers) {
    BoundBuffer one{static_cast<BufferUse>(told->use),
                    told->name,
                    told->index,
                    told->buffer,
                    told->offset,
                    told->bytes,
                    told->reason,
                    {},
                    told->components,
                    told->type,
                    told->stride,
                    told->normalized,
                    told->divisor};
    for (const auto& member : told->members)
      one.members.push_back({member->name, member->type, member->offset, member->count, member->stride,
                             member->matrix_stride, member->row_major, member->outer_count,
                             member->outer_stride});
    buffers.push_back(std::move(one));
  }
  return buffers;
}

std::vector<std::byte> Session::readBuffer(std::uint32_t buffer, std::uint64_t offset, std::uint64_t bytes) {
  wire::ReadBufferT request;
  request.buffer = buffer;
  request.offset = offset;
  request.bytes = bytes;
  auto [reply, descriptor] = state_->ask<wire::BufferBytesT>(std::move(request));
  const wire::SharedMemory bulk = wire::SharedMemory::map(std::move(descriptor));
  if (reply.range == nullptr || reply.range->bytes != bytes || reply.range->offset > bulk.size() ||
      bytes > bulk.size() - reply.range->offset)
    throw Error(Outcome::failed, "the agent's answer does not fit its memory; report this as a bug");
  const std::byte* const first = bulk.data() + reply.range->offset;
  return {first, first + bytes};
}

void Session::select(Stage stage) {
  if (state_->stage != stage) state_->undefined.reset();
  state_->stage = stage;
}

Stage Session::stage() const {
  return state_->stage;
}

void Session::requireCapturable() {
  shader();  // throws if it cannot be analysed
  const DrawFacts& draw = facts();
  const std::string& reason = stage() == Stage::fragment ? draw.target_reason : draw.replay_reason;
  if (!reason.empty()) throw Error(Outcome::cannot_debug, reason);
}

instrumenter::Target Session::target() {
  const DrawFacts& draw = facts();
  const int version = draw.major * 100 + draw.minor * 10;
  instrumenter::Target target;
  const auto& tokens = shader().tokens;
  const auto own_blocks = std::count_if(tokens.begin(), tokens.end(),
                                        [](const frontend::Token& token) { return token.text == "buffer"; });
  target.storage_buffers = draw.storage_blocks[static_cast<std::size_t>(stage())] > own_blocks;
  target.bit_encoding = draw.has("GL_ARB_shader_bit_encoding") || (draw.es ? version >= 300 : version >= 330);
  target.shader_clock = draw.has("GL_ARB_shader_clock");
  target.realtime_clock = draw.has("GL_EXT_shader_realtime_clock");
  target.query_lod = draw.has("GL_ARB_texture_query_lod");
  target.es_draw_buffers = draw.has("GL_EXT_draw_buffers");
  target.max_draw_buffers = draw.max_draw_buffers;
  target.used_draw_buffers = draw.draw_buffers;
  target.gpu_shader4 = draw.has("GL_EXT_gpu_shader4");
  target.draw_instanced = draw.has("GL_ARB_draw_instanced");
  const bool compared = (stage() == Stage::vertex && draw.draws_points) || stage() == Stage::tess_eval;
  if (draw.feedback_components > 0 && compared)
    target.feedback_components =
        draw.feedback_components - comparedOutputs(shader(), draw.feedback_components).words;
  if (stage() == Stage::geometry) target.feedback_components = draw.feedback_components;
  return target;
}

}  // namespace shadestep::session
