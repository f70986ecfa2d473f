#include "glsl-frontend/link_objects.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace shadestep::frontend {

namespace {

struct Refused {
  std::string reason;
};

using Tokens = std::vector<TokenIndex>;  // of one object

// `uniform float a[2], b;`: the tokens before the first name, and each name with its dimensions and
// initializer.
struct NameList {
  Tokens head;
  std::vector<Tokens> names;
};

// One thing that stands at file scope.
struct External {
  enum class Kind { directive, function, prototype, braces, names } kind = Kind::names;
  Tokens tokens;
};

bool isDirective(const Token& token, std::string_view name) {
  return token.kind == TokenKind::directive && token.text.rfind(name, 0) == 0;
}

class Object {
 public:
  explicit Object(const Preprocessed& preprocessed) : tokens_(preprocessed.tokens) { cut(); }

  const std::vector<External>& externals() const { return externals_; }
  const Token& token(TokenIndex i) const { return tokens_[static_cast<std::size_t>(i)]; }
  const std::string& text(TokenIndex i) const { return token(i).text; }

  std::string textOf(const Tokens& tokens) const {
    std::string result;
    for (TokenIndex i : tokens) result += (result.empty() ? "" : " ") + text(i);
    return result;
  }

  bool hasMain() const {
    return std::any_of(externals_.begin(), externals_.end(), [&](const External& external) {
      const Tokens& tokens = external.tokens;
      return external.kind == External::Kind::function && tokens.size() > 2 && text(tokens[1]) == "main" &&
             text(tokens[2]) == "(";
    });
  }

  NameList nameList(const External& external) const {
    NameList list;
    const Tokens& tokens = external.tokens;
    std::size_t name = 0;  // the last word before the first of , ; = outside of brackets
    int depth = 0;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const std::string& t = text(tokens[i]);
      if (isOpening(t)) ++depth;
      if (isClosing(t)) --depth;
      if (depth == 0 && (t == "," || t == ";" || t == "=")) break;
      if (depth == 0 && token(tokens[i]).kind == TokenKind::identifier) name = i;
    }
    list.head.assign(tokens.begin(), tokens.begin() + static_cast<std::ptrdiff_t>(name));
    list.names.emplace_back();
    for (std::size_t i = name; i + 1 < tokens.size(); ++i) {
      const std::string& t = text(tokens[i]);
      if (isOpening(t)) ++depth;
      if (isClosing(t)) --depth;
      if (depth == 0 && t == ",") {
        list.names.emplace_back();
      } else {
        list.names.back().push_back(tokens[i]);
      }
    }
    return list;
  }

 private:
  static bool isOpening(const std::string& t) { return t == "(" || t == "[" || t == "{"; }
  static bool isClosing(const std::string& t) { return t == ")" || t == "]" || t == "}"; }

  void cut() {
    External current;
    int depth = 0;
    bool body = false;  // the brace that is open, or was open last, is a function's
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const auto index = static_cast<TokenIndex>(i);
      const std::string& t = tokens_[i].text;
      if (tokens_[i].kind == TokenKind::directive && current.tokens.empty()) {
        externals_.push_back({External::Kind::directive, {index}});
        continue;
      }
      if (t == "{" && depth == 0) body = !current.tokens.empty() && text(current.tokens.back()) == ")";
      current.tokens.push_back(index);
      if (isOpening(t)) ++depth;
      if (isClosing(t)) --depth;
      const bool body_ends = depth == 0 && t == "}" && body;
      if (body_ends || (depth == 0 && t == ";")) {
        current.kind = body_ends ? External::Kind::function : kindOf(current.tokens);
        externals_.push_back(std::move(current));
        current = {};
      }
    }
    if (!current.tokens.empty()) externals_.push_back(std::move(current));
  }

  External::Kind kindOf(const Tokens& tokens) const {
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const std::string& t = text(tokens[i]);
      if (t == "{") return External::Kind::braces;
      if (t == "=" || t == "[") break;
      const bool call = t == "(" && i > 1 && token(tokens[i - 1]).kind == TokenKind::identifier;
      if (call && text(tokens[i - 1]) != "layout" && text(tokens[i - 1]) != "subroutine")
        return External::Kind::prototype;
    }
    const bool braces =
        std::any_of(tokens.begin(), tokens.end(), [&](TokenIndex i) { return text(i) == "{"; });
    return braces ? External::Kind::braces : External::Kind::names;
  }

  const std::vector<Token>& tokens_;
  std::vector<External> externals_;
};

class Linker {
 public:
  explicit Linker(const std::vector<Preprocessed>& objects) : preprocessed_(objects) {
    for (const Preprocessed& object : objects) objects_.emplace_back(object);
  }

