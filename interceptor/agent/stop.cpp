// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/stop.h"

#include <algorithm>
#include <set>

#include "interceptor/agent/describe_buffers.h"
#include "interceptor/agent/describe_textures.h"
#include "interceptor/agent/executed.h"
#include "interceptor/agent/query_pause.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/fragment_guards.h"
#include "interceptor/guard/plain_samplers.h"
#include "interceptor/guard/scissor_guard.h"
#include "interceptor/guard/state_digest.h"
#include "interceptor/replay/writable.h"

namespace shadestep::agent {
namespace {

using dispatch::gl;
using guard::OrRefusal;
using guard::Refusal;

template <class Body>
Reply replied(OrRefusal<Body>&& result) {
  if (const auto* refusal = std::get_if<Refusal>(&result)) return failed(*refusal);
  return success(std::get<Body>(std::move(result)));
}

std::uint64_t pixelBytes(int width, int height) {
  return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * 16;
}

// Whether the program's state changes what capture buffers would receive, so that one draw cannot both draw
// the program's outputs and capture: then there are two.
bool spoilsCaptures(const guard::ContextFacts& facts, const replay::ProgramCopy& copy) {
  if (copy.captures.empty()) return false;
  if (copy.dual_source) return true;  // allows for no draw buffers beside the program's own
  if (!facts.indexedDrawBuffers()) {
    GLboolean mask[4] = {};
    gl().GetBooleanv(GL_COLOR_WRITEMASK, mask);
    if (gl().IsEnabled(GL_BLEND) || !mask[0] || !mask[1] || !mask[2] || !mask[3]) return true;
  }
  if (facts.es) return false;
  if (gl().IsEnabled(GL_COLOR_LOGIC_OP) || gl().IsEnabled(GL_SAMPLE_ALPHA_TO_ONE)) return true;
  GLint clamp = GL_FALSE;
  if (facts.compatibility() && facts.atLeast(30, 0)) gl().GetIntegerv(GL_CLAMP_FRAGMENT_COLOR, &clamp);
  return clamp == GL_TRUE;
}

bool sameRaster(const wire::RasterT& a, const wire::RasterT& b) {
  return a.alpha_test == b.alpha_test && a.depth_test == b.depth_test && a.stencil_test == b.stencil_test &&
         a.blend == b.blend && a.clear_buffers == b.clear_buffers && a.provoking == b.provoking;
}

std::vector<int> locations(const std::vector<capture::CaptureBuffer>& captures) {
  std::vector<int> result;
  for (const capture::CaptureBuffer& buffer : captures) result.push_back(buffer.location);
  return result;
}

}  // namespace

Stop::Stop(const calls::DrawCall& call) : call_(call) {}

wire::StoppedT Stop::announcement(std::uint64_t frame, std::uint64_t draw) const {
  wire::StoppedT stopped;
  stopped.frame = frame;
  stopped.draw = draw;
  stopped.call = call_.name;
  stopped.mode = call_.mode;
  stopped.count = call_.count;
  stopped.instances = call_.instances;
  return stopped;
}

Reply Stop::answer(const wire::MessageT& request) {
  const guard::SilenceGuard silence(facts().context);
  beside_.begin();
  Reply reply;
  if (request.body.AsDescribe() != nullptr) {
    reply = success(describe(facts()));
  } else if (request.body.AsDescribeState() != nullptr) {
    reply = replied(describeState());
  } else if (const wire::DescribeTexturesT* textures = request.body.AsDescribeTextures()) {
    reply = success(describeTextures(facts(), *textures));
  } else if (request.body.AsDescribeBuffers() != nullptr) {
    reply = replied(describeBuffers(facts()));
  } else if (const wire::ReadBufferT* read = request.body.AsReadBuffer()) {
    reply = replied(readBuffer(facts(), *read, beside_));
  } else if (const wire::PrepareT* prepare_request = request.body.AsPrepare()) {
    reply = replied(prepare(*prepare_request));
  } else if (const wire::ExecuteT* execute_request = request.body.AsExecute()) {
    beside_.giveBack(execute_request->given_back);
    reply = replied(execute(*execute_request, beside_));
    if (wire::ExecutedT* executed = reply.message.body.AsExecuted()) executed->memory = beside_.number();
  } else if (const wire::TimeBoxesT* boxes = request.body.AsTimeBoxes()) {
    reply = replied(timeBoxes(*boxes));
  } else if (const wire::ReleaseT* release = request.body.AsRelease()) {
    prepared_.erase(release->handle);
    reply = success(wire::DoneT{});
  } else {
    reply = failed(
        guard::internal("the agent does not know this request; use interceptor and shadestep of one build"));
  }
  guard::clearErrors();
  if (reply.message.body.AsFailed() == nullptr) reply.bulk = beside_.descriptor();
  return reply;
}

const DrawFacts& Stop::facts() {
  if (!facts_) facts_ = drawFacts(call_);
  return *facts_;
}

// ---- DescribeState
// -------------------------------------------------------------------------------------------

OrRefusal<wire::StateT> Stop::describeState() {
  wire::StateT state;
  for (guard::StateValue& value : guard::stateDigest(facts().context)) {
    auto one = std::make_unique<wire::StateValueT>();
    one->name = std::move(value.name);
    one->value = std::move(value.value);
    state.values.push_back(std::move(one));
  }
  return state;
}

// ---- Prepare
// -------------------------------------------------------------------------------------------------

OrRefusal<wire::PreparedT> Stop::prepare(const wire::PrepareT& request) {
  const bool unrasterized = request.geometry == wire::Geometry::Unrasterized;
  if (!facts().program_reason.empty()) return guard::unsupported(facts().program_reason);
  if (request.geometry == wire::Geometry::Replay && !facts().target.reason.empty()) {
    return guard::unsupported(facts().target.reason);
  }
  if (unrasterized && !facts().replay_reason.empty()) return guard::unsupported(facts().replay_reason);
  const guard::ProgramGuard program(facts().context);
  const replay::Original original = originalOf(facts(), request.stage);
  auto result = replay::copyProgram(facts().context, original, request, shaders_);
  if (const auto* refusal = std::get_if<Refusal>(&result)) return *refusal;
  auto copy = std::get<std::unique_ptr<replay::ProgramCopy>>(std::move(result));
  wire::PreparedT prepared;
  prepared.handle = next_handle_++;
  prepared.log = copy->log;
  prepared.compile_ns = copy->compile_ns;
  prepared.output_locations.assign(copy->output_locations.begin(), copy->output_locations.end());
  prepared_[prepared.handle] = std::move(copy);
  return prepared;
}

// ---- Execute
// -------------------------------------------------------------------------------------------------

OrRefusal<wire::ExecutedT> Stop::execute(const wire::ExecuteT& request, AnswerMemory& bulk) {
  const auto found = prepared_.find(request.handle);
  if (found == prepared_.end())
    return guard::internal("there is no prepared program with this handle at this stop");
  const replay::ProgramCopy& copy = *found->second;
  const bool wants_storage = request.storage_words > 0 || !request.storage.empty();
  if (wants_storage && !facts().context.storageBuffers()) {
    return guard::unsupported(
        "this driver has no storage buffers (OpenGL 4.3 or GL_ARB_shader_storage_buffer_object)");
  }
  const QueryPause queries(facts().context);
  const guard::ProgramGuard program(facts().context);
  const guard::FramebufferGuard framebuffers(facts().context);
  std::optional<guard::StorageBindingGuard> storage;
  if (wants_storage) storage.emplace(std::max(copy.storage_binding, 0));
  if (Refusal refusal = saveMemory(copy); !refusal.text.empty()) return refusal;
  const guard::MemoryGuard memory(*memory_);
  if (copy.stages) {
    if (!stages_) stages_.emplace(call_, facts(), *memory_, storage_, shaders_);
    return stages_->execute(copy, program, request, bulk);
  }
  return copy.covering ? cover(copy, request, bulk) : replay(copy, program, framebuffers, request, bulk);
}

// Every repeat starts from the same target contents and memory, zeroed captures and a fresh storage buffer:
// all repeats, and the program's own draw afterwards, see the same. None of that is in the measured time.
OrRefusal<wire::ExecutedT> Stop::replay(const replay::ProgramCopy& copy, const guard::ProgramGuard& program,
                                        const guard::FramebufferGuard& framebuffers,
                                        const wire::ExecuteT& request, AnswerMemory& bulk) {
  const guard::ContextFacts& context = facts().context;
  const capture::DrawTarget& target = facts().target;
  if (Refusal refusal = checkPlane(request); !refusal.text.empty()) return refusal;
  const guard::FragmentTestsGuard tests(context, request.raster.get());
  const guard::ProvokingVertexGuard provoking(request.raster.get());
  if (shadow_ == nullptr) shadow_ = std::make_unique<capture::Shadow>(context, target);
  setRaster(request.raster.get());
  DrawTraces traces(context, *shadow_, *memory_);
  const auto keep_reference = [&]() -> Refusal {
    if (!request.compare || check_.hasReference()) return {};
    program.makeCurrent();
    if (Refusal refusal = drawOriginal(framebuffers); !refusal.text.empty()) return refusal;
    return check_.keepReference(traces);
  };
  if (Refusal refusal = keep_reference(); !refusal.text.empty()) return refusal;

  wire::ExecutedT executed;
  executed.width = target.width;
  executed.height = target.height;
  const bool twice = spoilsCaptures(context, copy);
  const std::vector<capture::CaptureBuffer> none;
  {
    const guard::CaptureBufferGuard plain(context, twice ? std::vector<int>() : locations(copy.captures));
    if (Refusal refusal = replay::useCopy(copy, request.uniforms); !refusal.text.empty()) return refusal;
    CpuTime cpu;
    for (std::uint32_t i = 0; i < std::max(request.repeats, 1U); ++i) {
      if (Refusal refusal = prepareReplay(copy, framebuffers, request, twice ? none : copy.captures);
          !refusal.text.empty()) {
        return refusal;
      }
      timed(executed, cpu, [&] { call_.replay(call_.arguments, call_.mode); });
    }
    if (guard::clearErrors()) return guard::internal("the driver answers the draw call itself with an error");
  }

  BulkLayout layout;
  for (std::size_t i = 0; request.read_captures && i < copy.captures.size(); ++i) {
    executed.attachments.push_back(layout.add(pixelBytes(target.width, target.height)));
  }
  for (std::size_t i = 0; request.read_outputs && i < target.colors.size(); ++i) {
    const capture::ColorBuffer& color = target.colors[i];
    executed.outputs.push_back(layout.add(pixelBytes(target.width, target.height)));
    executed.output_draw_buffers.push_back(color.draw_buffer);
    executed.output_types.push_back(color.format.integer() ? color.format.type : GL_FLOAT);
  }
  executed.storage = layout.add(storage_.words() * 4);
  if (!layout.create(bulk)) return noMemory();

  readOutputs(request, executed, bulk);
  if (!twice) readCaptured(copy, request, executed, bulk);
  if (request.compare) {
    const auto draw_again = [&] {
      program.makeCurrent();
      return drawOriginal(framebuffers);
    };
    if (Refusal refusal = check_.compare(traces, draw_again, executed); !refusal.text.empty()) return refusal;
  } else {
    executed.compare_reason = "not asked for";
  }
  if (twice) {
    const guard::PlainColorGuard plain(context);
    if (Refusal refusal = replay::useCopy(copy, request.uniforms); !refusal.text.empty()) return refusal;
    if (Refusal refusal = prepareReplay(copy, framebuffers, request, copy.captures); !refusal.text.empty())
      return refusal;
    call_.replay(call_.arguments, call_.mode);
    readCaptured(copy, request, executed, bulk);
  }
  if (guard::clearErrors()) return guard::internal("the driver refused to read the captured values back");
  return executed;
}

Refusal Stop::checkPlane(const wire::ExecuteT& request) {
  const capture::DrawTarget& target = facts().target;
  if (request.layer >= 0 && request.layer < std::max(target.layers, 1) && request.sample >= 0 &&
      request.sample < std::max(target.samples, 1)) {
    return {};
  }
  return guard::unsupported("the draw's target has no layer " + std::to_string(request.layer) +
                            " with a sample " + std::to_string(request.sample));
}

// What the program's own program draws under other tests, or from other contents, is another reference.
void Stop::setRaster(const wire::RasterT* raster) {
  const wire::RasterT wanted = raster != nullptr ? *raster : wire::RasterT{};
  if (!sameRaster(wanted, raster_)) check_.dropReference();
  raster_ = wanted;
}

Refusal Stop::prepareReplay(const replay::ProgramCopy& copy, const guard::FramebufferGuard& framebuffers,
                            const wire::ExecuteT& request,
                            const std::vector<capture::CaptureBuffer>& captures) {
  if (Refusal refusal = resetStorage(storage_, copy, request); !refusal.text.empty()) return refusal;
  memory_->restore();
  return shadow_->fill(framebuffers, captures, start());
}

capture::Shadow::Start Stop::start() const {
  return raster_.clear_buffers ? capture::Shadow::Start::cleared : capture::Shadow::Start::copied;
}

void Stop::readOutputs(const wire::ExecuteT& request, const wire::ExecutedT& executed, AnswerMemory& bulk) {
  const guard::PixelReadGuard reading(facts().context);
  for (std::size_t i = 0; i < executed.outputs.size(); ++i) {
    shadow_->readOutput(facts().target.colors[i], {request.layer, request.sample},
                        bulk.data() + executed.outputs[i]->offset);
  }
}

// What one and the same draw left in the capture and the storage buffers.
void Stop::readCaptured(const replay::ProgramCopy& copy, const wire::ExecuteT& request,
                        const wire::ExecutedT& executed, AnswerMemory& bulk) {
  const guard::PixelReadGuard reading(facts().context);
  for (std::size_t i = 0; i < executed.attachments.size(); ++i) {
    shadow_->readCapture(copy.captures[i], {request.layer, request.sample},
                         bulk.data() + executed.attachments[i]->offset);
  }
  if (executed.storage->bytes > 0) storage_.read(bulk.data() + executed.storage->offset);
}

// The triangle covers the target whole and unblended: repeats need nothing in between but the program's
// memory.
OrRefusal<wire::ExecutedT> Stop::cover(const replay::ProgramCopy& copy, const wire::ExecuteT& request,
                                       AnswerMemory& bulk) {
  const guard::ContextFacts& context = facts().context;
  const int size = request.covering_size;
  if (size <= 0) return guard::unsupported("the covering target needs a size of at least one pixel");
  if (!copy.captures.empty()) return guard::unsupported("a covering triangle has no capture buffers");
  if (!context.vertexArrays() || !context.framebufferObjects()) {
    return guard::unsupported(
        "the driver has no framebuffer and vertex array objects, which a covering triangle needs");
  }

  wire::ExecutedT executed;
  executed.width = executed.height = size;
  executed.compare_reason = "a covering triangle has no original outputs";
  {
    const guard::VertexArrayGuard vertices;
    const guard::PlainRasterGuard raster(context, size, size);
    if (Refusal refusal = covering_.bind(size, copy.colour_outputs, copy.position_attribute);
        !refusal.text.empty()) {
      return refusal;
    }
    if (Refusal refusal = replay::useCopy(copy, request.uniforms); !refusal.text.empty()) return refusal;
    if (Refusal refusal = resetStorage(storage_, copy, request); !refusal.text.empty()) return refusal;
    const guard::PlainSamplersGuard samplers(request.plain_units, request.plain_levels);
    const std::size_t sets = std::max<std::size_t>(request.sets.size(), 1);
    CpuTime cpu;
    for (std::size_t i = 0; i < std::max(request.repeats, 1U) * sets; ++i) {
      if (!request.sets.empty()) {
        const std::string problem = replay::setUniforms(copy.program, request.sets[i % sets]->uniforms);
        if (!problem.empty()) return guard::unsupported(problem);
      }
      memory_->restore();
      timed(executed, cpu, [&] { covering_.draw(); });
    }
    if (guard::clearErrors()) return guard::internal("the driver answers the covering draw with an error");
  }

  BulkLayout layout;
  for (int i = 0; request.read_outputs && i < copy.colour_outputs; ++i) {
    executed.outputs.push_back(layout.add(pixelBytes(size, size)));
    executed.output_draw_buffers.push_back(i);
    executed.output_types.push_back(GL_FLOAT);
  }
  executed.storage = layout.add(storage_.words() * 4);
  if (!layout.create(bulk)) return noMemory();
  const guard::PixelReadGuard reading(context);
  for (std::size_t i = 0; i < executed.outputs.size(); ++i) {
    covering_.readOutput(static_cast<int>(i), bulk.data() + executed.outputs[i]->offset);
  }
  if (executed.storage->bytes > 0) storage_.read(bulk.data() + executed.storage->offset);
  if (guard::clearErrors()) return guard::internal("the driver refused to read the captured values back");
  return executed;
}

// Boxes do not overlap: all of a repeat may draw into one copy of the target, as the whole draw would.
OrRefusal<wire::BoxTimesT> Stop::timeBoxes(const wire::TimeBoxesT& request) {
  const guard::ContextFacts& context = facts().context;
  if (!facts().target.reason.empty()) return guard::unsupported(facts().target.reason);
  const QueryPause queries(context);
  const guard::ProgramGuard program(context);
  const guard::FramebufferGuard framebuffers(context);
  if (Refusal refusal = saveOwnMemory(); !refusal.text.empty()) return refusal;
  const guard::MemoryGuard memory(*memory_);
  if (shadow_ == nullptr) shadow_ = std::make_unique<capture::Shadow>(context, facts().target);
  wire::ExecutedT executed;
  CpuTime cpu;
  for (std::uint32_t i = 0; i < request.repeats; ++i) {
    if (Refusal refusal = shadow_->fill(framebuffers, {}, capture::Shadow::Start::copied);
        !refusal.text.empty())
      return refusal;
    const guard::ScissorGuard scissor(context);
    for (const wire::Box& box : request.boxes) {
      memory_->restore();
      scissor.restrictTo(box.x(), box.y(), box.width(), box.height());
      timed(executed, cpu, [&] { call_.replay(call_.arguments, call_.mode); });
    }
  }
  if (guard::clearErrors()) return guard::internal("the driver answers the draw call itself with an error");
  wire::BoxTimesT times;
  times.times_ns = std::move(executed.times_ns);
  times.cpu_ns = std::move(executed.cpu_ns);
  return times;
}

// Whatever the program's own shaders can write.
Refusal Stop::saveOwnMemory() {
  if (memory_) return {};
  const guard::ContextFacts& context = facts().context;
  memory_.emplace(context);
  std::set<GLuint> programs = {facts().program};
  for (const replay::StageProgram& stage : facts().stages) programs.insert(stage.program);
  for (const GLuint program : programs) {
    if (program == 0) continue;
    if (Refusal refusal = memory_->save(replay::writableBindings(context, program)); !refusal.text.empty())
      return refusal;
  }
  return {};
}

// The same, and whatever copies of them can. A dead block of the original may be alive in a copy, so that
// there is more to save, and to compare, than before.
Refusal Stop::saveMemory(const replay::ProgramCopy& copy) {
  const guard::ContextFacts& context = facts().context;
  if (Refusal refusal = saveOwnMemory(); !refusal.text.empty()) return refusal;
  guard::WritableBindings bindings = replay::writableBindings(context, copy.program);
  if (copy.storage_binding >= 0) bindings.storage.erase(static_cast<GLuint>(copy.storage_binding));
  const std::size_t before = memory_->sections().size();
  Refusal refusal = memory_->save(bindings);
  if (memory_->sections().size() != before) {
    check_.dropReference();
    if (stages_) stages_->dropReferences();
  }
  return refusal;
}

// What the program's own program draws, into the shadow. The program is current.
Refusal Stop::drawOriginal(const guard::FramebufferGuard& framebuffers) {
  memory_->restore();
  if (Refusal refusal = shadow_->fill(framebuffers, {}, start()); !refusal.text.empty()) return refusal;
  call_.replay(call_.arguments, call_.mode);
  if (guard::clearErrors()) return guard::internal("the driver answers the draw call itself with an error");
  return {};
}

}  // namespace shadestep::agent
