// Declarations, at file scope and elsewhere.
#include "glsl-frontend/skeleton_parser.h"

#include <set>

namespace shadestep::frontend::skeleton {

bool isQualifier(std::string_view word) {
  static const std::set<std::string_view> kWords = {
      "const",     "in",      "out",      "inout",         "uniform",  "buffer",     "shared",
      "attribute", "varying", "centroid", "sample",        "patch",    "flat",       "smooth",
      "invariant", "precise", "coherent", "noperspective", "volatile", "restrict",   "readonly",
      "writeonly", "highp",   "mediump",  "lowp",          "layout",   "subroutine", "unsigned"};
  return kWords.count(word) > 0;
}

Qualifiers& note(Qualifiers& qualifiers, std::string_view word) {
  qualifiers.any = true;
  if (word == "const") qualifiers.is_const = true;
  if (word == "uniform") qualifiers.uniform = true;
  if (word == "buffer") qualifiers.buffer = true;
  if (word == "shared") qualifiers.shared = true;
  if (word == "in") qualifiers.in = true;
  if (word == "out") qualifiers.out = true;
  if (word == "inout") qualifiers.inout = true;
  if (word == "varying") qualifiers.varying = true;
  if (word == "attribute") qualifiers.attribute = true;
  if (word == "unsigned") qualifiers.is_unsigned = true;
  if (word == "highp") qualifiers.highp = true;
  if (word == "mediump" || word == "lowp") qualifiers.reduced_precision = true;
  return qualifiers;
}

// `precision mediump float;`, until the end of the scope.
void Parser::precisionStatement() {
  if (is("float", 2)) reduces_floats_ = !is("highp", 1);
  skipTo(";");
}

// In an expression a name is never followed by a name: so this tells declarations without knowing the
// types.
bool Parser::declarationStartsHere() const {
  if (!isName()) return false;
  if (is("struct") || isName(1)) return true;
  if (is("layout") && is("(", 1)) return isName(closing(1) + 1);
  int ahead = 1;
  while (is("[", ahead)) ahead = closing(ahead) + 1;
  return ahead > 1 && isName(ahead);
}

// A word that may be a name in old shaders is a qualifier only where another word follows.
bool Parser::qualifierStartsHere() const {
  return isName() && isQualifier(text()) && (isName(1) || (is("(", 1) && (is("layout") || is("subroutine"))));
}

// One qualifier, with what stands in parentheses after it.
void Parser::qualifier(Qualifiers& qualifiers) {
  if (is("subroutine")) {
    subroutineQualifier(qualifiers);
    return;
  }
  // EXT_shader_framebuffer_fetch: an output that can be read. EXT_gpu_shader4: varying out.
  if (function_ == kNone && is("inout")) out_.analysed_as[current()] = "out";
  if (is("varying") && (is("in", 1) || is("out", 1))) {
    out_.analysed_as[current()] = "";
  } else if (is("varying") && stage_ == Stage::geometry) {
    out_.analysed_as[current()] = "out";  // glslang takes it for an input
  }
  if (is("unsigned") && is("int", 1)) {
    out_.analysed_as[current()] = "";
    out_.analysed_as[tokenAt(at_ + 1)] = "uint";
  }
  note(qualifiers, text());
  const bool layout = is("layout");
  ++at_;
  if (is("(") && layout) {
    const Position start = at_ - 1;
    layoutIds();
    qualifiers.layout = range(start, at_ - 1);
  } else if (is("(")) {
    at_ += closing(0) + 1;
  }
}

DeclarationHead Parser::declarationHead() {
  DeclarationHead head;
  while (true) {
    if (qualifierStartsHere()) {
      qualifier(head.qualifiers);
    } else if (isName() && head.qualifiers.any && isQualifier(text()) && is(";", 1)) {
      note(head.qualifiers, text());  // `layout(...) in;`
      ++at_;
      return head;
    } else {
      break;
    }
  }
  if (is("struct")) {
    structSpecifier();
    head.has_type = true;
  } else if (isName() && (isName(1) || arrayedTypeStartsHere())) {
    head.type = {current(), current()};
    if (isImage(text()) && !head.qualifiers.layout.empty())
      image_layouts_.emplace_back(text(), head.qualifiers.layout);
    ++at_;
    head.has_type = true;
  }
  if (head.has_type) arrayDimensions();
  return head;
}

bool Parser::arrayedTypeStartsHere() const {
  int ahead = 1;
  while (is("[", ahead)) ahead = closing(ahead) + 1;
  return ahead > 1 && isName(ahead);
}

// Drivers fold more functions and choices in constant expressions than glslang does.
bool Parser::isComputed(const TokenRange& size) const {
  for (TokenIndex i = size.first; i <= size.last; ++i) {
    const std::string& t = tokens_[static_cast<std::size_t>(i)].text;
    if (t == "(" || t == "?") return true;
  }
  return false;
}

void Parser::arrayDimensions() {
  while (accept("[")) {
    const TokenRange size = expression({"]"});
    if (isComputed(size)) {
      for (TokenIndex i = size.first; i <= size.last; ++i) out_.relaxed_as[i] = "";
      out_.relaxed_as[size.first] = std::to_string(kUnknownSize);
    }
    expect("]");
  }
}

void Parser::structSpecifier() {
  expect("struct");
  if (isName()) {
    bind(text(), kNone);
    out_.declared_names.push_back(text());
    ++at_;
  }
  expect("{");
  while (!accept("}")) members();
}

// One line of a struct or an interface block; returns the names' tokens.
std::vector<TokenIndex> Parser::members() {
  std::vector<TokenIndex> names;
  const DeclarationHead head = declarationHead();
  if (!head.has_type) {  // a bare `layout(...)` or an empty line
    expression({";"});
    expect(";");
    return names;
  }
  do {
    if (!isName()) fail("a member's name was expected before '" + text() + "'");
    names.push_back(current());
    out_.declared_names.push_back(text());
    ++at_;
    arrayDimensions();
  } while (accept(","));
  expect(";");
  return names;
}

Storage Parser::storageOf(const Qualifiers& qualifiers, const std::string& name) const {
  if (isBuiltinName(name)) return Storage::builtin;
  if (qualifiers.uniform) return Storage::uniform;
  if (qualifiers.buffer) return Storage::buffer;
  if (qualifiers.shared) return Storage::shared;
  if (function_ == kNone) {
    if (qualifiers.out || qualifiers.inout) return Storage::out;
    if (qualifiers.varying && !qualifiers.in) return stage_ == Stage::fragment ? Storage::in : Storage::out;
    if (qualifiers.in || qualifiers.attribute) return Storage::in;
  }
  if (qualifiers.is_const) return Storage::constant;
  return function_ == kNone ? Storage::global : Storage::local;
}

// The variable of this name that the innermost scope already holds.
VariableId Parser::declaredHere(const std::string& name) const {
  const auto found = meanings_.find(name);
  if (found == meanings_.end() || found->second.empty() || found->second.back().depth != depth_) return kNone;
  return found->second.back().variable;
}

// Declares a name and makes it visible. A name may be declared again in its own scope: to size an array, to
// qualify a built-in, ...
VariableId Parser::declare(const Qualifiers& qualifiers, TokenIndex name_token) {
  const std::string& name = tokens_[static_cast<std::size_t>(name_token)].text;
  if (isBuiltinName(name)) {
    redeclareBuiltin(name);
    const VariableId variable = builtin(name);
    out_.declared_names.push_back(name);
    out_.resolved[static_cast<std::size_t>(name_token)] = variable;
    return variable;
  }
  const VariableId before = declaredHere(name);
  if (before != kNone) {
    out_.resolved[static_cast<std::size_t>(name_token)] = before;
    return before;
  }
  const VariableId variable = newVariable(name, storageOf(qualifiers, name), name_token);
  out_.variables[static_cast<std::size_t>(variable)].reduced_precision =
      qualifiers.reduced_precision || (reduces_floats_ && !qualifiers.highp);
  bind(name, variable);
  return variable;
}

// `a = 1, b[2]`: up to, not including, one of `ends`.
std::vector<Declarator> Parser::declarators(const Qualifiers& qualifiers, std::string_view end) {
  std::vector<Declarator> result;
  do {
    if (!isName()) fail("a name was expected before '" + text() + "'");
    Declarator declarator;
    const Position start = at_++;
    arrayDimensions();
    if (accept("=")) declarator.initializer = expression({",", end});
    declarator.variable = declare(qualifiers, tokenAt(start));
    declarator.tokens = range(start, at_ - 1);
    result.push_back(declarator);
  } while (accept(","));
  return result;
}

void Parser::mention(VariableId variable, TokenIndex before) {
  const Variable& named = out_.variables[static_cast<std::size_t>(variable)];
  if (named.storage != Storage::builtin) out_.insertions.push_back({before, named.name + ";", variable});
}

}  // namespace shadestep::frontend::skeleton
