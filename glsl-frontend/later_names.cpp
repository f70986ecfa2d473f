#include "glsl-frontend/later_names.h"

#include <regex>

namespace shadestep::frontend {

const std::map<std::string, std::string>& laterNames() {
  static const std::map<std::string, std::string> kNames = {
      {"atomicCounterAddARB", "atomicCounterAdd"},
      {"atomicCounterSubtractARB", "atomicCounterSubtract"},
      {"atomicCounterMinARB", "atomicCounterMin"},
      {"atomicCounterMaxARB", "atomicCounterMax"},
      {"atomicCounterAndARB", "atomicCounterAnd"},
      {"atomicCounterOrARB", "atomicCounterOr"},
      {"atomicCounterXorARB", "atomicCounterXor"},
      {"atomicCounterExchangeARB", "atomicCounterExchange"},
      {"atomicCounterCompSwapARB", "atomicCounterCompSwap"},
      {"anyInvocationARB", "anyInvocation"},
      {"allInvocationsARB", "allInvocations"},
      {"allInvocationsEqualARB", "allInvocationsEqual"},
      {"texture4", "textureGather"},  // AMD_texture_texture4
      {"gl_InstanceIDARB", "gl_InstanceID"},
      {"gl_BaseVertexARB", "gl_BaseVertex"},
      {"gl_BaseInstanceARB", "gl_BaseInstance"},
      {"gl_DrawIDARB", "gl_DrawID"}};
  return kNames;
}

std::optional<LaterCall> laterCall(const std::string& name) {
  if (name == "truncate") return LaterCall{"trunc", ""};
  static const std::regex kFunction(
      "(texture|shadow|texelFetch|textureSize)"
      "(1D|2D|3D|Cube|2DRect|1DArray|2DArray|CubeMapArray|Buffer)"
      "(Proj|)(Lod|Grad|)(ARB|)(Offset|)");
  std::smatch parts;
  if (!std::regex_match(name, parts, kFunction)) return std::nullopt;
  const bool shadow = parts[1] == "shadow";  // shadow lookups returned the result as a colour
  return LaterCall{(shadow ? "texture" : parts[1].str()) + parts[3].str() + parts[4].str() + parts[6].str(),
                   shadow ? "vec4" : ""};
}

const std::map<std::string, std::pair<std::string, std::string>>& foreignVariables() {
  static const std::map<std::string, std::pair<std::string, std::string>> kVariables = {
      {"gl_LastFragData", {"vec4", "[gl_MaxDrawBuffers]"}},  // EXT_shader_framebuffer_fetch
      {"gl_LastFragColorARM", {"vec4", ""}}};
  return kVariables;
}

}  // namespace shadestep::frontend
