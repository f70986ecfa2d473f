// The GLSL preprocessor (GLSL 4.60, 3.3): directives are carried out, macros expanded.
#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "glsl-frontend/condition.h"
#include "glsl-frontend/extension_macros.h"
#include "glsl-frontend/include_tree.h"
#include "glsl-frontend/lexer.h"
#include "glsl-frontend/macros.h"
#include "glsl-frontend/tokens.h"

namespace shadestep::frontend {

namespace {

constexpr std::size_t kDeepestInclude = 100;

// One #if ... #endif that is open.
struct Conditional {
  Place place;
  bool outer_active = true;  // the text around it counts
  bool active = false;       // the current branch counts
  bool taken = false;        // some branch has counted
  bool else_seen = false;
};

class Preprocessor {
 public:
  Preprocessor(const PreprocessorFacts& facts, int first_line, const Includes& includes, Preprocessed& result)
      : facts_(facts), first_line_(first_line), tree_(includes), result_(result) {
    setVersion(facts.es ? 100 : 110, facts.es ? "es" : "");
    if (facts.es) result_.profile = "";
  }

  // One string: its lines come behind those that there are.
  void run(const std::string& text) {
    const int first_line = nextLine();
    const std::vector<std::string> text_lines = splitLines(text);
    result_.lines.insert(result_.lines.end(), text_lines.begin(), text_lines.end());
    macros_.setNumbering({});
    macros_.setLine(first_line - 1, 1);
    Place unclosed;
    const std::vector<LexedLine> lines = lex(text, &unclosed, first_line);
    if (unclosed.line > 0) throw PreprocessError{unclosed, "this comment is not closed"};

    const std::size_t outer_conditionals = outer_conditionals_;
    outer_conditionals_ = conditionals_.size();
    for (const LexedLine& line : lines) {
      if (line.isDirective()) {
        flush();
        directive(line.tokens);
      } else if (active()) {
        for (const LexedToken& lexed : line.tokens) text_.push_back(lexed.token);
      }
    }
    flush();
    if (conditionals_.size() > outer_conditionals_) {
      throw PreprocessError{conditionals_.back().place, "this conditional has no #endif"};
    }
    outer_conditionals_ = outer_conditionals;
  }

  // "line 7", or "line 2 of the included string /lib/noise".
  std::string nameOf(int line) const {
    const IncludedString* within = nullptr;
    for (const IncludedString& string : result_.included) {
      if (string.first_line <= line) within = &string;
    }
    if (within == nullptr) return "line " + std::to_string(line);
    return "line " + std::to_string(line - within->first_line + 1) + " of the included string " +
           within->name;
  }

 private:
  int nextLine() const { return first_line_ + static_cast<int>(result_.lines.size()); }

  bool active() const { return conditionals_.empty() || conditionals_.back().active; }

  // Text between two directives is expanded as a whole: a macro's call may stretch over lines.
  void flush() {
    std::vector<Token> expanded = macros_.expand(text_);
    std::move(expanded.begin(), expanded.end(), std::back_inserter(result_.tokens));
    text_.clear();
  }

  void directive(const std::vector<LexedToken>& line) {
    place_ = line.front().token.place;
    if (line.size() == 1) return;  // `#` alone
    const std::string& name = line[1].token.text;
    const std::vector<LexedToken> rest(line.begin() + 2, line.end());
    if (conditional(name, rest) || !active()) return;
    if (name == "define") {
      define(rest);
    } else if (name == "undef") {
      macros_.undefine(macroName(rest, "#undef"));
    } else if (name == "version") {
      version(rest);
      keep(line);
    } else if (name == "extension") {
      extension(rest);
      keep(line);
    } else if (name == "pragma") {
      keep(line);
    } else if (name == "line") {
      lineNumber(rest);
    } else if (name == "include") {
      include(rest);
    } else if (name == "error") {
      fail("#error " + joined(rest));
    } else {
      fail("#" + name + " is not known here");
    }
  }

  // Carries out #if and its kin; says whether `name` was one of them.
  bool conditional(const std::string& name, const std::vector<LexedToken>& rest) {
    if (name == "if") {
      open(active() && evaluateCondition(tokensOf(rest), macros_, place_));
    } else if (name == "ifdef") {
      open(active() && macros_.isDefined(macroName(rest, "#ifdef")));
    } else if (name == "ifndef") {
      open(active() && !macros_.isDefined(macroName(rest, "#ifndef")));
    } else if (name == "elif") {
      Conditional& current = innermost(name);
      const bool may_take = current.outer_active && !current.taken;
      branch(current, may_take && evaluateCondition(tokensOf(rest), macros_, place_));
    } else if (name == "else") {
      Conditional& current = innermost(name);
      branch(current, current.outer_active && !current.taken);
      current.else_seen = true;
    } else if (name == "endif") {
      if (conditionals_.size() <= outer_conditionals_) fail("#endif without #if");
      conditionals_.pop_back();
    } else {
      return false;
    }
    return true;
  }

