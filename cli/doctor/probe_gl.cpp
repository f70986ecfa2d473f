#include "cli/doctor/probe_gl.h"

#include <sstream>

namespace shadestep::doctor {

Gl::Gl(const ProbeContext& context) {
  const auto find = [&context](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(context.function(name));
  };
  find(GetString, "glGetString");
  find(GetIntegerv, "glGetIntegerv");
  find(GetError, "glGetError");
  find(Finish, "glFinish");
  find(Viewport, "glViewport");
  find(DrawArrays, "glDrawArrays");
  find(ReadPixels, "glReadPixels");
  find(GenTextures, "glGenTextures");
  find(BindTexture, "glBindTexture");
  find(TexImage2D, "glTexImage2D");
  find(TexParameteri, "glTexParameteri");
  find(GetStringi, "glGetStringi");
  find(CreateShader, "glCreateShader");
  find(ShaderSource, "glShaderSource");
  find(CompileShader, "glCompileShader");
  find(CreateProgram, "glCreateProgram");
  find(AttachShader, "glAttachShader");
  find(LinkProgram, "glLinkProgram");
  find(GetProgramiv, "glGetProgramiv");
  find(UseProgram, "glUseProgram");
  find(GetUniformLocation, "glGetUniformLocation");
  find(Uniform1i, "glUniform1i");
  find(GenFramebuffers, "glGenFramebuffers");
  find(BindFramebuffer, "glBindFramebuffer");
  find(FramebufferTexture2D, "glFramebufferTexture2D");
  find(CheckFramebufferStatus, "glCheckFramebufferStatus");
  find(GenVertexArrays, "glGenVertexArrays");
  find(BindVertexArray, "glBindVertexArray");
  find(GenQueries, "glGenQueries");
  find(BeginQuery, "glBeginQuery");
  find(EndQuery, "glEndQuery");
  find(QueryCounter, "glQueryCounter");
  find(GetQueryObjectui64v, "glGetQueryObjectui64v");
}

std::string Gl::string(GLenum name) const {
  const GLubyte* text = GetString(name);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

std::vector<std::string> Gl::extensions() const {
  std::vector<std::string> result;
  GLint count = 0;
  GetIntegerv(GL_NUM_EXTENSIONS, &count);
  if (GetError() == GL_NO_ERROR && GetStringi != nullptr && count > 0) {
    for (GLint i = 0; i < count; ++i)
      result.emplace_back(reinterpret_cast<const char*>(GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))));
    return result;
  }
  std::istringstream names(string(GL_EXTENSIONS));  // before GL 3.0
  for (std::string name; names >> name;) result.push_back(name);
  return result;
}

}  // namespace shadestep::doctor
