// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/guard/guards.h"

#include <array>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/query.h"

namespace shadestep::guard {
namespace {

using dispatch::gl;

GLuint binding(GLenum name) {
  return static_cast<GLuint>(integer(name));
}

constexpr std::array kStages = {GL_VERTEX_SHADER,   GL_TESS_CONTROL_SHADER, GL_TESS_EVALUATION_SHADER,
                                GL_GEOMETRY_SHADER, GL_FRAGMENT_SHADER,     GL_COMPUTE_SHADER};

}  // namespace

int viewportCount(const ContextFacts& facts) {
  return facts.viewportArrays() ? integer(GL_MAX_VIEWPORTS) : 0;
}

// ---- capabilities
// --------------------------------------------------------------------------------------------

CapabilityGuard::CapabilityGuard(GLenum capability, int indices)
    : capability_(capability), indexed_(indices > 0) {
  if (!indexed_) {
    enabled_.push_back(gl().IsEnabled(capability));
    return;
  }
  for (int i = 0; i < indices; ++i) enabled_.push_back(gl().IsEnabledi(capability, static_cast<GLuint>(i)));
}

void CapabilityGuard::enable() const {
  gl().Enable(capability_);
}

void CapabilityGuard::disable() const {
  gl().Disable(capability_);
}

void CapabilityGuard::restore() const {
  if (!indexed_) {
    enabled_[0] ? gl().Enable(capability_) : gl().Disable(capability_);
    return;
  }
  for (GLuint i = 0; i < enabled_.size(); ++i) {
    enabled_[i] ? gl().Enablei(capability_, i) : gl().Disablei(capability_, i);
  }
}

// ---- framebuffers
// --------------------------------------------------------------------------------------------

FramebufferGuard::FramebufferGuard(const ContextFacts& facts)
    : srgb_switch_(facts.srgbSwitch()),
      scissor_(GL_SCISSOR_TEST, viewportCount(facts)),
      srgb_(srgb_switch_ ? GL_FRAMEBUFFER_SRGB : GL_SCISSOR_TEST),
      draw_(binding(GL_DRAW_FRAMEBUFFER_BINDING)),
      read_(binding(GL_READ_FRAMEBUFFER_BINDING)),
      renderbuffer_(binding(GL_RENDERBUFFER_BINDING)) {}

FramebufferGuard::~FramebufferGuard() {
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, draw_);
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, read_);
  gl().BindRenderbuffer(GL_RENDERBUFFER, renderbuffer_);
}

void FramebufferGuard::unclip() const {
  scissor_.disable();
  if (srgb_switch_) srgb_.disable();
}

void FramebufferGuard::clipAsProgram() const {
  scissor_.restore();
  if (srgb_switch_) srgb_.restore();
}

// ---- programs
// ------------------------------------------------------------------------------------------------

ProgramGuard::ProgramGuard(const ContextFacts& facts)
    : pipelines_(facts.programPipelines()),
      program_(binding(GL_CURRENT_PROGRAM)),
      pipeline_(pipelines_ ? binding(GL_PROGRAM_PIPELINE_BINDING) : 0) {
  if (facts.pausesTransformFeedback()) {
    GLboolean active = GL_FALSE;
    GLboolean paused = GL_FALSE;
    gl().GetBooleanv(GL_TRANSFORM_FEEDBACK_ACTIVE, &active);
    gl().GetBooleanv(GL_TRANSFORM_FEEDBACK_PAUSED, &paused);
    if (active && !paused) {
      gl().PauseTransformFeedback();
      paused_ = true;
    }
  }
  if (!facts.subroutines()) return;
  for (const GLenum stage : kStages) {
    const GLuint program = stageProgram(stage);
    if (program == 0) continue;
    GLint locations = 0;
    gl().GetProgramStageiv(program, stage, GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, &locations);
    if (locations <= 0) continue;
    StageSubroutines saved{stage, std::vector<GLuint>(static_cast<std::size_t>(locations))};
    for (GLint i = 0; i < locations; ++i)
      gl().GetUniformSubroutineuiv(stage, i, &saved.indices[static_cast<std::size_t>(i)]);
    subroutines_.push_back(std::move(saved));
  }
  clearErrors();  // asking about a stage that the program lacks is an error
}

ProgramGuard::~ProgramGuard() {
  makeCurrent();
  if (paused_) gl().ResumeTransformFeedback();
}

// The program that a stage of the draw comes from, 0 = none.
GLuint ProgramGuard::stageProgram(GLenum stage) const {
  if (program_ != 0 || pipeline_ == 0) return program_;
  GLint program = 0;
  gl().GetProgramPipelineiv(pipeline_, stage, &program);
  return static_cast<GLuint>(program);
}

void ProgramGuard::makeCurrent() const {
  if (pipelines_) gl().BindProgramPipeline(pipeline_);
  gl().UseProgram(program_);
  for (const StageSubroutines& saved : subroutines_) {
    gl().UniformSubroutinesuiv(saved.stage, static_cast<GLsizei>(saved.indices.size()), saved.indices.data());
  }
}

// ---- reading pixels
// ------------------------------------------------------------------------------------------

