// The OpenGL functions that the ray caster calls, loaded from whichever library the context came from.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <functional>

namespace raycaster {

// The prototypes give the members their types only: nothing here links against a GL library.
struct Gl {
  decltype(&::glActiveTexture) ActiveTexture;
  decltype(&::glAttachShader) AttachShader;
  decltype(&::glBindAttribLocation) BindAttribLocation;
  decltype(&::glBindBuffer) BindBuffer;
  decltype(&::glBindFragDataLocation) BindFragDataLocation;
  decltype(&::glBindFramebuffer) BindFramebuffer;
  decltype(&::glBindRenderbuffer) BindRenderbuffer;
  decltype(&::glBindTexture) BindTexture;
  decltype(&::glBindVertexArray) BindVertexArray;
  decltype(&::glBlendEquation) BlendEquation;
  decltype(&::glBlendFunc) BlendFunc;
  decltype(&::glBlendFuncSeparate) BlendFuncSeparate;
  decltype(&::glBlitFramebuffer) BlitFramebuffer;
  decltype(&::glBufferData) BufferData;
  decltype(&::glCheckFramebufferStatus) CheckFramebufferStatus;
  decltype(&::glClear) Clear;
  decltype(&::glClearColor) ClearColor;
  decltype(&::glCompileShader) CompileShader;
  decltype(&::glCreateProgram) CreateProgram;
  decltype(&::glCreateShader) CreateShader;
  decltype(&::glCullFace) CullFace;
  decltype(&::glDeleteBuffers) DeleteBuffers;
  decltype(&::glDeleteFramebuffers) DeleteFramebuffers;
  decltype(&::glDeleteProgram) DeleteProgram;
  decltype(&::glDeleteRenderbuffers) DeleteRenderbuffers;
  decltype(&::glDeleteShader) DeleteShader;
  decltype(&::glDeleteTextures) DeleteTextures;
  decltype(&::glDeleteVertexArrays) DeleteVertexArrays;
  decltype(&::glDepthFunc) DepthFunc;
  decltype(&::glDisable) Disable;
  decltype(&::glDrawBuffers) DrawBuffers;
  decltype(&::glDrawElements) DrawElements;
  decltype(&::glEnable) Enable;
  decltype(&::glEnableClientState) EnableClientState;
  decltype(&::glEnableVertexAttribArray) EnableVertexAttribArray;
  decltype(&::glFinish) Finish;
  decltype(&::glFramebufferRenderbuffer) FramebufferRenderbuffer;
  decltype(&::glFramebufferTexture2D) FramebufferTexture2D;
  decltype(&::glGenBuffers) GenBuffers;
  decltype(&::glGenFramebuffers) GenFramebuffers;
  decltype(&::glGenRenderbuffers) GenRenderbuffers;
  decltype(&::glGenTextures) GenTextures;
  decltype(&::glGenVertexArrays) GenVertexArrays;
  decltype(&::glGetError) GetError;
  decltype(&::glGetProgramInfoLog) GetProgramInfoLog;
  decltype(&::glGetProgramiv) GetProgramiv;
  decltype(&::glGetShaderInfoLog) GetShaderInfoLog;
  decltype(&::glGetShaderiv) GetShaderiv;
  decltype(&::glGetString) GetString;
  decltype(&::glGetUniformLocation) GetUniformLocation;
  decltype(&::glLinkProgram) LinkProgram;
  decltype(&::glLoadIdentity) LoadIdentity;
  decltype(&::glLoadMatrixf) LoadMatrixf;
  decltype(&::glMatrixMode) MatrixMode;
  decltype(&::glPixelStorei) PixelStorei;
  decltype(&::glPointSize) PointSize;
  decltype(&::glReadPixels) ReadPixels;
  decltype(&::glRenderbufferStorage) RenderbufferStorage;
  decltype(&::glShaderSource) ShaderSource;
  decltype(&::glTexImage1D) TexImage1D;
  decltype(&::glTexImage2D) TexImage2D;
  decltype(&::glTexImage3D) TexImage3D;
  decltype(&::glTexParameteri) TexParameteri;
  decltype(&::glUniform1f) Uniform1f;
  decltype(&::glUniform1i) Uniform1i;
  decltype(&::glUniform2f) Uniform2f;
  decltype(&::glUniform3f) Uniform3f;
  decltype(&::glUniform4f) Uniform4f;
  decltype(&::glUniformMatrix4fv) UniformMatrix4fv;
  decltype(&::glUseProgram) UseProgram;
  decltype(&::glVertexAttribPointer) VertexAttribPointer;
  decltype(&::glVertexPointer) VertexPointer;
  decltype(&::glViewport) Viewport;
};

using AnyFunction = void (*)();

// `address` is the GetProcAddress of the current context's library. Throws std::runtime_error naming a
// function that is missing.
Gl loadGl(const std::function<AnyFunction(const char*)>& address);

}  // namespace raycaster