  void open(bool taken) { conditionals_.push_back({place_, active(), taken, taken, false}); }

  Conditional& innermost(const std::string& name) {
    if (conditionals_.size() <= outer_conditionals_) fail("#" + name + " without #if");
    if (conditionals_.back().else_seen) fail("#" + name + " after #else");
    return conditionals_.back();
  }

  static void branch(Conditional& conditional, bool taken) {
    conditional.active = taken;
    conditional.taken = conditional.taken || taken;
  }

  void define(const std::vector<LexedToken>& rest) {
    const std::string name = macroName(rest, "#define");
    Macro macro;
    std::size_t at = 1;
    if (at < rest.size() && rest[at].token.text == "(" && !rest[at].space_before) {
      macro.function_like = true;
      at = parameters(rest, at + 1, macro.parameters);
    }
    for (; at < rest.size(); ++at) macro.body.push_back(rest[at].token);
    macros_.define(name, std::move(macro));
  }

  std::size_t parameters(const std::vector<LexedToken>& rest, std::size_t at,
                         std::vector<std::string>& names) {
    const auto text = [&](std::size_t i) { return i < rest.size() ? rest[i].token.text : std::string(); };
    if (text(at) == ")") return at + 1;
    for (;; at += 2) {
      if (at >= rest.size() || rest[at].token.kind != TokenKind::identifier) break;
      names.push_back(rest[at].token.text);
      if (text(at + 1) == ")") return at + 2;
      if (text(at + 1) != ",") break;
    }
    fail("the parameters of this macro are not closed by a ')'");
  }

  void version(const std::vector<LexedToken>& rest) {
    int number = 0;
    if (rest.empty() || !parseInteger(rest[0].token.text, number)) fail("#version needs a number");
    std::string profile = rest.size() > 1 ? rest[1].token.text : "";
    result_.profile = profile;
    setVersion(number, number == 100 ? "es" : profile);
  }

  // Macros that tell versions and profiles apart (GLSL 4.60, 3.3; GLSL ES 3.20, 3.3).
  void setVersion(int version, const std::string& profile) {
    result_.version = version;
    const bool es = profile == "es";
    for (const char* name : {"GL_ES", "GL_es_profile", "GL_core_profile", "GL_compatibility_profile",
                             "GL_FRAGMENT_PRECISION_HIGH"}) {
      macros_.undefine(name);
    }
    for (const std::string& extension : facts_.extensions) {
      if (hasMacro(extension, version, es)) {
        macros_.defineNumber(extension, 1);
      } else {
        macros_.undefine(extension);
      }
    }
    macros_.defineNumber("__VERSION__", version);
    if (es) macros_.defineNumber("GL_ES", 1);
    if (es && version >= 300) macros_.defineNumber("GL_es_profile", 1);
    if (es || version >= 130) macros_.defineNumber("GL_FRAGMENT_PRECISION_HIGH", 1);
    if (!es && version >= 150) {
      macros_.defineNumber(profile == "compatibility" ? "GL_compatibility_profile" : "GL_core_profile", 1);
    }
  }

  void extension(const std::vector<LexedToken>& rest) {
    if (rest.size() != 3 || rest[1].token.text != ":") fail("#extension needs the form 'NAME : BEHAVIOUR'");
    result_.extensions.emplace_back(rest[0].token.text, rest[2].token.text);
  }

  // `#line LINE [FILE]` numbers what follows for __LINE__ and __FILE__ only; places stay physical.
  void lineNumber(const std::vector<LexedToken>& rest) {
    const std::vector<Token> expanded = macros_.expand(tokensOf(rest));
    int line = 0;
    int file = 0;
    if (expanded.empty() || !parseInteger(expanded[0].text, line)) fail("#line needs a number");
    macros_.setLine(place_.line, line);
    if (expanded.size() > 1 && parseInteger(expanded[1].text, file)) macros_.setFile(file);
  }

