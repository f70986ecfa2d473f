#include "glsl-frontend/analysed_text.h"

#include <optional>
#include <set>

#include "glsl-frontend/later_names.h"

namespace shadestep::frontend {

namespace {

// Keywords of GLSL 4.60 and ES 3.20 that older shaders use as names.
const std::set<std::string>& youngKeywords() {
  static const std::set<std::string> kWords = {
      "sample",    "patch",       "buffer",    "shared",      "subroutine", "coherent",  "volatile",
      "restrict",  "readonly",    "writeonly", "precise",     "flat",       "smooth",    "noperspective",
      "centroid",  "atomic_uint", "switch",    "case",        "default",    "uint",      "double",
      "layout",    "invariant",   "lowp",      "mediump",     "highp",      "precision", "image1D",
      "image2D",   "image3D",     "imageCube", "imageBuffer", "texture",    "sampler",   "texture2D",
      "uvec2",     "uvec3",       "uvec4",     "dvec2",       "dvec3",      "dvec4",     "common",
      "partition", "active",      "filter",    "resource",    "input",      "output",    "hvec2",
      "hvec3",     "hvec4",       "fvec2",     "fvec3",       "fvec4",      "superp",    "noinline"};
  return kWords;
}

std::map<std::string, std::string> renamings(const std::vector<Token>& tokens, const Skeleton& skeleton) {
  std::set<std::string> used, declared;
  for (const Token& token : tokens) used.insert(token.text);
  declared.insert(skeleton.declared_names.begin(), skeleton.declared_names.end());
  std::map<std::string, std::string> renamed;
  for (const auto& [name, later] : laterNames()) {
    if (used.count(name) > 0 && declared.count(name) == 0) renamed[name] = later;
  }
  const auto rename = [&](const std::string& name, std::string fresh) {
    while (used.count(fresh) > 0) fresh += "0";
    used.insert(fresh);
    renamed[name] = fresh;
  };
  for (const std::string& name : declared) {
    if (youngKeywords().count(name) > 0) rename(name, name + "_");
  }
  for (const auto& [name, type] : foreignVariables()) {
    if (used.count(name) > 0) rename(name, "foreign_" + name.substr(3));
  }
  return renamed;
}

// Locals that take a structure's name, under names of ours: behind a comma glslang reads the type's name
// still, as in `uint a, S = 1u;`.
std::map<VariableId, std::string> typesHidden(const std::vector<Token>& tokens, const Skeleton& skeleton) {
  std::set<std::string> structures, used;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    used.insert(tokens[i].text);
    if (i > 0 && tokens[i - 1].text == "struct") structures.insert(tokens[i].text);
  }
  std::map<VariableId, std::string> fresh;
  for (std::size_t i = 0; i < skeleton.variables.size(); ++i) {
    const Variable& variable = skeleton.variables[i];
    if (variable.storage != Storage::local || structures.count(variable.name) == 0) continue;
    std::string name = "variableOf" + variable.name;
    while (used.count(name) > 0) name += "0";
    fresh.emplace(static_cast<VariableId>(i), name);
  }
  return fresh;
}

class Builder {
 public:
  Builder(const std::vector<Token>& tokens, const Skeleton& skeleton, const Dialect& dialect)
      : tokens_(tokens),
        skeleton_(skeleton),
        dialect_(dialect),
        types_hidden_(typesHidden(tokens, skeleton)) {
    if (!dialect.raised) return;
    renamed_ = renamings(tokens, skeleton);
    declared_.insert(skeleton.declared_names.begin(), skeleton.declared_names.end());
  }

  AnalysedText build() {
    add("#version " + dialect_.version, {});
    if (dialect_.relaxed) add("#extension GL_EXT_shader_image_load_formatted : enable", {});
    result_.es = dialect_.version == "100" || dialect_.version.find("es") != std::string::npos;
    std::size_t insertion = 0;
    bool directives = true;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const auto token = static_cast<TokenIndex>(i);
      if (directives && tokens_[i].kind != TokenKind::directive) {
        directives = false;
        declareForeignVariables();
      }
      for (; insertion < skeleton_.insertions.size() && skeleton_.insertions[insertion].before <= token;
           ++insertion) {
        const Insertion& inserted = skeleton_.insertions[insertion];
        add(inserted.mentions == kNone ? inserted.watched ? named(inserted.text) : inserted.text
                                       : mention(inserted),
            {token, inserted.mentions, inserted.watched});
      }
      addToken(token);
    }
    for (const auto& [users, ours] : renamed_) result_.renamed[ours] = users;
    for (const auto& [id, ours] : types_hidden_) result_.renamed[ours] = nameOf(id);
    return std::move(result_);
  }

