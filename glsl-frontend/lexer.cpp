#include "glsl-frontend/lexer.h"

#include <algorithm>
#include <array>

namespace shadestep::frontend {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isHexDigit(char c) {
  return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}
bool isNameStart(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isNameChar(char c) {
  return isNameStart(c) || isDigit(c);
}
bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

// 2 for CRLF and LFCR, 1 for a lone CR or LF, 0 for anything else.
std::size_t lineEndLength(std::string_view text, std::size_t at) {
  if (at >= text.size() || (text[at] != '\n' && text[at] != '\r')) return 0;
  const bool pair =
      at + 1 < text.size() && text[at + 1] != text[at] && (text[at + 1] == '\n' || text[at + 1] == '\r');
  return pair ? 2 : 1;
}

// The text without line continuations and comments, each character with its place.
struct CleanText {
  std::string chars;
  std::vector<Place> places;

  void add(char c, Place place) {
    chars.push_back(c);
    places.push_back(place);
  }
};

// Reads characters of the text one by one; line ends come as '\n', continued lines come joined.
class Reader {
 public:
  explicit Reader(std::string_view text, int first_line) : text_(text), line_(first_line) {
    skipContinuations();
  }

  bool atEnd() const { return at_ >= text_.size(); }
  char current() const { return atEnd() ? '\0' : lineEndLength(text_, at_) ? '\n' : text_[at_]; }
  Place place() const { return {line_, static_cast<int>(at_ - line_start_) + 1}; }

  void advance() {
    step();
    skipContinuations();
  }
  char following() const {
    Reader next = *this;
    next.advance();
    return next.current();
  }

 private:
  void step() {
    if (const std::size_t length = lineEndLength(text_, at_)) {
      at_ += length;
      ++line_;
      line_start_ = at_;
    } else {
      ++at_;
    }
  }
  void skipContinuations() {
    while (at_ < text_.size() && text_[at_] == '\\' && lineEndLength(text_, at_ + 1)) {
      ++at_;
      step();
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  int line_;
};

void skipLineComment(Reader& reader) {
  while (!reader.atEnd() && reader.current() != '\n') reader.advance();
}

bool skipBlockComment(Reader& reader) {
  reader.advance();
  reader.advance();
  while (!reader.atEnd()) {
    if (reader.current() == '*' && reader.following() == '/') {
      reader.advance();
      reader.advance();
      return true;
    }
    reader.advance();
  }
  return false;
}

CleanText clean(std::string_view text, Place* unclosed_comment, int first_line) {
  CleanText out;
  out.chars.reserve(text.size());
  out.places.reserve(text.size());
  Reader reader(text, first_line);
  while (!reader.atEnd()) {
    const Place place = reader.place();
    const char c = reader.current();
    const char next = c == '/' ? reader.following() : '\0';
    if (c == '/' && next == '/') {
      skipLineComment(reader);
      out.add(' ', place);
    } else if (c == '/' && next == '*') {
      if (!skipBlockComment(reader) && unclosed_comment) *unclosed_comment = place;
      out.add(' ', place);
    } else {
      out.add(c, place);
      reader.advance();
    }
  }
  return out;
}

std::size_t numberEnd(std::string_view text, std::size_t at) {
  const auto skip = [&](auto test) {
    while (at < text.size() && test(text[at])) ++at;
  };
  if (text[at] == '0' && at + 1 < text.size() && (text[at + 1] == 'x' || text[at + 1] == 'X')) {
    at += 2;
    skip(isHexDigit);
  } else {
    skip(isDigit);
    if (at < text.size() && text[at] == '.') {
      ++at;
      skip(isDigit);
    }
    if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
      std::size_t digits = at + 1;
      if (digits < text.size() && (text[digits] == '+' || text[digits] == '-')) ++digits;
      if (digits < text.size() && isDigit(text[digits])) {
        at = digits;
        skip(isDigit);
      }
    }
  }
  skip(isNameChar);  // suffixes: f, lf, u, ...
  return at;
}

std::size_t punctuatorLength(std::string_view rest) {
  static constexpr std::array<std::string_view, 22> kLong = {
      "<<=", ">>=", "++", "--", "<=", ">=", "==", "!=", "&&", "||", "^^",
      "+=",  "-=",  "*=", "/=", "%=", "&=", "|=", "^=", "<<", ">>", "##"};
  for (std::string_view candidate : kLong) {
    if (rest.substr(0, candidate.size()) == candidate) return candidate.size();
  }
  return 1;
}

std::size_t tokenEnd(std::string_view text, std::size_t at, TokenKind& kind) {
  const char c = text[at];
  if (isNameStart(c)) {
    kind = TokenKind::identifier;
    while (at < text.size() && isNameChar(text[at])) ++at;
    return at;
  }
  if (isDigit(c) || (c == '.' && at + 1 < text.size() && isDigit(text[at + 1]))) {
    kind = TokenKind::number;
    return numberEnd(text, at);
  }
  kind = TokenKind::punctuator;
  return at + punctuatorLength(text.substr(at));
}

}  // namespace

std::vector<LexedLine> lex(std::string_view text, Place* unclosed_comment, int first_line) {
  const CleanText clean_text = clean(text, unclosed_comment, first_line);
  const std::string_view chars = clean_text.chars;
  std::vector<LexedLine> lines(1);
  bool space = false;
  for (std::size_t at = 0; at < chars.size();) {
    if (chars[at] == '\n') {
      lines.emplace_back();
      space = false;
      ++at;
    } else if (isBlank(chars[at])) {
      space = true;
      ++at;
    } else {
      LexedToken lexed;
      const std::size_t end = tokenEnd(chars, at, lexed.token.kind);
      lexed.token.text = chars.substr(at, end - at);
      lexed.token.place = clean_text.places[at];
      lexed.space_before = space;
      lines.back().tokens.push_back(std::move(lexed));
      space = false;
      at = end;
    }
  }
  return lines;
}

std::vector<std::string> splitLines(std::string_view text) {
  std::vector<std::string> lines(1);
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t length = lineEndLength(text, at)) {
      lines.emplace_back();
      at += length;
    } else {
      lines.back().push_back(text[at++]);
    }
  }
  if (lines.size() > 1 && lines.back().empty()) lines.pop_back();
  return lines;
}

}  // namespace shadestep::frontend
