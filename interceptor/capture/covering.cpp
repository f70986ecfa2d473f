// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/capture/covering.h"

#include "interceptor/dispatch/dispatch.h"

namespace shadestep::capture {
namespace {

using dispatch::gl;

constexpr GLfloat kTriangle[3][2] = {{-1, -1}, {3, -1}, {-1, 3}};

}  // namespace

Covering::~Covering() {
  release();
}

void Covering::release() {
  if (framebuffer_ == 0) return;
  gl().DeleteFramebuffers(1, &framebuffer_);
  gl().DeleteRenderbuffers(static_cast<GLsizei>(colors_.size()), colors_.data());
  gl().DeleteVertexArrays(1, &vertex_array_);
  gl().DeleteBuffers(1, &vertices_);
  colors_.clear();
  framebuffer_ = 0;
}

guard::Refusal Covering::bind(int size, int outputs, int position) {
  if (size != size_ || static_cast<std::size_t>(outputs) != colors_.size()) {
    release();
    size_ = size;
    gl().GenFramebuffers(1, &framebuffer_);
    gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    std::vector<GLenum> buffers;
    colors_.resize(static_cast<std::size_t>(outputs));
    gl().GenRenderbuffers(outputs, colors_.data());
    for (const GLuint color : colors_) {
      buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
      gl().BindRenderbuffer(GL_RENDERBUFFER, color);
      gl().RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, size, size);
      gl().FramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, buffers.back(), GL_RENDERBUFFER, color);
    }
    gl().DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
    gl().GenVertexArrays(1, &vertex_array_);
    gl().GenBuffers(1, &vertices_);
    gl().BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl().BufferData(GL_ARRAY_BUFFER, sizeof kTriangle, kTriangle, GL_STATIC_DRAW);
  }
  gl().BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  if (gl().CheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    release();
    return guard::limit("the driver takes no framebuffer of " + std::to_string(size) + " x " +
                        std::to_string(size) + " with " + std::to_string(outputs) + " float colour buffers");
  }
  gl().BindVertexArray(vertex_array_);
  if (position >= 0) {
    const auto location = static_cast<GLuint>(position);
    gl().BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl().VertexAttribPointer(location, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl().EnableVertexAttribArray(location);
  }
  return {};
}

void Covering::draw() const {
  gl().DrawArrays(GL_TRIANGLES, 0, 3);
}

void Covering::readOutput(int index, void* floats) const {
  gl().BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  gl().ReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
  gl().ReadPixels(0, 0, size_, size_, GL_RGBA, GL_FLOAT, floats);
}

}  // namespace shadestep::capture
