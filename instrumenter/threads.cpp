// Who the threads of a stage are, and what they give to the next one.
#include <algorithm>
#include <string_view>

#include "instrumenter/constructs/keywords.h"
#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Stage;
using frontend::Storage;
using frontend::Type;
using frontend::Variable;

namespace {

// With GL_EXT_gpu_shader4.
constexpr std::string_view kNewKeywords[] = {"flat", "noperspective", "centroid", "unsigned"};

std::vector<Identity> vertexIdentity(const Shader& shader, const Target& target) {
  std::vector<Identity> identity;
  const bool has_vertex =
      shader.version >= 130 || (target.gpu_shader4 && namedLike(shader, kNewKeywords).empty());
  if (!has_vertex || (isEs(shader) && shader.version < 300)) return {};
  identity.push_back({"vertex", "gl_VertexID", shader.version < 130 ? "GL_EXT_gpu_shader4" : ""});
  if (shader.version >= 140) {
    identity.push_back({"instance", "gl_InstanceID", ""});
  } else if (shader.version < 130) {
    identity.push_back({"instance", "gl_InstanceID", "GL_EXT_gpu_shader4"});
  } else if (target.draw_instanced) {
    identity.push_back({"instance", "gl_InstanceIDARB", "GL_ARB_draw_instanced"});
  }
  return identity;
}

// The name of the block that an instance name belongs to, `out Name { ... } instance;`, or "".
std::string blockOf(const Shader& shader, const Variable& variable) {
  const auto text = [&](frontend::TokenIndex i) -> const std::string& {
    return shader.tokens[static_cast<std::size_t>(i)].text;
  };
  if (variable.declared <= 0 || text(variable.declared - 1) != "}") return "";
  int depth = 0;
  for (frontend::TokenIndex i = variable.declared - 1; i > 1; --i) {
    if (text(i) == "}") ++depth;
    if (text(i) == "{" && --depth == 0) {
      const bool is_struct = text(i - 1) == "struct" || text(i - 2) == "struct";
      return is_struct ? "" : text(i - 1);
    }
  }
  return "";
}

// Structs and arrays of them fall into what they are made of.
void addLeaves(const std::string& name, const Type& type, std::vector<FeedbackOutput>& outputs) {
  if (type.basic != frontend::Basic::struct_) {
    outputs.push_back({name, type});  // also what has no known size, to be named
  } else if (type.isArray()) {
    for (int i = 0; i < type.array.front(); ++i)
      addLeaves(name + "[" + std::to_string(i) + "]", type.element(), outputs);
  } else if (type.members) {
    for (const frontend::Member& member : type.members->members)
      addLeaves(name + "." + member.name, member.type, outputs);
  }
}

bool enables(const Shader& shader, const std::string& extension) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(), [&](const frontend::Token& token) {
    return token.kind == frontend::TokenKind::directive && token.text.find(extension) != std::string::npos &&
           token.text.find("disable") == std::string::npos;
  });
}

}  // namespace

std::vector<Identity> identityOf(const Shader& shader, const Target& target) {
  switch (shader.stage) {
    case Stage::vertex:
      return vertexIdentity(shader, target);
    case Stage::tess_control:
      return {{"primitive", "gl_PrimitiveID", ""}, {"vertex", "gl_InvocationID", ""}};
    case Stage::tess_eval:
      return {{"primitive", "gl_PrimitiveID", ""},
              {"u", "gl_TessCoord.x", "", frontend::Basic::float_},
              {"v", "gl_TessCoord.y", "", frontend::Basic::float_}};
    case Stage::geometry:
      if (!isEs(shader) && shader.version < 400 && !enables(shader, "GL_ARB_gpu_shader5"))
        return {{"primitive", "gl_PrimitiveIDIn", ""}};
      return {{"primitive", "gl_PrimitiveIDIn", ""}, {"invocation", "gl_InvocationID", ""}};
    case Stage::compute:
      return {{"x", "int(gl_GlobalInvocationID.x)", ""},
              {"y", "int(gl_GlobalInvocationID.y)", ""},
              {"z", "int(gl_GlobalInvocationID.z)", ""}};
    case Stage::fragment:
      break;
  }
  return {};
}

std::vector<frontend::VariableId> stageOutputs(const Shader& shader) {
  std::vector<frontend::VariableId> outputs;
  for (std::size_t i = 0; i < shader.variables.size(); ++i) {
    const Variable& variable = shader.variables[i];
    const bool is_output = variable.storage == Storage::out ||
                           (variable.storage == Storage::builtin && variable.name.starts_with("gl_"));
    if (is_output && variable.written) outputs.push_back(static_cast<frontend::VariableId>(i));
  }
  return outputs;
}

std::vector<FeedbackOutput> feedbackOutputs(const Shader& shader) {
  std::vector<FeedbackOutput> outputs;
  for (const frontend::VariableId id : stageOutputs(shader)) {
    const Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const std::string block = variable.storage == Storage::out ? blockOf(shader, variable) : "";
    addLeaves(block.empty() ? variable.name : block, variable.type, outputs);
  }
  return outputs;
}

}  // namespace shadestep::instrumenter
