#include "interceptor/calls/change_argument.h"

#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "interceptor/calls/watch.h"

namespace shadestep::calls {
namespace {

using std::string_view;

string_view trimmed(string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

template <class Number>
std::optional<Number> parsed(string_view text, auto... base) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base...);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

template <class Number>
std::optional<std::uint64_t> floating(string_view text) {
  const auto number = parsed<Number>(text);
  return number ? std::optional(asWord(*number)) : std::nullopt;
}

// Decimal within the type's range, or the bits as 0x...
template <class Number>
std::optional<std::uint64_t> integer(string_view text) {
  if (text.starts_with("0x")) {
    const auto bits = parsed<std::make_unsigned_t<Number>>(text.substr(2), 16);
    return bits ? std::optional(asWord(*bits)) : std::nullopt;
  }
  const auto number = parsed<Number>(text);
  return number ? std::optional(asWord(*number)) : std::nullopt;
}

std::optional<std::uint64_t> constantIn(const EnumerantNames& names, string_view text) {
  for (unsigned i = 0; i < names.count; ++i) {
    if (text == names.first[i].name) return names.first[i].value;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> constant(unsigned group, string_view text) {
  if (text.starts_with("GL_")) {
    if (const auto value = constantIn(kEnumerantGroups[group], text)) return value;
    for (unsigned i = 0; i < kEnumerantGroupCount; ++i) {
      if (const auto value = constantIn(kEnumerantGroups[i], text)) return value;
    }
  }
  return integer<std::uint32_t>(text);
}

std::optional<std::uint64_t> bits(unsigned group, string_view text) {
  std::uint64_t all = 0;
  while (true) {
    const auto bar = text.find('|');
    const auto one = constant(group, trimmed(text.substr(0, bar)));
    if (!one) return std::nullopt;
    all |= *one;
    if (bar == string_view::npos) return all;
    text.remove_prefix(bar + 1);
  }
}

std::optional<std::uint64_t> boolean(string_view text) {
  if (text == "GL_TRUE" || text == "true") return 1;
  if (text == "GL_FALSE" || text == "false") return 0;
  return integer<std::uint8_t>(text);
}

std::optional<std::uint64_t> scalar(const ValueKind& kind, string_view text) {
  switch (kind.element) {
    case Element::int8:
      return integer<std::int8_t>(text);
    case Element::int16:
      return integer<std::int16_t>(text);
    case Element::int32:
      return integer<std::int32_t>(text);
    case Element::int64:
      return integer<std::int64_t>(text);
    case Element::uint8:
      return integer<std::uint8_t>(text);
    case Element::uint16:
      return integer<std::uint16_t>(text);
    case Element::uint32:
    case Element::hexadecimal:
      return integer<std::uint32_t>(text);
    case Element::float32:
      return floating<float>(text);
    case Element::float64:
      return floating<double>(text);
    case Element::boolean:
      return boolean(text);
    case Element::enumerant:
      return constant(kind.group, text);
    case Element::bitmask:
      return bits(kind.group, text);
    default:
      return text == "NULL" ? std::optional<std::uint64_t>(0) : integer<std::uint64_t>(text);
  }
}

// The characters of "text", with a 0 behind them.
std::optional<std::vector<std::byte>> characters(string_view text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::vector<std::byte> result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '\\') {
      if (++i == text.size()) return std::nullopt;
      c = text[i] == 'n' ? '\n' : text[i] == 't' ? '\t' : text[i] == 'r' ? '\r' : text[i];
    }
    result.push_back(static_cast<std::byte>(c));
  }
  result.push_back(std::byte{0});
  return result;
}

std::optional<std::vector<std::byte>> elements(const ValueKind& kind, string_view text, std::int64_t count) {
  text = text.substr(1, text.size() - 2);
  const std::size_t size = elementBytes(kind.element);
  std::vector<std::byte> result;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto comma = text.find(',');
    const auto word = scalar(kind, trimmed(text.substr(0, comma)));
    if (!word || (comma == string_view::npos) != (i == count - 1)) return std::nullopt;
    std::byte bytes[sizeof *word];
    std::memcpy(bytes, &*word, sizeof bytes);
    result.insert(result.end(), bytes, bytes + size);
    if (comma != string_view::npos) text.remove_prefix(comma + 1);
  }
  return result;
}

std::string inWords(const std::string& text, const ValueKind& kind, std::int64_t count) {
  std::string sentence = "'" + text + "' is no value for " + kind.name;
  if (kind.pointers == 0 || kind.element == Element::nothing) return sentence;
  if (!kind.constant) return sentence + ", which the call writes to";
  if (kind.element == Element::text && kind.pointers == 1) return sentence + ", which takes \"text\"";
  if (kind.pointers > 1 || count < 0) return sentence + ", whose elements cannot be changed";
  return sentence + ", which takes {...} with " + std::to_string(count) +
         (count == 1 ? " element" : " elements");
}

}  // namespace

std::string changeArgument(const CallDescription& call, std::uint64_t* words, const std::string& name,
                           const std::string& text, ArgumentMemory& memory) {
  std::string names;
  for (unsigned i = 0; i < call.count; ++i) {
    const ValueKind& kind = call.parameters[i];
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
    if (name != kind.name) continue;
    const string_view value = trimmed(text);
    const std::int64_t count = kind.pointers == 0 ? -1 : elementCount(call, kind, words);
    if (kind.pointers == 1 && kind.constant && kind.element != Element::nothing) {
      std::optional<std::vector<std::byte>> bytes;
      if (kind.element == Element::text)
        bytes = characters(value);
      else if (count >= 0 && value.size() >= 2 && value.front() == '{' && value.back() == '}')
        bytes = elements(kind, value, count);
      if (bytes) {
        words[i] = asWord(memory.add(std::move(*bytes)));
        return "";
      }
    }
    // A pointer without known elements is often an offset into a buffer.
    const bool address = kind.pointers > 0 && kind.element != Element::nothing && value != "NULL";
    const ValueKind plain = kind.pointers == 0 ? kind : ValueKind{"", Element::address, 0, false, 0, {-1, 0}};
    const auto word = address ? std::nullopt : scalar(plain, value);
    if (!word) return inWords(text, kind, count);
    words[i] = *word;
    return "";
  }
  if (names.empty()) return std::string(call.name) + " has no arguments";
  return std::string(call.name) + " has no argument '" + name + "'; it has " + names;
}

}  // namespace shadestep::calls