 private:
  void add(const std::string& line, LineOrigin origin) {
    result_.text += line;
    result_.text += '\n';
    result_.lines.push_back(origin);
  }

  void addToken(TokenIndex token) {
    if (const std::optional<LaterCall> call = laterCallAt(token)) {
      if (!call->result.empty()) {
        add(call->result + "(", {});
        result_closes_.insert(closingParenthesis(token + 1));
      }
      add(call->name, {token, kNone});
    } else {
      add(lineOf(token), {token, kNone});
    }
    if (result_closes_.erase(token) > 0) add(")", {});
  }

  std::optional<LaterCall> laterCallAt(TokenIndex token) const {
    const auto i = static_cast<std::size_t>(token);
    if (!dialect_.raised || i + 1 >= tokens_.size() || tokens_[i + 1].text != "(") return std::nullopt;
    if (declared_.count(tokens_[i].text) > 0) return std::nullopt;
    return laterCall(tokens_[i].text);
  }

  TokenIndex closingParenthesis(TokenIndex open) const {
    int depth = 0;
    for (auto i = static_cast<std::size_t>(open); i < tokens_.size(); ++i) {
      if (tokens_[i].text == "(") ++depth;
      if (tokens_[i].text == ")" && --depth == 0) return static_cast<TokenIndex>(i);
    }
    return kNone;
  }

  // Those that the shader does not declare itself.
  void declareForeignVariables() {
    for (const auto& [name, type] : foreignVariables()) {
      const auto found = renamed_.find(name);
      if (found == renamed_.end() || declared_.count(name) > 0) continue;
      add((result_.es ? "highp " : "") + type.first + " " + found->second + type.second + ";", {});
    }
  }

  std::string mention(const Insertion& inserted) const {
    const auto hidden = types_hidden_.find(inserted.mentions);
    return (hidden != types_hidden_.end() ? hidden->second : named(nameOf(inserted.mentions))) + ";";
  }

  const std::string& nameOf(VariableId id) const {
    return skeleton_.variables[static_cast<std::size_t>(id)].name;
  }

  std::string lineOf(TokenIndex index) const {
    if (dialect_.relaxed) {
      const auto relaxed = skeleton_.relaxed_as.find(index);
      if (relaxed != skeleton_.relaxed_as.end()) return relaxed->second;
    }
    const auto replaced = skeleton_.analysed_as.find(index);
    if (replaced != skeleton_.analysed_as.end()) return replaced->second;
    const Token& token = tokens_[static_cast<std::size_t>(index)];
    if (token.kind == TokenKind::identifier) {
      const auto hidden = types_hidden_.find(skeleton_.resolved[static_cast<std::size_t>(index)]);
      return hidden != types_hidden_.end() ? hidden->second : named(token.text);
    }
    if (token.kind != TokenKind::directive) return token.text;
    const bool extension = token.text.rfind("#extension", 0) == 0;
    return extension && dialect_.keep_extensions ? token.text : "";
  }

  std::string named(const std::string& name) const {
    const auto found = renamed_.find(name);
    return found == renamed_.end() ? name : found->second;
  }

  const std::vector<Token>& tokens_;
  const Skeleton& skeleton_;
  const Dialect& dialect_;
  std::map<VariableId, std::string> types_hidden_;
  std::map<std::string, std::string> renamed_;
  std::set<std::string> declared_;
  std::set<TokenIndex> result_closes_;  // parentheses after which a constructor closes that we opened
  AnalysedText result_;
};

}  // namespace

std::vector<Dialect> dialects(Stage stage, const Preprocessed& preprocessed, const Skeleton& skeleton) {
  const bool es = preprocessed.version == 100 || preprocessed.profile == "es";
  const std::string own =
      std::to_string(preprocessed.version) + (preprocessed.profile.empty() ? "" : " " + preprocessed.profile);
  const bool can_relax = !skeleton.relaxed_as.empty();
  std::vector<Dialect> result;
  // glslang prints to stdout where a version lacks the stage altogether.
  const bool has_stage = stage != Stage::compute || preprocessed.version >= (es ? 310 : 430);
  if (has_stage) {
    result.push_back({own, true, false, false});
    if (can_relax) result.push_back({own, true, false, true});
  }
  if (es) result.push_back({"320 es", false, true, false});
  if (!es) result.push_back({"460 compatibility", true, true, false});
  result.push_back({"460 compatibility", false, true, false});
  if (can_relax) result.push_back({"460 compatibility", false, true, true});
  return result;
}

AnalysedText buildAnalysedText(const std::vector<Token>& tokens, const Skeleton& skeleton,
                               const Dialect& dialect) {
  return Builder(tokens, skeleton, dialect).build();
}

}  // namespace shadestep::frontend