PixelReadGuard::PixelReadGuard(const ContextFacts& facts)
    : clamps_(!facts.es && facts.atLeast(30, 0)),
      transfers_(facts.compatibility()),
      has_pack_buffer_(facts.pixelBuffers()) {
  std::vector<GLenum> pack = {GL_PACK_ALIGNMENT};
  if (facts.atLeast(11, 30))
    pack.insert(pack.end(), {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS});
  if (!facts.es)
    pack.insert(pack.end(),
                {GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST, GL_PACK_SKIP_IMAGES, GL_PACK_IMAGE_HEIGHT});
  if (facts.has("GL_MESA_pack_invert")) pack.push_back(GL_PACK_INVERT_MESA);
  for (const GLenum name : pack) {
    pack_.push_back({name, static_cast<GLfloat>(integer(name))});
    gl().PixelStorei(name, name == GL_PACK_ALIGNMENT ? 1 : 0);
  }
  if (has_pack_buffer_) {
    pack_buffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
    gl().BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  }
  if (clamps_) {
    clamp_ = integer(GL_CLAMP_READ_COLOR);
    gl().ClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
  }
  if (!transfers_) return;
  for (const GLenum name : {GL_RED_SCALE, GL_GREEN_SCALE, GL_BLUE_SCALE, GL_ALPHA_SCALE, GL_DEPTH_SCALE,
                            GL_RED_BIAS, GL_GREEN_BIAS, GL_BLUE_BIAS, GL_ALPHA_BIAS, GL_DEPTH_BIAS,
                            GL_INDEX_SHIFT, GL_INDEX_OFFSET, GL_MAP_COLOR, GL_MAP_STENCIL}) {
    Parameter parameter{static_cast<GLenum>(name), 0};
    gl().GetFloatv(parameter.name, &parameter.value);
    transfer_.push_back(parameter);
    const bool scale = name == GL_RED_SCALE || name == GL_GREEN_SCALE || name == GL_BLUE_SCALE ||
                       name == GL_ALPHA_SCALE || name == GL_DEPTH_SCALE;
    gl().PixelTransferf(parameter.name, scale ? 1.0F : 0.0F);
  }
}

PixelReadGuard::~PixelReadGuard() {
  for (const Parameter& parameter : pack_)
    gl().PixelStorei(parameter.name, static_cast<GLint>(parameter.value));
  for (const Parameter& parameter : transfer_) gl().PixelTransferf(parameter.name, parameter.value);
  if (has_pack_buffer_) gl().BindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(pack_buffer_));
  if (clamps_) gl().ClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(clamp_));
}

// ---- transform feedback
// --------------------------------------------------------------------------------------

FeedbackGuard::FeedbackGuard(const ContextFacts& facts)
    : objects_(facts.pausesTransformFeedback()), discard_(GL_RASTERIZER_DISCARD) {
  gl().GetIntegerv(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, &generic_);
  if (objects_) {
    gl().GetIntegerv(GL_TRANSFORM_FEEDBACK_BINDING, &object_);
  } else {
    gl().GetIntegeri_v(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, &buffer_);
    gl().GetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_START, 0, &start_);
    gl().GetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, 0, &size_);
  }
  discard_.enable();
}

FeedbackGuard::~FeedbackGuard() {
  const auto buffer = static_cast<GLuint>(buffer_);
  if (objects_) {
    gl().BindTransformFeedback(GL_TRANSFORM_FEEDBACK, static_cast<GLuint>(object_));
  } else if (size_ > 0) {
    gl().BindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer, static_cast<GLintptr>(start_),
                         static_cast<GLsizeiptr>(size_));
  } else {
    gl().BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
  }
  gl().BindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, static_cast<GLuint>(generic_));
}

// ---- buffers
// -------------------------------------------------------------------------------------------------

StorageBindingGuard::StorageBindingGuard(int index)
    : index_(static_cast<GLuint>(index)), generic_(integer(GL_SHADER_STORAGE_BUFFER_BINDING)) {
  gl().GetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, index_, &buffer_);
  gl().GetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, index_, &start_);
  gl().GetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, index_, &size_);
}

StorageBindingGuard::~StorageBindingGuard() {
  const auto buffer = static_cast<GLuint>(buffer_);
  if (size_ > 0) {
    gl().BindBufferRange(GL_SHADER_STORAGE_BUFFER, index_, buffer, static_cast<GLintptr>(start_),
                         static_cast<GLsizeiptr>(size_));
  } else {
    gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, index_, buffer);
  }
  gl().BindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(generic_));
}

VertexArrayGuard::VertexArrayGuard()
    : vertex_array_(integer(GL_VERTEX_ARRAY_BINDING)), array_buffer_(integer(GL_ARRAY_BUFFER_BINDING)) {}

VertexArrayGuard::~VertexArrayGuard() {
  gl().BindVertexArray(static_cast<GLuint>(vertex_array_));
  gl().BindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(array_buffer_));
}

// ---- debug messages
// ------------------------------------------------------------------------------------------

SilenceGuard::SilenceGuard(const ContextFacts& facts) {
  if (!facts.debugOutput() || !gl().IsEnabled(GL_DEBUG_OUTPUT)) return;
  was_enabled_ = true;
  gl().Disable(GL_DEBUG_OUTPUT);
}

SilenceGuard::~SilenceGuard() {
  if (was_enabled_) gl().Enable(GL_DEBUG_OUTPUT);
}

}  // namespace shadestep::guard
