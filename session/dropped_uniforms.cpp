#include "session/dropped_uniforms.h"

#include <algorithm>

#include "glsl-frontend/dependence.h"

namespace shadestep::session {
namespace {

using frontend::Basic;
using frontend::Shader;
using frontend::Storage;
using frontend::Type;
using frontend::Variable;
using frontend::VariableId;
using Active = std::map<std::string, int>;

constexpr std::size_t kMostNames = 8;

// Is `name`, which has no members and no further dimensions, or its element, alive?
bool isActive(const Active& active, const std::string& name, int element) {
  for (const char* suffix : {"[0]", ""}) {
    const auto found = active.find(name + suffix);
    if (found != active.end()) return element < found->second;
  }
  return false;
}

struct Parts {
  int alive = 0, dropped = 0;
};

// Counts the parts of a value by whether the program has them. `name`: as OpenGL names it.
void count(const Active& active, const std::string& name, const Type& type, Parts& parts) {
  if (type.isArray()) {
    const bool leaves = type.array.size() == 1 && type.basic != Basic::struct_;
    for (int i = 0; i < type.array.front(); ++i) {
      if (leaves)
        ++(isActive(active, name, i) ? parts.alive : parts.dropped);
      else
        count(active, name + "[" + std::to_string(i) + "]", type.element(), parts);
    }
  } else if (type.basic == Basic::struct_ && type.members) {
    for (const frontend::Member& member : type.members->members)
      count(active, name + "." + member.name, member.type, parts);
  } else {
    ++(isActive(active, name, 0) ? parts.alive : parts.dropped);
  }
}

// The expression without what selects components: "m[1].xy" -> "m" for a matrix, and the type there.
struct Named {
  std::string path;  // behind the variable's name: "[2].position"
  Type type;
};
Named uniformPart(const Variable& variable, const std::string& expression) {
  Named named{"", variable.type};
  std::size_t at = variable.name.size();
  while (at < expression.size()) {
    const std::size_t end = std::min(expression.find_first_of(".[", at + 1), expression.size());
    const std::string access = expression.substr(at, end - at);
    if (named.type.isArray()) {
      named.type = named.type.element();
    } else if (named.type.basic == Basic::struct_ && named.type.members) {
      const auto& members = named.type.members->members;
      const auto member = std::find_if(members.begin(), members.end(),
                                       [&](const auto& one) { return "." + one.name == access; });
      if (member == members.end()) break;
      named.type = member->type;
    } else {
      break;
    }
    named.path += access;
    at = end;
  }
  return named;
}

// An element of a plain array has no name of its own among the active uniforms.
Parts partsOf(const Active& active, const std::string& name, const Named& named) {
  Parts parts;
  const std::string path = name + named.path;
  const std::size_t bracket = path.rfind('[');
  const bool element = !named.type.isArray() && named.type.basic != Basic::struct_ &&
                       bracket != std::string::npos && path.ends_with("]");
  if (element)
    ++(isActive(active, path.substr(0, bracket), std::stoi(path.substr(bracket + 1))) ? parts.alive
                                                                                      : parts.dropped);
  else
    count(active, path, named.type, parts);
  return parts;
}

// OpenGL names the members of a block with an instance name by the block's name.
Parts partsOf(const Active& active, const Variable& variable, const std::string& expression) {
  const Named named = uniformPart(variable, expression);
  Parts parts = partsOf(active, variable.name, named);
  if (parts.alive > 0 || variable.type.basic != Basic::struct_ || !variable.type.members) return parts;
  Named member = named;  // an array of blocks: its members are named without the block's index
  if (variable.type.isArray()) {
    const std::size_t end = member.path.find(']');
    if (end == std::string::npos)
      member.type = variable.type.element();
    else
      member.path.erase(0, end + 1);
  }
  for (const Named& one : {named, member}) {
    const Parts in_block = partsOf(active, variable.type.members->name, one);
    if (in_block.alive > 0) return in_block;
  }
  return parts;
}

// Subroutine uniforms are no variables of the program's, whatever their declarations look like.
bool isSubroutine(const Shader& shader, const Variable& variable) {
  return std::any_of(shader.functions.begin(), shader.functions.end(), [&](const frontend::Function& one) {
    return !one.candidates.empty() && one.name == variable.name;
  });
}

std::string listed(const Shader& shader, const std::vector<VariableId>& ids) {
  std::vector<std::string> names;
  for (const VariableId id : ids) names.push_back(shader.variables[static_cast<std::size_t>(id)].name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  return names.size() > kMostNames ? text + " and " + std::to_string(names.size() - kMostNames) + " more"
                                   : text;
}

// `expression`: a path of the variable.
std::string noValue(const Shader& shader, const DrawFacts& facts, VariableId id,
                    const std::string& expression) {
  const Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  if (variable.storage != Storage::uniform) return "";
  const Parts parts = partsOf(facts.uniformsOf(shader.stage), variable, expression);
  if (parts.dropped == 0) return "";
  if (parts.alive > 0) return "the driver dropped parts of this uniform, which nothing drawn depends on";
  return "the driver dropped this uniform, because nothing drawn depends on it, and with it what the program "
         "set";
}

}  // namespace

std::string noValue(const Shader& shader, const DrawFacts& facts, const frontend::Watch& watch) {
  if (watch.variable != frontend::kNone) return noValue(shader, facts, watch.variable, watch.expression);
  for (const VariableId id : watch.reads) {
    const Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const std::string reason = noValue(shader, facts, id, variable.name);
    if (!reason.empty()) return "it reads '" + variable.name + "': " + reason;
  }
  return "";
}

void takeOutDropped(Session& session, const std::vector<frontend::Watch>& watches, ThreadValues& values) {
  const Shader& shader = session.shader();
  for (const frontend::Watch& watch : watches) {
    const std::string reason = noValue(shader, session.facts(), watch);
    if (reason.empty()) continue;
    for (WatchedValues& one : values.values) {
      if (one.name != watch.expression) continue;
      one.no_value = reason;
      std::fill(one.words.begin(), one.words.end(), 0);
    }
  }
}

std::string droppedUniforms(const Shader& shader, const DrawFacts& facts) {
  std::vector<VariableId> whole, parts;
  for (std::size_t i = 0; i < shader.variables.size(); ++i) {
    const Variable& variable = shader.variables[i];
    if (variable.storage != Storage::uniform || !variable.read || isSubroutine(shader, variable)) continue;
    const Parts found = partsOf(facts.uniformsOf(shader.stage), variable, variable.name);
    if (found.dropped == 0) continue;
    (found.alive == 0 ? whole : parts).push_back(static_cast<VariableId>(i));
  }
  const auto dependent = [&shader](const std::vector<VariableId>& uniforms) {
    const std::vector<VariableId> ids = frontend::mayDependOn(shader, uniforms);
    return ids.empty() ? "" : ", also in what is computed from them: perhaps in " + listed(shader, ids);
  };
  std::string text;
  if (!whole.empty()) {
    text = "the driver dropped uniforms that nothing drawn depends on, and with them what the program set: " +
           listed(shader, whole) + "; zero stands for them" + dependent(whole);
  }
  if (!parts.empty()) {
    text += (text.empty() ? "" : "; ") +
            ("the driver kept of these uniforms only what is drawn with: " + listed(shader, parts) +
             "; zero stands for the rest" + dependent(parts));
  }
  return text;
}

}  // namespace shadestep::session