  LinkedObjects run() {
    requireSamePragmas();
    header();
    for (int object : order()) {
      for (const External& external : objects_[static_cast<std::size_t>(object)].externals()) {
        add(object, external);
      }
      seen_texts_.insert(new_texts_.begin(), new_texts_.end());
      seen_names_.insert(new_names_.begin(), new_names_.end());
      new_texts_.clear();
      new_names_.clear();
    }
    return std::move(result_);
  }

 private:
  std::vector<int> order() const {
    std::vector<int> all;
    for (std::size_t i = 0; i < objects_.size(); ++i) all.push_back(static_cast<int>(i));
    std::stable_partition(all.begin(), all.end(),
                          [&](int i) { return objects_[static_cast<std::size_t>(i)].hasMain(); });
    return all;
  }

  static std::string place(int object) { return "shader object " + std::to_string(object + 1); }

  // `#pragma STDGL invariant(all)` counts for its own object only.
  void requireSamePragmas() const {
    std::vector<bool> invariant;
    for (const Preprocessed& object : preprocessed_) {
      invariant.push_back(std::any_of(object.tokens.begin(), object.tokens.end(), [](const Token& token) {
        return isDirective(token, "#pragma STDGL invariant");
      }));
    }
    if (std::adjacent_find(invariant.begin(), invariant.end(), std::not_equal_to<>()) != invariant.end()) {
      throw Refused{"'#pragma STDGL invariant(all)' stands in some of the stage's shader objects only"};
    }
  }

  // #version and every #extension.
  void header() {
    Preprocessed& text = result_.text;
    bool same = true;
    int versioned = 0;  // the object whose #version is kept
    for (std::size_t i = 0; i < preprocessed_.size(); ++i) {
      const Preprocessed& object = preprocessed_[i];
      same = same && object.version == preprocessed_[0].version && object.profile == preprocessed_[0].profile;
      if (object.version > preprocessed_[static_cast<std::size_t>(versioned)].version)
        versioned = static_cast<int>(i);
    }
    text.version = preprocessed_[static_cast<std::size_t>(versioned)].version;
    text.profile = preprocessed_[static_cast<std::size_t>(versioned)].profile;
    // What an older object may use, only the compatibility profile of a newer version has.
    if (!same && text.version >= 150) text.profile = "compatibility";

    std::set<std::string> enabled, disabled;
    for (std::size_t i = 0; i < preprocessed_.size(); ++i) {
      for (std::size_t t = 0; t < preprocessed_[i].tokens.size(); ++t) {
        const Token& token = preprocessed_[i].tokens[t];
        if (isDirective(token, "#version") && static_cast<int>(i) == versioned && result_.origins.empty()) {
          push(static_cast<int>(i), static_cast<TokenIndex>(t));
          text.tokens.back().text =
              "#version " + std::to_string(text.version) + (text.profile.empty() ? "" : " " + text.profile);
        }
      }
      for (const auto& [name, behaviour] : preprocessed_[i].extensions) {
        (behaviour == "disable" ? disabled : enabled).insert(name);
      }
    }
    for (const std::string& name : disabled) {
      if (enabled.count(name) == 0) continue;
      throw Refused{"the stage's shader objects enable and disable '" + name + "'"};
    }
    extensions();
  }

