#include "glsl-frontend/analysed_text.h"

#include <algorithm>
#include <set>

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

// Names of extensions whose functions are in GLSL 4.60 under another name.
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
      {"gl_InstanceIDARB", "gl_InstanceID"},
      {"gl_BaseVertexARB", "gl_BaseVertex"},
      {"gl_BaseInstanceARB", "gl_BaseInstance"},
      {"gl_DrawIDARB", "gl_DrawID"}};
  return kNames;
}

std::map<std::string, std::string> renamings(const std::vector<Token>& tokens, const Skeleton& skeleton) {
  std::set<std::string> used;
  for (const Token& token : tokens) used.insert(token.text);
  std::map<std::string, std::string> renamed = laterNames();
  for (const std::string& name : skeleton.declared_names) {
    if (youngKeywords().count(name) == 0 || renamed.count(name) > 0) continue;
    std::string fresh = name + "_";
    while (used.count(fresh) > 0) fresh += "0";
    used.insert(fresh);
    renamed[name] = fresh;
  }
  return renamed;
}

class Builder {
 public:
  Builder(const std::vector<Token>& tokens, const Skeleton& skeleton, const Dialect& dialect)
      : tokens_(tokens), skeleton_(skeleton), dialect_(dialect) {
    if (dialect.rename_keywords) renamed_ = renamings(tokens, skeleton);
  }

  AnalysedText build() {
    add("#version " + dialect_.version, {});
    std::size_t insertion = 0;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const auto token = static_cast<TokenIndex>(i);
      for (; insertion < skeleton_.insertions.size() && skeleton_.insertions[insertion].before <= token;
           ++insertion) {
        const Insertion& inserted = skeleton_.insertions[insertion];
        add(inserted.mentions == kNone ? inserted.text : mention(inserted), {token, inserted.mentions});
      }
      add(lineOf(tokens_[i]), {token, kNone});
    }
    result_.es = dialect_.version == "100" || dialect_.version.find("es") != std::string::npos;
    for (const auto& [users, ours] : renamed_) result_.renamed[ours] = users;
    return std::move(result_);
  }

 private:
  void add(const std::string& line, LineOrigin origin) {
    result_.text += line;
    result_.text += '\n';
    result_.lines.push_back(origin);
  }

  std::string mention(const Insertion& inserted) const {
    return named(skeleton_.variables[static_cast<std::size_t>(inserted.mentions)].name) + ";";
  }

  std::string lineOf(const Token& token) const {
    if (token.kind == TokenKind::identifier) return named(token.text);
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
  std::map<std::string, std::string> renamed_;
  AnalysedText result_;
};

}  // namespace

std::vector<Dialect> dialects(Stage stage, const Preprocessed& preprocessed, bool es) {
  const std::string number = std::to_string(preprocessed.version);
  std::vector<Dialect> result;
  // glslang prints to stdout where a version lacks the stage altogether.
  const bool has_stage = stage != Stage::compute || preprocessed.version >= (es ? 310 : 430);
  if (has_stage) {
    result.push_back(
        {number + (preprocessed.profile.empty() ? "" : " " + preprocessed.profile), true, false});
  }
  if (es) {
    result.push_back({"320 es", false, true});
  } else {
    result.push_back({"460 compatibility", true, true});
    result.push_back({"460 compatibility", false, true});
  }
  return result;
}

AnalysedText buildAnalysedText(const std::vector<Token>& tokens, const Skeleton& skeleton,
                               const Dialect& dialect) {
  return Builder(tokens, skeleton, dialect).build();
}

}  // namespace shadestep::frontend
