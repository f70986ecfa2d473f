// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/calls/tracking.h"

#include <map>
#include <mutex>
#include <unordered_map>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"

namespace shadestep::calls {
namespace {

using dispatch::gl;

struct ShaderText {
  std::vector<std::string> given;  // by the last glShaderSource
  std::shared_ptr<const CompiledSource> compiled;
};
struct ProgramText {
  std::map<std::string, GLuint> attributes;  // by glBindAttribLocation, since the program was made
  std::shared_ptr<const LinkedProgram> linked;
};
// The shaders and programs of contexts that share objects.
struct ShareGroup {
  std::unordered_map<GLuint, ShaderText> shaders;
  std::unordered_map<GLuint, ProgramText> programs;
};

// Shaders are given and linked rarely: one lock for all.
std::mutex mutex;
std::unordered_map<std::uint64_t, ShareGroup>& groups() {
  // Never destroyed: the program may make GL calls from its own exit handlers.
  static auto* all = new std::unordered_map<std::uint64_t, ShareGroup>;
  return *all;
}

// The context of this thread in which glBeginTransformFeedback was called last, and what it was given; OpenGL
// cannot be asked.
struct BegunFeedback {
  const dispatch::Context* context = nullptr;
  GLenum mode = GL_POINTS;
};
thread_local BegunFeedback begun_feedback;

ShareGroup* currentGroup() {
  const dispatch::Context* context = dispatch::currentContext();
  return context != nullptr ? &groups()[context->share_group] : nullptr;
}

std::vector<std::string> strings(GLsizei count, const GLchar* const* text, const GLint* lengths) {
  std::vector<std::string> result;
  for (GLsizei i = 0; i < count; ++i) {
    if (text[i] == nullptr) {
      result.emplace_back();
    } else if (lengths != nullptr && lengths[i] >= 0) {
      result.emplace_back(text[i], static_cast<std::size_t>(lengths[i]));
    } else {
      result.emplace_back(text[i]);
    }
  }
  return result;
}

std::shared_ptr<const CompiledSource> withoutText(std::string reason) {
  return std::make_shared<CompiledSource>(CompiledSource{{}, std::move(reason), nullptr, {}});
}

std::shared_ptr<const CompiledSource> compiled(std::vector<std::string> text,
                                               std::vector<std::string> search_paths) {
  CompiledSource source{std::move(text), "", nullptr, std::move(search_paths)};
  for (const std::string& string : source.strings) {
    if (string.find("include") != std::string::npos) source.named_strings = namedStrings();
  }
  return std::make_shared<CompiledSource>(std::move(source));
}

void noteCompiled(GLuint shader, std::vector<std::string> search_paths) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group == nullptr) return;
  ShaderText& text = group->shaders[shader];
  text.compiled = compiled(text.given, std::move(search_paths));
}

std::string loadedAsBinary(const char* what) {
  return std::string("the ") + what +
         " was loaded as a binary: there is no source; switch the program's shader cache off (Chromium: "
         "--disable-gpu-shader-disk-cache; Qt: QT_DISABLE_SHADER_DISK_CACHE=1 "
         "QSG_RHI_DISABLE_SHADER_DISK_CACHE=1)";
}

void markWithoutText(GLsizei count, const GLuint* shaders, const std::string& reason) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group == nullptr || shaders == nullptr) return;
  for (GLsizei i = 0; i < count; ++i) group->shaders[shaders[i]].compiled = withoutText(reason);
}

void setLinked(GLuint program, LinkedProgram linked) {
  ShareGroup* group = currentGroup();
  if (group == nullptr) return;
  ProgramText& text = group->programs[program];
  linked.attributes.assign(text.attributes.begin(), text.attributes.end());
  text.linked = std::make_shared<LinkedProgram>(std::move(linked));
}

// A shader that is deleted or detached stays known as long as the driver knows it.
void forgetShaderIfGone(GLuint shader) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group != nullptr && group->shaders.count(shader) != 0 && !gl().IsShader(shader))
    group->shaders.erase(shader);
}

// A program in use outlives its deletion; its name is known until the driver forgets it.
void forgetProgramIfGone(GLuint program) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group != nullptr && group->programs.count(program) != 0 && !gl().IsProgram(program)) {
    group->programs.erase(program);
  }
}

}  // namespace

