#include "instrumenter/storage.h"

#include <string_view>

#include "instrumenter/constructs/keywords.h"

namespace shadestep::instrumenter {

using frontend::Shader;

namespace {

// With the extensions.
constexpr std::string_view kNewKeywords[] = {"buffer",   "coherent",  "restrict",
                                             "readonly", "writeonly", "layout"};

}  // namespace

std::string noStorage(const Shader& shader, const Target& target) {
  if (isEs(shader) && shader.version < 310) return "storage buffers, which GLSL ES has from 3.10 on";
  if (!target.storage_buffers)
    return "storage buffers in this stage (OpenGL 4.3 or GL_ARB_shader_storage_buffer_object), which this "
           "driver "
           "lacks";
  const std::string name = namedLike(shader, kNewKeywords);
  if (!name.empty()) return "storage buffers, with which the shader's name '" + name + "' becomes a keyword";
  return "";
}

// In ES the text alone gives a block its binding, and four are there at least: the last that the text does
// not name.
std::string inStorage(const Draft& draft, std::string declaration) {
  if (!draft.es()) return declaration;
  const std::vector<frontend::Token>& tokens = draft.shader().tokens;
  const auto isTaken = [&](int binding) {
    for (std::size_t i = 2; i < tokens.size(); ++i) {
      if (tokens[i].text == std::to_string(binding) && tokens[i - 1].text == "=" &&
          tokens[i - 2].text == "binding")
        return true;
    }
    return false;
  };
  int binding = 3;
  while (binding > 0 && isTaken(binding)) --binding;
  const std::string_view before = "layout(std430";
  return declaration.insert(declaration.find(before) + before.size(),
                            ", binding = " + std::to_string(binding));
}

void requireStorage(Draft& draft) {
  if (draft.es()) return;
  if (draft.shader().version < 430) draft.require("GL_ARB_shader_storage_buffer_object");
  if (draft.shader().version < 140)
    draft.require("GL_ARB_uniform_buffer_object");  // makes `layout` a keyword
}

}  // namespace shadestep::instrumenter
