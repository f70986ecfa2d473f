// What the current context is and offers, asked from the driver once per stop.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace shadestep::guard {

struct ContextFacts {
  bool es = false;
  bool core = false;  // a core profile: no fixed function, no attribute stacks
  int major = 0, minor = 0;
  std::vector<std::string> extensions;
  int max_draw_buffers = 1;             // what a framebuffer object can hold and a fragment shader can write
  std::array<int, 6> storage_blocks{};  // of each wire::Stage; 0 = none or not bindable by name
  int max_storage_bindings = 0;

  // At least this version, as 10 * major + minor, for OpenGL and OpenGL ES; 0 = in no version of it.
  bool atLeast(int desktop, int embedded) const {
    const int version = es ? embedded : desktop;
    return version != 0 && 10 * major + minor >= version;
  }
  bool has(std::string_view extension) const;

  bool compatibility() const { return !es && !core; }
  bool framebufferObjects() const { return atLeast(30, 30) || has("GL_ARB_framebuffer_object"); }
  bool indexedDrawBuffers() const { return atLeast(30, 32); }
  bool viewportArrays() const { return atLeast(41, 0) || has("GL_ARB_viewport_array"); }
  bool storageBuffers() const {
    return atLeast(43, 31) ||
           (has("GL_ARB_shader_storage_buffer_object") && has("GL_ARB_program_interface_query"));
  }
  bool interfaceQueries() const { return atLeast(43, 31) || has("GL_ARB_program_interface_query"); }
  bool copiesImages() const { return atLeast(43, 32) || has("GL_ARB_copy_image"); }
  bool pausesTransformFeedback() const { return atLeast(40, 30) || has("GL_ARB_transform_feedback2"); }
  bool transformFeedback() const { return atLeast(30, 32); }
  bool subroutines() const { return atLeast(40, 0) || has("GL_ARB_shader_subroutine"); }
  bool vertexArrays() const { return atLeast(30, 30) || has("GL_ARB_vertex_array_object"); }
  bool pixelBuffers() const { return atLeast(21, 30) || has("GL_ARB_pixel_buffer_object"); }
  bool srgbSwitch() const { return atLeast(30, 0) || has("GL_ARB_framebuffer_sRGB"); }
  bool debugOutput() const { return atLeast(43, 32) || has("GL_KHR_debug"); }
  bool programPipelines() const { return atLeast(41, 31) || has("GL_ARB_separate_shader_objects"); }
  bool layeredFramebuffers() const { return atLeast(32, 32); }
  bool framebufferDefaults() const { return atLeast(43, 31) || has("GL_ARB_framebuffer_no_attachments"); }
  bool multisampleTextures() const { return atLeast(32, 31) || has("GL_ARB_texture_multisample"); }
  bool textureStorage() const { return atLeast(42, 30) || has("GL_ARB_texture_storage"); }
  bool multisampleStorage() const { return atLeast(43, 31) || has("GL_ARB_texture_storage_multisample"); }
  bool textureViews() const { return atLeast(43, 0) || has("GL_ARB_texture_view"); }
  bool stencilTextures() const { return atLeast(43, 31) || has("GL_ARB_stencil_texturing"); }
  // Mesa stores window-system framebuffers from the top, and framebuffer objects too where asked to.
  bool storesUpsideDown() const { return has("GL_MESA_framebuffer_flip_y"); }
  bool clipControl() const { return atLeast(45, 0) || has("GL_ARB_clip_control"); }
  bool uniformBlocks() const { return atLeast(31, 30) || has("GL_ARB_uniform_buffer_object"); }
};

ContextFacts contextFacts();

}  // namespace shadestep::guard
