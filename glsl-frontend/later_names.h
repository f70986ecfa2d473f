// Names of older versions and of extensions, in the words of GLSL 4.60. Internal to the front-end.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace shadestep::frontend {

// Names that only got another spelling.
const std::map<std::string, std::string>& laterNames();

// A built-in function of EXT_gpu_shader4 or EXT_texture_array and the one that has taken its place.
struct LaterCall {
  std::string name;
  std::string result;  // the type that the old one returns, if the new one's has to be converted
};
std::optional<LaterCall> laterCall(const std::string& name);

// Variables of extensions that glslang lacks: name -> type and array dimensions.
const std::map<std::string, std::pair<std::string, std::string>>& foreignVariables();

}  // namespace shadestep::frontend
