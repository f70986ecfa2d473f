// driver_limits storage|outputs: a fragment shader that uses up what the driver has of storage blocks, or of
// draw buffers.
#include <cstring>
#include <string>

#include "osmesa_program.h"

namespace {

// Block i holds i.
std::string readingAllBlocks() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &most);
  std::string text = "#version 430 core\n";
  for (GLint i = 0; i < most; ++i) {
    const std::string number = std::to_string(i);
    text += "layout(std430, binding = " + number + ") buffer Block" + number + " { float value" + number +
            "; };\n";
    const float content = static_cast<float>(i);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(i), buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, sizeof content, &content, GL_STATIC_DRAW);
  }
  text += "out vec4 colour;\nvoid main()\n{\n    float sum = 0.0;\n";
  for (GLint i = 0; i < most; ++i) text += "    sum += value" + std::to_string(i) + ";\n";
  return text + "    colour = vec4(sum / 1024.0, 0.0, 0.0, 1.0);\n}\n";
}

std::string writingAllOutputs() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_DRAW_BUFFERS, &most);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::vector<GLenum> buffers;
  std::string text = "#version 430 core\n";
  std::string main = "void main()\n{\n    float sum = gl_FragCoord.x;\n";
  for (GLint i = 0; i < most; ++i) {
    const std::string number = std::to_string(i);
    text += "layout(location = " + number + ") out vec4 colour" + number + ";\n";
    main += "    colour" + number + " = vec4(sum + " + number + ".0);\n";
    GLuint target = 0;
    glGenRenderbuffers(1, &target);
    glBindRenderbuffer(GL_RENDERBUFFER, target);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, kSize, kSize);
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, buffers.back(), GL_RENDERBUFFER, target);
  }
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  return text + main + "}\n";
}

}  // namespace

int main(int argc, char** argv) {
  const OsmesaContext context(OsmesaContext::Profile::core);
  const bool outputs = argc > 1 && std::strcmp(argv[1], "outputs") == 0;
  glUseProgram(linkProgram(kCornerVertex, (outputs ? writingAllOutputs() : readingAllBlocks()).c_str()));
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  if (glGetError() != GL_NO_ERROR) fail("the draw is an error");
}
