#include "gl.h"

#include <stdexcept>
#include <string>

namespace raycaster {

Gl loadGl(const std::function<AnyFunction(const char*)>& address) {
  Gl gl{};
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(address(name));
    if (!function)
      throw std::runtime_error(std::string("this OpenGL has no ") + name + "; OpenGL 3.0 is needed");
  };
  load(gl.ActiveTexture, "glActiveTexture");
  load(gl.AttachShader, "glAttachShader");
  load(gl.BindAttribLocation, "glBindAttribLocation");
  load(gl.BindBuffer, "glBindBuffer");
  load(gl.BindFragDataLocation, "glBindFragDataLocation");
  load(gl.BindFramebuffer, "glBindFramebuffer");
  load(gl.BindRenderbuffer, "glBindRenderbuffer");
  load(gl.BindTexture, "glBindTexture");
  load(gl.BindVertexArray, "glBindVertexArray");
  load(gl.BlendEquation, "glBlendEquation");
  load(gl.BlendFunc, "glBlendFunc");
  load(gl.BlendFuncSeparate, "glBlendFuncSeparate");
  load(gl.BlitFramebuffer, "glBlitFramebuffer");
  load(gl.BufferData, "glBufferData");
  load(gl.CheckFramebufferStatus, "glCheckFramebufferStatus");
  load(gl.Clear, "glClear");
  load(gl.ClearColor, "glClearColor");
  load(gl.CompileShader, "glCompileShader");
  load(gl.CreateProgram, "glCreateProgram");
  load(gl.CreateShader, "glCreateShader");
  load(gl.CullFace, "glCullFace");
  load(gl.DeleteBuffers, "glDeleteBuffers");
  load(gl.DeleteFramebuffers, "glDeleteFramebuffers");
  load(gl.DeleteProgram, "glDeleteProgram");
  load(gl.DeleteRenderbuffers, "glDeleteRenderbuffers");
  load(gl.DeleteShader, "glDeleteShader");
  load(gl.DeleteTextures, "glDeleteTextures");
  load(gl.DeleteVertexArrays, "glDeleteVertexArrays");
  load(gl.DepthFunc, "glDepthFunc");
  load(gl.Disable, "glDisable");
  load(gl.DrawBuffers, "glDrawBuffers");
  load(gl.DrawElements, "glDrawElements");
  load(gl.Enable, "glEnable");
  load(gl.EnableClientState, "glEnableClientState");
  load(gl.EnableVertexAttribArray, "glEnableVertexAttribArray");
  load(gl.Finish, "glFinish");
  load(gl.FramebufferRenderbuffer, "glFramebufferRenderbuffer");
  load(gl.FramebufferTexture2D, "glFramebufferTexture2D");
  load(gl.GenBuffers, "glGenBuffers");
  load(gl.GenFramebuffers, "glGenFramebuffers");
  load(gl.GenRenderbuffers, "glGenRenderbuffers");
  load(gl.GenTextures, "glGenTextures");
  load(gl.GenVertexArrays, "glGenVertexArrays");
  load(gl.GetError, "glGetError");
  load(gl.GetProgramInfoLog, "glGetProgramInfoLog");
  load(gl.GetProgramiv, "glGetProgramiv");
  load(gl.GetShaderInfoLog, "glGetShaderInfoLog");
  load(gl.GetShaderiv, "glGetShaderiv");
  load(gl.GetString, "glGetString");
  load(gl.GetUniformLocation, "glGetUniformLocation");
  load(gl.LinkProgram, "glLinkProgram");
  load(gl.LoadIdentity, "glLoadIdentity");
  load(gl.LoadMatrixf, "glLoadMatrixf");
  load(gl.MatrixMode, "glMatrixMode");
  load(gl.PixelStorei, "glPixelStorei");
  load(gl.PointSize, "glPointSize");
  load(gl.ReadPixels, "glReadPixels");
  load(gl.RenderbufferStorage, "glRenderbufferStorage");
  load(gl.ShaderSource, "glShaderSource");
  load(gl.TexImage1D, "glTexImage1D");
  load(gl.TexImage2D, "glTexImage2D");
  load(gl.TexImage3D, "glTexImage3D");
  load(gl.TexParameteri, "glTexParameteri");
  load(gl.Uniform1f, "glUniform1f");
  load(gl.Uniform1i, "glUniform1i");
  load(gl.Uniform2f, "glUniform2f");
  load(gl.Uniform3f, "glUniform3f");
  load(gl.Uniform4f, "glUniform4f");
  load(gl.UniformMatrix4fv, "glUniformMatrix4fv");
  load(gl.UseProgram, "glUseProgram");
  load(gl.VertexAttribPointer, "glVertexAttribPointer");
  load(gl.VertexPointer, "glVertexPointer");
  load(gl.Viewport, "glViewport");
  return gl;
}

}  // namespace raycaster