  void extensions() {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < preprocessed_.size(); ++i) {
      for (std::size_t t = 0; t < preprocessed_[i].tokens.size(); ++t) {
        const Token& token = preprocessed_[i].tokens[t];
        if (!isDirective(token, "#extension") || !seen.insert(token.text).second) continue;
        push(static_cast<int>(i), static_cast<TokenIndex>(t));
      }
      const auto& own = preprocessed_[i].extensions;
      result_.text.extensions.insert(result_.text.extensions.end(), own.begin(), own.end());
    }
  }

  void add(int object, const External& external) {
    const Object& source = objects_[static_cast<std::size_t>(object)];
    switch (external.kind) {
      case External::Kind::directive: {
        const Token& token = source.token(external.tokens.front());
        if (!isDirective(token, "#version") && !isDirective(token, "#extension"))
          push(object, external.tokens);
        break;
      }
      case External::Kind::function:
        push(object, external.tokens);
        break;
      case External::Kind::prototype:
        if (isNewText(source.textOf(external.tokens))) push(object, external.tokens);
        break;
      case External::Kind::braces:
        if (!isNewText(source.textOf(external.tokens))) break;
        requireNew(object, nameBeforeBrace(source, external.tokens), source.textOf(external.tokens));
        push(object, external.tokens);
        break;
      case External::Kind::names:
        addNames(object, external);
        break;
    }
  }

  // The first time that an object other than those before says this.
  bool isNewText(const std::string& text) {
    new_texts_.insert(text);
    return seen_texts_.count(text) == 0;
  }

  void requireNew(int object, const std::string& name, const std::string& text) {
    const auto before = seen_names_.find(name);
    if (before != seen_names_.end()) throw Refused{differently(object, name, text, before->second)};
    new_names_.insert({name, {object, text, ""}});
  }

  static std::string nameBeforeBrace(const Object& source, const Tokens& tokens) {
    const auto brace =
        std::find_if(tokens.begin(), tokens.end(), [&](TokenIndex i) { return source.text(i) == "{"; });
    return brace == tokens.begin() ? "" : source.text(*(brace - 1));
  }

  struct Declared {
    int object;
    std::string head;
    std::string name;  // with dimensions and initializer
  };

  static std::string differently(int object, const std::string& name, const std::string& text,
                                 const Declared& before) {
    return place(object) + " declares '" + name + "' as '" + text + "', " + place(before.object) + " as '" +
           before.head + (before.name.empty() ? "" : " " + before.name) + "'";
  }

  void addNames(int object, const External& external) {
    const Object& source = objects_[static_cast<std::size_t>(object)];
    const NameList list = source.nameList(external);
    const std::string head = source.textOf(list.head);
    // `precision highp float;`, `layout(...) in;`, `invariant a;` may stand there as often as one likes.
    static const std::set<std::string> kNoTypes = {"",         "invariant", "precise",
                                                   "centroid", "flat",      "centroid varying"};
    const std::string first = list.names.front().empty() ? "" : source.text(list.names.front().front());
    const bool declares_no_name = kNoTypes.count(head) > 0 || head.rfind("precision", 0) == 0 ||
                                  first == "in" || first == "out" || first == "uniform" || first == "buffer";
    if (declares_no_name) {
      if (isNewText(source.textOf(external.tokens))) push(object, external.tokens);
      return;
    }
    std::vector<Tokens> kept;
    for (const Tokens& name : list.names) {
      if (isNewName(object, head, source.text(name.front()), source.textOf(name))) kept.push_back(name);
    }
    if (kept.size() == list.names.size()) {
      push(object, external.tokens);
    } else if (!kept.empty()) {
      push(object, list.head);
      for (std::size_t i = 0; i < kept.size(); ++i) {
        if (i > 0) push(object, commaAfter(source, external.tokens));
        push(object, kept[i]);
      }
      push(object, external.tokens.back());
    }
  }

  static TokenIndex commaAfter(const Object& source, const Tokens& tokens) {
    return *std::find_if(tokens.begin(), tokens.end(), [&](TokenIndex i) { return source.text(i) == ","; });
  }

  // False if an earlier object has declared it as this one does.
  bool isNewName(int object, const std::string& head, const std::string& name, const std::string& text) {
    new_names_.insert({name, {object, head, text}});
    const auto found = seen_names_.find(name);
    if (found == seen_names_.end()) return true;
    const Declared& before = found->second;
    if (before.head == head && before.name == text) return false;
    // An array gets its size from one of them (GLSL 4.60, 4.1.9).
    if (before.head == head && text == name + " [ ]" && isSizedArray(before.name)) return false;
    if (before.head == head && before.name == name + " [ ]" && isSizedArray(text)) return true;
    throw Refused{differently(object, name, head + " " + text, before)};
  }

  static bool isSizedArray(const std::string& text) {
    return text.find(" [ ") != std::string::npos && text.find(" = ") == std::string::npos;
  }

  void push(int object, TokenIndex token) {
    result_.text.tokens.push_back(objects_[static_cast<std::size_t>(object)].token(token));
    result_.origins.push_back({object, token});
  }
  void push(int object, const Tokens& tokens) {
    for (TokenIndex token : tokens) push(object, token);
  }

  const std::vector<Preprocessed>& preprocessed_;
  std::vector<Object> objects_;
  LinkedObjects result_;
  // Of the objects before the current one, and of the current one: an object may well repeat itself.
  std::set<std::string> seen_texts_, new_texts_;
  std::map<std::string, Declared> seen_names_, new_names_;
};

}  // namespace

LinkedObjects linkObjects(const std::vector<Preprocessed>& objects) {
  try {
    return Linker(objects).run();
  } catch (const Refused& refused) {
    LinkedObjects result;
    result.text.error =
        "the stage is linked from several shader objects that cannot be put into one text: " + refused.reason;
    return result;
  }
}

}  // namespace shadestep::frontend