std::shared_ptr<const LinkedProgram> linkedProgram(GLuint program) {
  const std::lock_guard lock(mutex);
  if (const ShareGroup* group = currentGroup(); group != nullptr) {
    const auto found = group->programs.find(program);
    if (found != group->programs.end() && found->second.linked != nullptr) return found->second.linked;
  }
  LinkedProgram unknown;
  unknown.reason = "the program was linked where shadestep did not see it";
  return std::make_shared<LinkedProgram>(std::move(unknown));
}

GLenum feedbackMode() {
  return begun_feedback.context == dispatch::currentContext() ? begun_feedback.mode : GL_POINTS;
}

// ---- hooks
// ---------------------------------------------------------------------------------------------------

void after_glShaderSource(GLuint shader, GLsizei count, const GLchar* const* string, const GLint* length) {
  if (count < 0 || string == nullptr) return;
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  // For a name that is no shader's the driver fails before it looks at the strings, which may be anything.
  if (group != nullptr && gl().IsShader(shader))
    group->shaders[shader].given = strings(count, string, length);
}

void after_glCompileShader(GLuint shader) {
  noteCompiled(shader, {});
}

void after_glCompileShaderIncludeARB(GLuint shader, GLsizei count, const GLchar* const* paths,
                                     const GLint* lengths) {
  if (count < 0 || (count > 0 && paths == nullptr) || !gl().IsShader(shader)) return;
  noteCompiled(shader, strings(count, paths, lengths));
}

void after_glShaderBinary(GLsizei count, const GLuint* shaders, GLenum, const void*, GLsizei) {
  markWithoutText(count, shaders, loadedAsBinary("shader"));
}

void after_glSpecializeShader(GLuint shader, const GLchar*, GLuint, const GLuint*, const GLuint*) {
  markWithoutText(1, &shader, "the shader is SPIR-V: there is no source");
}

void after_glDeleteShader(GLuint shader) {
  forgetShaderIfGone(shader);
}
void after_glDetachShader(GLuint, GLuint shader) {
  forgetShaderIfGone(shader);
}
void after_glDeleteProgram(GLuint program) {
  forgetProgramIfGone(program);
}

void after_glDeleteObjectARB(GLhandleARB object) {
  const auto name = static_cast<GLuint>(object);
  forgetShaderIfGone(name);
  forgetProgramIfGone(name);
}

// A name that comes again is a new object.
void after_glCreateProgram(GLuint result) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group != nullptr) group->programs.erase(result);
}

void after_glBindAttribLocation(GLuint program, GLuint index, const GLchar* name) {
  if (name == nullptr) return;
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group != nullptr) group->programs[program].attributes[name] = index;
}

void after_glLinkProgram(GLuint program) {
  const std::lock_guard lock(mutex);
  ShareGroup* group = currentGroup();
  if (group == nullptr) return;
  LinkedProgram linked;
  GLsizei count = 0;
  GLuint attached[32];
  gl().GetAttachedShaders(program, 32, &count, attached);
  for (GLsizei i = 0; i < count; ++i) {
    GLint type = 0;
    gl().GetShaderiv(attached[i], GL_SHADER_TYPE, &type);
    const auto known = group->shaders.find(attached[i]);
    const bool has_text = known != group->shaders.end() && known->second.compiled != nullptr;
    linked.shaders.push_back(
        {attached[i], static_cast<GLenum>(type),
         has_text ? known->second.compiled
                  : withoutText("the shader's source was given where shadestep did not see it")});
  }
  setLinked(program, std::move(linked));
}

void after_glCreateShaderProgramv(GLuint result, GLenum type, GLsizei count, const GLchar* const* text) {
  if (result == 0 || count < 0 || text == nullptr) return;
  const std::lock_guard lock(mutex);
  LinkedProgram linked;
  linked.shaders.push_back({0, type, compiled(strings(count, text, nullptr), {})});
  setLinked(result, std::move(linked));
}

void after_glBeginTransformFeedback(GLenum mode) {
  begun_feedback = {dispatch::currentContext(), mode};
}

void after_glProgramBinary(GLuint program, GLenum, const void*, GLsizei) {
  const std::lock_guard lock(mutex);
  LinkedProgram linked;
  linked.reason = loadedAsBinary("program");
  setLinked(program, std::move(linked));
}

}  // namespace shadestep::calls