  void include(const std::vector<LexedToken>& rest) {
    bool quoted = false;
    const std::string path = includedPath(rest, quoted);
    const IncludeTree::Found found =
        tree_.find(path, quoted, includers_.empty() ? nullptr : &includers_.back());
    if (found.text == nullptr) {
      fail("#include: there was no named string '" + path + "' when the shader was compiled");
    }
    if (!found.other.empty()) {
      fail("#include: '" + path + "' may mean " + found.location + " or " + found.other +
           ", depending on the driver; write the path from the root");
    }
    if (includers_.size() >= kDeepestInclude) fail("#include: strings include each other without end");

    const Place place = place_;
    const MacroTable::Numbering numbering = macros_.numbering();
    const std::size_t lines_before = result_.lines.size();
    const std::size_t tokens_before = result_.tokens.size();
    const bool again = std::any_of(result_.included.begin(), result_.included.end(),
                                   [&](const IncludedString& shown) { return shown.name == found.location; });
    result_.included.push_back({nextLine(), found.location});
    const std::size_t included_before = result_.included.size();
    includers_.push_back(found);
    run(*found.text);
    includers_.pop_back();
    macros_.setNumbering(numbering);
    place_ = place;
    // With a guard against a second inclusion, the second brings nothing.
    if (again && result_.tokens.size() == tokens_before && result_.included.size() == included_before) {
      result_.lines.resize(lines_before);
      result_.included.pop_back();
    }
  }

  // Paths are no tokens: taken from the text as it stands.
  std::string includedPath(const std::vector<LexedToken>& rest, bool& quoted) {
    const std::string form = "#include needs the form \"PATH\" or <PATH>";
    if (rest.empty()) fail(form);
    const Place place = rest[0].token.place;
    const std::string& line = result_.lines.at(static_cast<std::size_t>(place.line - first_line_));
    const std::size_t open = static_cast<std::size_t>(place.column) - 1;
    quoted = line.at(open) == '"';
    if (!quoted && line.at(open) != '<') fail(form);
    const std::size_t close = line.find(quoted ? '"' : '>', open + 1);
    if (close == std::string::npos) fail(form);
    return line.substr(open + 1, close - open - 1);
  }

  void keep(const std::vector<LexedToken>& line) {
    Token token;
    token.kind = TokenKind::directive;
    token.text = "#" + joined({line.begin() + 1, line.end()});
    token.place = place_;
    result_.tokens.push_back(std::move(token));
  }

  std::string macroName(const std::vector<LexedToken>& rest, const std::string& directive) {
    if (rest.empty() || rest[0].token.kind != TokenKind::identifier) fail(directive + " needs a name");
    return rest[0].token.text;
  }

  static bool parseInteger(const std::string& text, int& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }

  static std::vector<Token> tokensOf(const std::vector<LexedToken>& lexed) {
    std::vector<Token> tokens;
    for (const LexedToken& token : lexed) tokens.push_back(token.token);
    return tokens;
  }

  static std::string joined(const std::vector<LexedToken>& tokens) {
    std::string text;
    for (const LexedToken& lexed : tokens) text += (text.empty() ? "" : " ") + lexed.token.text;
    return text;
  }

  [[noreturn]] void fail(const std::string& message) const { throw PreprocessError{place_, message}; }

  const PreprocessorFacts& facts_;
  const int first_line_;
  const IncludeTree tree_;
  std::vector<IncludeTree::Found> includers_;  // of the string that is read, outermost first
  Preprocessed& result_;
  MacroTable macros_;
  std::vector<Conditional> conditionals_;
  std::size_t outer_conditionals_ = 0;  // of the strings that include the current one
  std::vector<Token> text_;
  Place place_;  // of the current directive
};

}  // namespace

Preprocessed preprocess(const std::vector<std::string>& strings, const PreprocessorFacts& facts,
                        int first_line, const Includes& includes) {
  std::string text;
  for (const std::string& string : strings) text += string;
  Preprocessed result;
  Preprocessor preprocessor(facts, first_line, includes, result);
  try {
    preprocessor.run(text);
  } catch (const PreprocessError& error) {
    result.error = preprocessor.nameOf(error.place.line) + ": " + error.message;
  }
  return result;
}

std::string emit(const std::vector<Token>& tokens) {
  std::string text;
  int line = 0;
  for (const Token& token : tokens) {
    if (token.kind == TokenKind::directive) {
      if (!text.empty() && text.back() != '\n') text += '\n';
      text += token.text + '\n';
    } else {
      if (!text.empty() && text.back() != '\n') text += token.place.line == line ? ' ' : '\n';
      text += token.text;
    }
    line = token.place.line;
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

}  // namespace shadestep::frontend
