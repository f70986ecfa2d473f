#include "glsl-frontend/extension_macros.h"

#include <map>
#include <set>

namespace shadestep::frontend {

namespace {

// The oldest versions that know the extension, where that is not any: GLSL, GLSL ES; 1000 = none does.
struct Since {
  int desktop;
  int es;
};

const std::map<std::string_view, Since>& youngExtensions() {
  static const std::map<std::string_view, Since> kExtensions = {
      {"GL_ANDROID_extension_pack_es31a", {1000, 310}},
      {"GL_ARB_gpu_shader_fp64", {150, 1000}},
      {"GL_ARB_gpu_shader_int64", {400, 1000}},
      {"GL_ARB_shader_subroutine", {140, 1000}},
      {"GL_ARB_vertex_attrib_64bit", {150, 1000}},
      {"GL_EXT_clip_cull_distance", {1000, 300}},
      {"GL_EXT_geometry_point_size", {1000, 310}},
      {"GL_EXT_geometry_shader", {1000, 310}},
      {"GL_EXT_gpu_shader5", {1000, 310}},
      {"GL_EXT_primitive_bounding_box", {1000, 310}},
      {"GL_EXT_shader_group_vote", {1000, 300}},
      {"GL_EXT_shader_implicit_conversions", {1000, 310}},
      {"GL_EXT_shader_integer_mix", {0, 300}},
      {"GL_EXT_shader_io_blocks", {1000, 310}},
      {"GL_EXT_tessellation_point_size", {1000, 310}},
      {"GL_EXT_tessellation_shader", {1000, 310}},
      {"GL_EXT_texture_buffer", {1000, 310}},
      {"GL_EXT_texture_cube_map_array", {1000, 310}},
      {"GL_EXT_texture_query_lod", {1000, 300}},
      {"GL_EXT_texture_shadow_lod", {0, 300}},
      {"GL_MESA_shader_integer_functions", {0, 300}},
      {"GL_NV_image_formats", {1000, 310}},
      {"GL_NV_shader_noperspective_interpolation", {1000, 300}},
      {"GL_OES_EGL_image_external_essl3", {1000, 300}},
      {"GL_OES_geometry_point_size", {1000, 310}},
      {"GL_OES_geometry_shader", {1000, 310}},
      {"GL_OES_gpu_shader5", {1000, 310}},
      {"GL_OES_primitive_bounding_box", {1000, 310}},
      {"GL_OES_sample_variables", {1000, 300}},
      {"GL_OES_shader_image_atomic", {1000, 310}},
      {"GL_OES_shader_io_blocks", {1000, 310}},
      {"GL_OES_shader_multisample_interpolation", {1000, 300}},
      {"GL_OES_tessellation_point_size", {1000, 310}},
      {"GL_OES_tessellation_shader", {1000, 310}},
      {"GL_OES_texture_buffer", {1000, 310}},
      {"GL_OES_texture_cube_map_array", {1000, 310}},
      {"GL_OES_texture_storage_multisample_2d_array", {1000, 310}},
      {"GL_OES_viewport_array", {1000, 310}},
  };
  return kExtensions;
}

// Those of all versions whose names do not say that they are about shaders.
const std::set<std::string_view>& languageExtensions() {
  static const std::set<std::string_view> kExtensions = {
      "GL_AMD_conservative_depth",
      "GL_AMD_texture_texture4",
      "GL_ARB_ES3_1_compatibility",
      "GL_ARB_ES3_2_compatibility",
      "GL_ARB_arrays_of_arrays",
      "GL_ARB_compatibility",
      "GL_ARB_conservative_depth",
      "GL_ARB_cull_distance",
      "GL_ARB_derivative_control",
      "GL_ARB_draw_buffers",
      "GL_ARB_draw_instanced",
      "GL_ARB_enhanced_layouts",
      "GL_ARB_explicit_attrib_location",
      "GL_ARB_explicit_uniform_location",
      "GL_ARB_fragment_coord_conventions",
      "GL_ARB_fragment_layer_viewport",
      "GL_ARB_post_depth_coverage",
      "GL_ARB_sample_shading",
      "GL_ARB_shading_language_420pack",
      "GL_ARB_shading_language_include",
      "GL_ARB_shading_language_packing",
      "GL_ARB_texture_cube_map_array",
      "GL_ARB_texture_gather",
      "GL_ARB_texture_multisample",
      "GL_ARB_texture_query_levels",
      "GL_ARB_texture_query_lod",
      "GL_ARB_texture_rectangle",
      "GL_ARB_uniform_buffer_object",
      "GL_ARB_viewport_array",
      "GL_EXT_blend_func_extended",
      "GL_EXT_draw_buffers",
      "GL_EXT_draw_instanced",
      "GL_EXT_frag_depth",
      "GL_EXT_texture_array",
      "GL_KHR_blend_equation_advanced",
      "GL_OES_EGL_image_external",
      "GL_OES_standard_derivatives",
      "GL_OES_texture_3D",
  };
  return kExtensions;
}

// Their names speak of shaders, but mean functions of OpenGL.
const std::set<std::string_view>& apiExtensions() {
  static const std::set<std::string_view> kExtensions = {
      "GL_ARB_shader_objects",       "GL_ARB_vertex_shader",           "GL_ARB_fragment_shader",
      "GL_ATI_fragment_shader",      "GL_ARB_parallel_shader_compile", "GL_KHR_parallel_shader_compile",
      "GL_ARB_shading_language_100", "GL_EXT_vertex_shader",           "GL_NV_texture_shader",
      "GL_NV_texture_shader2",       "GL_NV_texture_shader3",          "GL_OES_shader_binary"};
  return kExtensions;
}

}  // namespace

bool hasMacro(std::string_view extension, int version, bool es) {
  const auto young = youngExtensions().find(extension);
  if (young != youngExtensions().end()) return version >= (es ? young->second.es : young->second.desktop);
  if (languageExtensions().count(extension) > 0) return true;
  return extension.find("shader") != std::string_view::npos && apiExtensions().count(extension) == 0;
}

}  // namespace shadestep::frontend
