// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/describe.h"

#include <array>
#include <string_view>

#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/queries.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/query.h"
#include "interceptor/replay/stages.h"
#include "interceptor/replay/uniforms.h"

namespace shadestep::agent {
namespace {

using dispatch::gl;
using guard::integer;

std::string text(GLenum name) {
  const GLubyte* value = gl().GetString(name);
  return value != nullptr ? reinterpret_cast<const char*>(value) : "";
}

// Why there is no program to debug, or "".
std::string programReason(const DrawFacts& facts) {
  if (facts.program == 0 && facts.pipeline != 0) return "the draw's program pipeline has no shaders";
  if (facts.program == 0) return "the draw uses no GLSL program (fixed function or assembly programs)";
  GLint deleted = GL_FALSE;
  gl().GetProgramiv(facts.program, GL_DELETE_STATUS, &deleted);
  if (deleted && facts.pipeline == 0) {
    return "the program was deleted while in use: putting another in its place would end it for good";
  }
  GLint linked = GL_FALSE;
  gl().GetProgramiv(facts.program, GL_LINK_STATUS, &linked);
  if (!linked) return "the program's last link failed: the draw uses what an earlier link made";
  return facts.linked->reason;
}

bool feedbackUnpausable(const guard::ContextFacts& facts) {
  if (facts.pausesTransformFeedback() || !facts.atLeast(30, 0)) return false;
  GLint active = 0;  // before OpenGL 4.0 only the buffer binding tells
  gl().GetIntegeri_v(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, &active);
  return active != 0;
}

// Why the draw cannot be replayed here, or "".
std::string replayReason(const calls::DrawCall& call, const guard::ContextFacts& facts) {
  if (call.replay == nullptr) {
    return call.reason != nullptr ? call.reason : std::string(call.name) + " draws cannot be replayed yet";
  }
  if (facts.compatibility()) {
    if (integer(GL_LIST_INDEX) != 0) return "the call is being compiled into a display list";
    const std::string name = call.name;
    if (name.starts_with("glCallList")) {
      if (std::string obstacle = calls::listObstacle(); !obstacle.empty()) return obstacle;
    }
    if (integer(GL_RENDER_MODE) != GL_RENDER)
      return "the draw is made for selection or feedback and writes no pixels";
  }
  if (!calls::conditionHolds())
    return "the draw's condition (glBeginConditionalRender) does not hold: it draws nothing";
  if (feedbackUnpausable(facts))
    return "transform feedback buffers are bound, and this driver cannot pause the feedback";
  return "";
}

// Components of a vertex that a replay can capture by transform feedback: none where nobody knows what
// primitives the call draws.
int feedbackComponents(const calls::DrawCall& call, const guard::ContextFacts& facts) {
  if (!facts.transformFeedback() || call.mode == calls::kNoMode) return 0;
  return integer(GL_MAX_TRANSFORM_FEEDBACK_INTERLEAVED_COMPONENTS);
}

bool isDispatch(const calls::DrawCall& call) {
  return std::string_view(call.name).starts_with("glDispatchCompute");
}

wire::Provider provider() {
  switch (dispatch::currentProvider()) {
    case dispatch::Provider::glx:
      return wire::Provider::Glx;
    case dispatch::Provider::egl:
      return wire::Provider::Egl;
    case dispatch::Provider::osmesa:
      return wire::Provider::OsMesa;
    case dispatch::Provider::none:
      break;
  }
  return wire::Provider::None;
}

wire::Stage stage(GLenum shader_type) {
  switch (shader_type) {
    case GL_VERTEX_SHADER:
      return wire::Stage::Vertex;
    case GL_TESS_CONTROL_SHADER:
      return wire::Stage::TessControl;
    case GL_TESS_EVALUATION_SHADER:
      return wire::Stage::TessEval;
    case GL_GEOMETRY_SHADER:
      return wire::Stage::Geometry;
    case GL_COMPUTE_SHADER:
      return wire::Stage::Compute;
    default:
      return wire::Stage::Fragment;
  }
}

std::vector<std::unique_ptr<wire::ShaderStageT>> stages(const std::vector<calls::LinkedShader>& shaders) {
  std::vector<std::unique_ptr<wire::ShaderStageT>> result;
  for (const calls::LinkedShader& shader : shaders) {
    auto entry = std::make_unique<wire::ShaderStageT>();
    entry->stage = stage(shader.type);
    entry->shader = shader.shader != 0 && gl().IsShader(shader.shader) ? shader.shader : 0;
    entry->reason = shader.source->reason;
    for (const std::string& string : shader.source->strings) {
      entry->sources.push_back(std::make_unique<wire::TextT>());
      entry->sources.back()->text = string;
    }
    if (shader.source->named_strings != nullptr) {
      for (const calls::NamedString& string : *shader.source->named_strings) {
        entry->named_strings.push_back(std::make_unique<wire::NamedStringT>());
        entry->named_strings.back()->name = string.name;
        entry->named_strings.back()->text = *string.text;
      }
      entry->search_paths = shader.source->search_paths;
    }
    result.push_back(std::move(entry));
  }
  return result;
}

// The shaders that the draw runs: of the current program, or of each pipeline stage's.
std::vector<calls::LinkedShader> shadersOf(const DrawFacts& facts) {
  if (facts.pipeline == 0) return facts.linked->shaders;
  std::vector<calls::LinkedShader> shaders;
  for (const replay::StageProgram& stage : facts.stages) {
    for (const calls::LinkedShader& shader : calls::linkedProgram(stage.program)->shaders) {
      if (shader.type == stage.stage) shaders.push_back(shader);
    }
  }
  return shaders;
}

}  // namespace

DrawFacts drawFacts(const calls::DrawCall& call) {
  DrawFacts facts;
  facts.context = guard::contextFacts();
  const guard::ContextFacts& context = facts.context;
  const guard::SilenceGuard silence(context);  // some questions below are answered by errors
  if (context.atLeast(20, 20)) facts.program = static_cast<GLuint>(integer(GL_CURRENT_PROGRAM));
  if (facts.program == 0 && context.programPipelines()) {
    facts.pipeline = static_cast<GLuint>(integer(GL_PROGRAM_PIPELINE_BINDING));
  }
  if (facts.pipeline != 0) {
    facts.stages = replay::pipelineStages(facts.pipeline);
    std::erase_if(facts.stages, [&](const replay::StageProgram& stage) {
      return (stage.stage == GL_COMPUTE_SHADER) != isDispatch(call);
    });
    for (const replay::StageProgram& stage : facts.stages) {
      if (facts.program == 0 || stage.stage == GL_FRAGMENT_SHADER) facts.program = stage.program;
    }
  }
  facts.linked = calls::linkedProgram(facts.program);
  facts.program_reason = programReason(facts);
  facts.target = capture::drawTarget(context);
  facts.replay_reason = replayReason(call, context);
  if (facts.target.reason.empty()) facts.target.reason = facts.replay_reason;
  if (facts.target.reason.empty() && context.atLeast(30, 30) && gl().IsEnabled(GL_RASTERIZER_DISCARD)) {
    facts.target.reason = "rasterization is switched off (GL_RASTERIZER_DISCARD): no fragment shader runs";
  }
  facts.feedback_components = feedbackComponents(call, context);
  facts.draws_points = call.takes_mode;
  facts.index_type = call.index_type;
  guard::clearErrors();
  return facts;
}

replay::Original originalOf(const DrawFacts& facts, wire::Stage wanted) {
  for (const replay::StageProgram& one : facts.stages) {
    if (one.stage == replay::shaderType(wanted) && one.program != facts.program)
      return {one.program, facts.stages, calls::linkedProgram(one.program), facts.target};
  }
  return {facts.program, facts.stages, facts.linked, facts.target};
}

wire::DrawT describe(const DrawFacts& facts) {
  wire::DrawT draw;
  const guard::ContextFacts& context = facts.context;
  draw.provider = provider();
  draw.version = text(GL_VERSION);
  draw.renderer = text(GL_RENDERER);
  draw.vendor = text(GL_VENDOR);
  draw.glsl_version = context.atLeast(20, 20) ? text(GL_SHADING_LANGUAGE_VERSION) : "";
  draw.es = context.es;
  draw.core = context.core;
  draw.major = context.major;
  draw.minor = context.minor;
  draw.extensions = context.extensions;
  draw.program = facts.program;
  draw.pipeline = facts.pipeline;
  draw.program_reason = facts.program_reason;
  if (facts.program != 0) draw.stages = stages(shadersOf(facts));
  draw.framebuffer = facts.target.framebuffer;
  draw.target_reason = facts.target.reason;
  draw.viewport.resize(4);
  gl().GetIntegerv(GL_VIEWPORT, draw.viewport.data());
  draw.width = facts.target.width;
  draw.height = facts.target.height;
  draw.draw_buffers = facts.target.draw_buffers;
  draw.max_draw_buffers = context.max_draw_buffers;
  draw.storage_blocks.assign(context.storage_blocks.begin(), context.storage_blocks.end());
  draw.max_storage_blocks = context.storage_blocks[static_cast<std::size_t>(wire::Stage::Fragment)];
  draw.replay_reason = facts.replay_reason;
  draw.feedback_components = facts.feedback_components;
  draw.draws_points = facts.draws_points;
  draw.layers = facts.target.layers;
  draw.samples = facts.target.samples;
  if (facts.program != 0) draw.uniforms = replay::activeUniforms(facts.program);
  for (const replay::StageProgram& one : facts.stages) {
    if (one.program == facts.program) continue;
    draw.uniforms_elsewhere.push_back(std::make_unique<wire::StageUniformsT>());
    draw.uniforms_elsewhere.back()->stage = stage(one.stage);
    draw.uniforms_elsewhere.back()->uniforms = replay::activeUniforms(one.program);
  }
  return draw;
}

}  // namespace shadestep::agent
