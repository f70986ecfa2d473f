// The few GL functions that the probe calls, by the names they have in GL.
#pragma once

#include <GL/gl.h>
#include <GL/glext.h>

#include <string>
#include <vector>

#include "cli/doctor/probe_context.h"

namespace shadestep::doctor {

class Gl {
 public:
  // Functions that the context lacks are null.
  explicit Gl(const ProbeContext&);

  decltype(&glGetString) GetString;
  decltype(&glGetIntegerv) GetIntegerv;
  decltype(&glGetError) GetError;
  decltype(&glFinish) Finish;
  decltype(&glViewport) Viewport;
  decltype(&glDrawArrays) DrawArrays;
  decltype(&glReadPixels) ReadPixels;
  decltype(&glGenTextures) GenTextures;
  decltype(&glBindTexture) BindTexture;
  decltype(&glTexImage2D) TexImage2D;
  decltype(&glTexParameteri) TexParameteri;
  PFNGLGETSTRINGIPROC GetStringi;
  PFNGLCREATESHADERPROC CreateShader;
  PFNGLSHADERSOURCEPROC ShaderSource;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLCREATEPROGRAMPROC CreateProgram;
  PFNGLATTACHSHADERPROC AttachShader;
  PFNGLLINKPROGRAMPROC LinkProgram;
  PFNGLGETPROGRAMIVPROC GetProgramiv;
  PFNGLUSEPROGRAMPROC UseProgram;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation;
  PFNGLUNIFORM1IPROC Uniform1i;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer;
  PFNGLFRAMEBUFFERTEXTURE2DPROC FramebufferTexture2D;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray;
  PFNGLGENQUERIESPROC GenQueries;
  PFNGLBEGINQUERYPROC BeginQuery;
  PFNGLENDQUERYPROC EndQuery;
  PFNGLQUERYCOUNTERPROC QueryCounter;
  PFNGLGETQUERYOBJECTUI64VPROC GetQueryObjectui64v;

  std::string string(GLenum name) const;  // glGetString, "" for null
  std::vector<std::string> extensions() const;
};

}  // namespace shadestep::doctor
