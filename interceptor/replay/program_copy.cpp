// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/replay/program_copy.h"

#include <time.h>

#include <algorithm>
#include <set>

#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "interceptor/replay/outputs.h"
#include "interceptor/replay/stages.h"
#include "interceptor/replay/writable.h"

namespace shadestep::replay {
namespace {

using dispatch::gl;
using guard::OrRefusal;
using guard::Refusal;

std::uint64_t now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(time.tv_nsec);
}

std::string shaderLog(GLuint shader) {
  GLint length = 0;
  gl().GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  gl().GetShaderInfoLog(shader, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

std::string programLog(GLuint program) {
  GLint length = 0;
  gl().GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  gl().GetProgramInfoLog(program, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

// As OpenGL takes several strings.
struct StringList {
  explicit StringList(const std::vector<std::string>& strings) {
    for (const std::string& text : strings) {
      texts.push_back(text.data());
      lengths.push_back(static_cast<GLint>(text.size()));
    }
  }
  GLsizei count() const { return static_cast<GLsizei>(texts.size()); }
  std::vector<const GLchar*> texts;
  std::vector<GLint> lengths;
};

// 0 and the log if it does not compile.
GLuint compile(GLenum type, const calls::CompiledSource& source, std::string& log) {
  const GLuint shader = gl().CreateShader(type);
  const StringList strings(source.strings);
  gl().ShaderSource(shader, strings.count(), strings.texts.data(), strings.lengths.data());
  if (source.named_strings != nullptr) {
    const calls::NamedStringsScope scope(source.named_strings);
    const StringList paths(source.search_paths);
    gl().CompileShaderIncludeARB(shader, paths.count(), paths.texts.data(), paths.lengths.data());
  } else {
    gl().CompileShader(shader);
  }
  GLint compiled = GL_FALSE;
  gl().GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  log = shaderLog(shader);
  gl().DeleteShader(shader);
  return 0;
}

GLuint compile(GLenum type, const std::string& text, std::string& log) {
  return compile(type, calls::CompiledSource{{text}, "", nullptr, {}}, log);
}

Refusal doesNotCompile(GLenum type, const std::string& log) {
  return {wire::ErrorKind::Compile,
          std::string("the ") + stageWord(type) + " shader does not compile: " + log};
}

// A shader made for one copy: it lives as long as the copy has it attached.
struct OwnShader {
  GLuint name = 0;
  ~OwnShader() {
    if (name != 0) gl().DeleteShader(name);
  }
};

// ---- before the link: what has to stay where it is
// -------------------------------------------------------------

void bindAttributes(const Original& original, GLuint copy) {
  for (const auto& [name, location] : original.linked->attributes)
    gl().BindAttribLocation(copy, location, name.c_str());
  GLint count = 0;
  GLint longest = 0;
  gl().GetProgramiv(original.program, GL_ACTIVE_ATTRIBUTES, &count);
  gl().GetProgramiv(original.program, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH, &longest);
  std::vector<GLchar> name(static_cast<std::size_t>(longest) + 1);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLint size = 0;
    GLenum type = 0;
    gl().GetActiveAttrib(original.program, i, static_cast<GLsizei>(name.size()), nullptr, &size, &type,
                         name.data());
    const GLint location = gl().GetAttribLocation(original.program, name.data());
    if (location >= 0)
      gl().BindAttribLocation(copy, static_cast<GLuint>(location), name.data());  // built-ins: -1
  }
}

// ---- after the link
// ------------------------------------------------------------------------------------------

// Gives the debugger's storage block a binding that no block of the program has.
Refusal placeStorageBlock(const guard::ContextFacts& facts, const Original& original,
                          const std::string& block, ProgramCopy& copy) {
  if (block.empty()) return {};
  if (!facts.storageBuffers()) {
    return guard::unsupported(
        "this driver has no storage buffers (OpenGL 4.3 or GL_ARB_shader_storage_buffer_object)");
  }
  const GLuint index = gl().GetProgramResourceIndex(copy.program, GL_SHADER_STORAGE_BLOCK, block.c_str());
  if (index == GL_INVALID_INDEX) return {};  // the compiler found that nothing is written to it
  constexpr GLenum kBinding = GL_BUFFER_BINDING;
  const auto bindingOf = [&](GLuint resource) {
    GLint binding = 0;
    gl().GetProgramResourceiv(copy.program, GL_SHADER_STORAGE_BLOCK, resource, 1, &kBinding, 1, nullptr,
                              &binding);
    return binding;
  };
  std::set<int> taken;
  GLint blocks = 0;
  gl().GetProgramInterfaceiv(copy.program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &blocks);
  for (GLuint i = 0; i < static_cast<GLuint>(blocks); ++i) {
    if (i != index) taken.insert(bindingOf(i));
  }
  for (const StageProgram& other : original.pipeline) {
    if (other.program == original.program) continue;
    for (const GLuint binding : writableBindings(facts, other.program).storage)
      taken.insert(static_cast<int>(binding));
  }
  if (!dispatch::available("glShaderStorageBlockBinding") || facts.es) {  // the text has chosen it
    copy.storage_binding = bindingOf(index);
    if (taken.count(copy.storage_binding) == 0) return {};
    return guard::limit("the program's storage blocks leave no binding for one more in OpenGL ES");
  }
  int binding = facts.max_storage_bindings - 1;
  while (binding >= 0 && taken.count(binding) != 0) --binding;
  if (binding < 0)
    return guard::limit(
        "the program uses all storage buffer bindings of this driver "
        "(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS)");
  gl().ShaderStorageBlockBinding(copy.program, index, static_cast<GLuint>(binding));
  copy.storage_binding = binding;
  return {};
}

// The one attribute of a covering triangle's vertex shader, wherever the linker put it.
int positionAttribute(GLuint program) {
  GLint count = 0;
  gl().GetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLchar name[256] = {};
    GLint size = 0;
    GLenum type = 0;
    gl().GetActiveAttrib(program, i, sizeof name, nullptr, &size, &type, name);
    if (std::string(name) == "gl_Vertex") return 0;
    const GLint location = gl().GetAttribLocation(program, name);
    if (location >= 0) return location;
  }
  return -1;
}

// Whether the pipeline has the stage from another program.
bool comesFromElsewhere(const Original& original, GLenum type) {
  return std::any_of(original.pipeline.begin(), original.pipeline.end(), [&](const StageProgram& stage) {
    return stage.stage == type && stage.program != original.program;
  });
}

// The stages of the original's pipeline that are replayed.
std::vector<StageProgram> replayedStages(const Original& original, const wire::PrepareT& request) {
  std::vector<StageProgram> stages = original.pipeline;
  if (request.geometry != wire::Geometry::Unrasterized) return stages;
  std::erase_if(stages, [&](const StageProgram& stage) { return !runsUpTo(stage.stage, request.stage); });
  return stages;
}

// Whether the copy is a part of a pipeline: always where fragments are drawn, else where the stages that are
// replayed come from several programs, and cannot be linked into one.
bool isPartOfPipeline(const Original& original, const wire::PrepareT& request) {
  if (original.pipeline.empty() || request.geometry == wire::Geometry::Covering) return false;
  const std::vector<StageProgram> stages = replayedStages(original, request);
  return request.geometry == wire::Geometry::Replay ||
         std::any_of(stages.begin(), stages.end(),
                     [&](const StageProgram& stage) { return stage.program != original.program; });
}

// Only the copy's own last stage can give outputs to transform feedback.
Refusal hasLastStage(const Original& original, const wire::PrepareT& request) {
  if (request.feedback_outputs.empty() && request.feedback_captures.empty()) return {};
  const StageProgram last = replayedStages(original, request).back();
  if (last.program == original.program) return {};
  return {wire::ErrorKind::Link,
          std::string("the ") + stageWord(last.stage) +
              " shader, whose outputs are asked for, is in another program of the pipeline"};
}

// Why the stage beside the requested one cannot be replaced, or nothing.
Refusal hasStageBeside(const Original& original, GLenum type) {
  const auto& shaders = original.linked->shaders;
  const bool linked = std::any_of(shaders.begin(), shaders.end(),
                                  [type](const calls::LinkedShader& shader) { return shader.type == type; });
  if (linked && !comesFromElsewhere(original, type)) return {};
  return guard::unsupported(std::string("the ") + stageWord(type) +
                            " shader is not in the same program as the fragment shader: the stages of a "
                            "pipeline are not replaced together yet");
}

// "#version 320 es", as the shader says it.
std::string versionOf(const std::string& text) {
  const std::size_t at = text.find("#version");
  if (at == std::string::npos) return "#version 100";
  return text.substr(at, text.find('\n', at) - at);
}

// OpenGL ES links no program without a fragment shader, and none of several versions.
Refusal attachEmptyFragmentStage(const std::string& version, GLuint copy) {
  std::string log;
  const OwnShader fragment{compile(GL_FRAGMENT_SHADER, version + "\nvoid main() {}\n", log)};
  if (fragment.name == 0) return doesNotCompile(GL_FRAGMENT_SHADER, log);
  gl().AttachShader(copy, fragment.name);
  return {};
}

// Attaches the stages of the original that are replayed, with the requested one replaced.
Refusal attachReplayStages(const guard::ContextFacts& facts, const Original& original,
                           const wire::PrepareT& request, ShaderCache& cache, GLuint copy) {
  const bool unrasterized = request.geometry == wire::Geometry::Unrasterized;
  const bool part = unrasterized && isPartOfPipeline(original, request);
  if (part) {
    if (Refusal refusal = hasLastStage(original, request); !refusal.text.empty()) return refusal;
  }
  const GLenum replaced = shaderType(request.stage);
  const auto of_stage = [&](const calls::LinkedShader& shader) { return shader.type == replaced; };
  if (std::none_of(original.linked->shaders.begin(), original.linked->shaders.end(), of_stage)) {
    return guard::unsupported(std::string("the program has no ") + stageWord(replaced) + " shader");
  }
  std::string log;
  std::string version = request.text.empty() ? "" : versionOf(request.text);
  const GLenum beside = request.beside ? shaderType(request.beside->stage) : GL_NONE;
  if (beside != GL_NONE) {
    if (Refusal refusal = hasStageBeside(original, beside); !refusal.text.empty()) return refusal;
    const OwnShader other{compile(beside, request.beside->text, log)};
    if (other.name == 0) return doesNotCompile(beside, log);
    gl().AttachShader(copy, other.name);
  }
  if (!request.text.empty()) {
    const OwnShader own{compile(replaced, request.text, log)};
    if (own.name == 0) return doesNotCompile(replaced, log);
    gl().AttachShader(copy, own.name);
  }
  for (const calls::LinkedShader& shader : original.linked->shaders) {
    if (unrasterized && !runsUpTo(shader.type, request.stage)) continue;
    if (part && comesFromElsewhere(original, shader.type)) continue;
    if (of_stage(shader) && !request.text.empty()) continue;  // the one text stands for all of the stage's
    if (shader.type == beside) continue;
    if (!shader.source->reason.empty()) {
      return guard::unsupported(std::string("the ") + stageWord(shader.type) +
                                " shader cannot be rebuilt: " + shader.source->reason);
    }
    if (version.empty() && !shader.source->strings.empty())
      version = versionOf(shader.source->strings.front());
    const GLuint same = cache.shader(shader.type, shader.source, log);
    if (same == 0) return doesNotCompile(shader.type, log);
    gl().AttachShader(copy, same);
  }
  if (unrasterized && !part && facts.es && request.stage != wire::Stage::Compute)
    return attachEmptyFragmentStage(version, copy);
  return {};
}

Refusal attachCoveringStages(const wire::PrepareT& request, GLuint copy) {
  std::string log;
  const OwnShader vertex{compile(GL_VERTEX_SHADER, request.vertex_text, log)};
  if (vertex.name == 0) return doesNotCompile(GL_VERTEX_SHADER, log);
  const OwnShader fragment{compile(GL_FRAGMENT_SHADER, request.text, log)};
  if (fragment.name == 0) return doesNotCompile(GL_FRAGMENT_SHADER, log);
  gl().AttachShader(copy, vertex.name);
  gl().AttachShader(copy, fragment.name);
  return {};
}

void detachAll(GLuint program) {
  GLuint attached[32];
  GLsizei count = 0;
  gl().GetAttachedShaders(program, 32, &count, attached);
  for (GLsizei i = 0; i < count; ++i) gl().DetachShader(program, attached[i]);
}

Refusal link(ProgramCopy& copy) {
  gl().LinkProgram(copy.program);
  GLint linked = GL_FALSE;
  gl().GetProgramiv(copy.program, GL_LINK_STATUS, &linked);
  copy.log = programLog(copy.program);
  detachAll(copy.program);
  if (linked) return {};
  return {wire::ErrorKind::Link, "the instrumented program does not link: " + copy.log};
}

Refusal bindOutputs(const guard::ContextFacts& facts, const Original& original, const wire::PrepareT& request,
                    ProgramCopy& copy) {
  const UserOutputs outputs =
      bindUserOutputs(original.program, copy.program, request.user_outputs, facts.max_draw_buffers);
  copy.output_locations = outputs.locations;
  copy.dual_source = !outputs.second_sources.empty();
  copy.colour_outputs = outputs.locations.empty() ? 1 : *outputs.locations.rbegin() + 1;
  std::set<int> taken = outputs.locations;
  taken.insert(outputs.second_sources.begin(), outputs.second_sources.end());
  auto captures = bindCaptures(facts, original.target, request, copy.program, std::move(taken));
  if (auto* refusal = std::get_if<Refusal>(&captures)) return *refusal;
  copy.captures = std::get<std::vector<capture::CaptureBuffer>>(std::move(captures));
  return {};
}

Refusal build(const guard::ContextFacts& facts, const Original& original, const wire::PrepareT& request,
              ShaderCache& cache, ProgramCopy& copy) {
  copy.program = gl().CreateProgram();
  copy.covering = request.geometry == wire::Geometry::Covering;
  const Refusal attached = copy.covering ? attachCoveringStages(request, copy.program)
                                         : attachReplayStages(facts, original, request, cache, copy.program);
  if (!attached.text.empty()) return attached;

  const bool unrasterized = request.geometry == wire::Geometry::Unrasterized;
  const bool in_pipeline = isPartOfPipeline(original, request);
  if (in_pipeline) gl().ProgramParameteri(copy.program, GL_PROGRAM_SEPARABLE, GL_TRUE);
  if (!copy.covering) bindAttributes(original, copy.program);
  if (unrasterized) {
    setFeedbackVaryings(facts, copy.program, request);
  } else {
    if (!copy.covering) copyFeedbackVaryings(facts, original.program, copy.program);
    if (Refusal failed = bindOutputs(facts, original, request, copy); !failed.text.empty()) return failed;
  }
  if (Refusal failed = link(copy); !failed.text.empty()) return failed;
  if (unrasterized) {
    copy.stages = Stages{request.stage, request.feedback_outputs, feedbackLayout(copy.program, request)};
  } else if (Refusal failed = confirmCaptures(facts, original.target, request, copy.program, copy.captures);
             !failed.text.empty()) {
    return failed;
  }
  if (copy.covering) {
    copy.position_attribute = positionAttribute(copy.program);
  } else {
    // While the original is current: its choice is state of the context.
    copy.subroutines = subroutineChoices(facts, original.program, copy.program);
  }
  if (in_pipeline)
    copy.pipeline = copyPipeline(replayedStages(original, request), original.program, copy.program);
  copyUniforms(facts, original.program, copy.program);
  // After the program's own blocks have got their bindings: it takes one that is left.
  if (Refusal failed = placeStorageBlock(facts, original, request.storage_block, copy);
      !failed.text.empty()) {
    return failed;
  }
  return {};
}

}  // namespace

GLuint ShaderCache::shader(GLenum type, const std::shared_ptr<const calls::CompiledSource>& source,
                           std::string& log) {
  const auto found = shaders_.find(source);
  if (found != shaders_.end()) return found->second;
  const GLuint shader = compile(type, *source, log);
  if (shader != 0) shaders_[source] = shader;
  return shader;
}

ShaderCache::~ShaderCache() {
  for (const auto& [source, shader] : shaders_) gl().DeleteShader(shader);
}

ProgramCopy::~ProgramCopy() {
  if (pipeline != 0) gl().DeleteProgramPipelines(1, &pipeline);
  if (program != 0) gl().DeleteProgram(program);
}

Refusal useCopy(const ProgramCopy& copy, const std::vector<std::unique_ptr<wire::UniformValueT>>& uniforms) {
  gl().UseProgram(copy.program);
  const std::string problem = setUniforms(copy.program, uniforms);
  if (copy.pipeline != 0) {
    gl().UseProgram(0);
    gl().BindProgramPipeline(copy.pipeline);
  }
  selectSubroutines(copy.subroutines);
  return problem.empty() ? Refusal{} : guard::unsupported(problem);
}

OrRefusal<std::unique_ptr<ProgramCopy>> copyProgram(const guard::ContextFacts& facts,
                                                    const Original& original, const wire::PrepareT& request,
                                                    ShaderCache& cache) {
  auto copy = std::make_unique<ProgramCopy>();
  const std::uint64_t start = now();
  Refusal failed = build(facts, original, request, cache, *copy);
  copy->compile_ns = now() - start;
  if (!failed.text.empty()) return failed;
  return copy;
}

}  // namespace shadestep::replay
