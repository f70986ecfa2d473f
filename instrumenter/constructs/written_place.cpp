#include "instrumenter/constructs/written_place.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "instrumenter/constructs/declaration.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Shader;
using frontend::Statement;
using frontend::Token;
using frontend::TokenIndex;
using frontend::TokenKind;
using frontend::TokenRange;
using frontend::Type;
using frontend::Variable;
using frontend::VariableId;

namespace {

bool assigns(std::string_view text) {
  return text == "=" || (text.size() >= 2 && text.back() == '=' && text != "==" && text != "!=" &&
                         text != "<=" && text != ">=");
}
bool counts(std::string_view text) {
  return text == "++" || text == "--";
}

class Reader {
 public:
  Reader(const Shader& shader, const Statement& statement) : shader_(shader), statement_(statement) {}

  std::optional<WrittenPlace> read() const {
    const TokenRange all = statement_.expression;
    if (all.empty()) return std::nullopt;
    if (at(all.first).text == "imageStore") return stored(all);
    TokenRange target = all;
    if (counts(at(all.first).text)) {
      ++target.first;
    } else if (counts(at(all.last).text)) {
      --target.last;
    } else {
      const TokenIndex op = topLevel(all, assigns);
      if (op == frontend::kNone) return std::nullopt;
      target.last = op - 1;
    }
    if (target.empty() || topLevel(all, [](std::string_view text) { return text == ","; }) != frontend::kNone)
      return std::nullopt;
    return assigned(target);
  }

 private:
  const Token& at(TokenIndex i) const { return shader_.tokens[static_cast<std::size_t>(i)]; }
  const Variable& variable(VariableId id) const { return shader_.variables[static_cast<std::size_t>(id)]; }

  // The first token of the kind outside of all brackets.
  template <class Is>
  TokenIndex topLevel(TokenRange range, Is is) const {
    for (TokenIndex i = range.first; i <= range.last; ++i) {
      const std::string& text = at(i).text;
      if (text == "(" || text == "[" || text == "{") {
        i = matchingBracket(shader_, i);
      } else if (is(text)) {
        return i;
      }
    }
    return frontend::kNone;
  }

  std::string textOf(TokenRange range, const char* between) const {
    std::string text;
    for (TokenIndex i = range.first; i <= range.last; ++i) text += (text.empty() ? "" : between) + at(i).text;
    return text;
  }

  // Evaluating the tokens once more, behind the statement, gives what they gave in it, and changes nothing.
  bool isRepeatable(TokenRange range) const {
    for (TokenIndex i = range.first; i <= range.last; ++i) {
      const Token& token = at(i);
      if (assigns(token.text) || counts(token.text)) return false;
      if (token.text.starts_with("atomic") || token.text.starts_with("imageAtomic")) return false;
      for (const frontend::CallId call : statement_.calls)
        if (shader_.calls[static_cast<std::size_t>(call)].name == i) return false;
      for (const VariableId id : statement_.changes)
        if (token.kind == TokenKind::identifier && variable(id).name == token.text) return false;
    }
    return true;
  }

  bool isReadable(const Variable& written) const {
    if (written.declared == frontend::kNone) return true;
    const TokenRange declaration = globalDeclaration(shader_, written);
    const bool global = written.storage == frontend::Storage::buffer;
    for (TokenIndex i = declaration.first; global && i <= declaration.last; ++i)
      if (at(i).text == "writeonly") return false;
    return true;
  }

  std::optional<WrittenPlace> assigned(TokenRange target) const {
    WrittenPlace place;
    for (const VariableId id : statement_.changes) {
      if (variable(id).name != at(target.first).text) continue;
      if (place.variable != frontend::kNone) return std::nullopt;
      place.variable = id;
    }
    if (place.variable == frontend::kNone || !isReadable(variable(place.variable))) return std::nullopt;
    place.type = variable(place.variable).type;
    for (TokenIndex i = target.first + 1; i <= target.last; ++i) {
      if (at(i).text == "." && i < target.last) {
        if (!takeMember(place.type, at(++i).text)) return std::nullopt;
      } else if (at(i).text == "[") {
        const TokenIndex close = matchingBracket(shader_, i);
        if (!isRepeatable({i + 1, close - 1}) || !takeElement(place.type)) return std::nullopt;
        i = close;
      } else {
        return std::nullopt;
      }
    }
    place.name = textOf(target, "");
    place.expression = textOf(target, " ");
    return place;
  }

  static bool takeMember(Type& type, const std::string& name) {
    if (type.isVector()) {
      type.rows = static_cast<int>(name.size());
      return true;
    }
    if (type.isArray() || !type.members) return false;
    for (const frontend::Member& member : type.members->members) {
      if (member.name != name) continue;
      type = Type(member.type);
      return true;
    }
    return false;
  }

  static bool takeElement(Type& type) {
    if (type.isArray()) {
      type = type.element();
    } else if (type.isMatrix()) {
      type.columns = 1;
    } else if (type.isVector()) {
      type.rows = 1;
    } else {
      return false;
    }
    return true;
  }

  // imageStore(image, place[, sample], value)
  std::optional<WrittenPlace> stored(TokenRange all) const {
    const TokenIndex open = all.first + 1;
    if (at(open).text != "(" || matchingBracket(shader_, open) != all.last) return std::nullopt;
    std::vector<TokenRange> arguments;
    for (TokenIndex first = open + 1; first < all.last;) {
      const TokenIndex comma =
          topLevel({first, all.last - 1}, [](std::string_view text) { return text == ","; });
      const TokenIndex last = comma == frontend::kNone ? all.last - 1 : comma - 1;
      arguments.push_back({first, last});
      first = last + 2;
    }
    if (arguments.size() < 3 || !isRepeatable(arguments.back())) return std::nullopt;

    WrittenPlace place;
    for (std::size_t i = 0; i < shader_.variables.size(); ++i) {
      const Variable& image = shader_.variables[i];
      if (image.name == at(arguments[0].first).text && image.type.basic == Basic::opaque)
        place.variable = static_cast<VariableId>(i);
    }
    if (place.variable == frontend::kNone) return std::nullopt;
    const std::string& kind = variable(place.variable).type.opaque_name;
    place.type.rows = 4;
    place.type.basic = kind.starts_with("i") && !kind.starts_with("image") ? Basic::int_
                       : kind.starts_with("u")                             ? Basic::uint_
                                                                           : Basic::float_;
    place.name =
        textOf(arguments[0], "") + "[" + textOf({arguments[1].first, arguments.end()[-2].last}, "") + "]";
    place.expression = frontend::glslName(place.type) + "(" + textOf(arguments.back(), " ") + ")";
    return place;
  }

  const Shader& shader_;
  const Statement& statement_;
};

}  // namespace

std::optional<WrittenPlace> writtenPlace(const Shader& shader, const Statement& statement) {
  if (statement.kind != frontend::StatementKind::expression) return std::nullopt;
  return Reader(shader, statement).read();
}

}  // namespace shadestep::instrumenter
