// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#include "interceptor/calls/call_text.h"

#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace shadestep::calls {
namespace {

constexpr std::int64_t kMostElements = 16;
constexpr std::size_t kMostCharacters = 160;

template <class Number>
Number as(std::uint64_t word) {
  Number number{};
  std::memcpy(&number, &word, sizeof number);
  return number;
}

template <class Number>
std::string decimal(Number number) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, number).ptr;
  return {text, end};
}

std::string hexadecimal(std::uint64_t number) {
  char text[24];
  const auto end = std::to_chars(text, text + sizeof text, number, 16).ptr;
  return "0x" + std::string(text, end);
}

const char* nameIn(const EnumerantNames& names, std::uint32_t value) {
  const EnumerantName* end = names.first + names.count;
  const EnumerantName* found = std::lower_bound(
      names.first, end, value, [](const EnumerantName& one, std::uint32_t v) { return one.value < v; });
  return found != end && found->value == value ? found->name : nullptr;
}

std::string enumerant(unsigned group, std::uint32_t value) {
  if (group != 0) {
    if (const char* name = nameIn(kEnumerantGroups[group], value)) return name;
  }
  if (const char* name = nameIn(kEnumerantGroups[0], value)) return name;
  return value < 256 ? decimal(value) : hexadecimal(value);
}

std::string bitmask(unsigned group, std::uint32_t value) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : " | ") + part; };
  std::uint32_t rest = value;
  if (group != 0) {
    const EnumerantNames& names = kEnumerantGroups[group];
    if (const char* whole = nameIn(names, value)) return whole;
    for (unsigned i = 0; i < names.count; ++i) {
      const std::uint32_t bits = names.first[i].value;
      const bool single = bits != 0 && (bits & (bits - 1)) == 0;
      if (!single || (rest & bits) == 0) continue;
      add(names.first[i].name);
      rest &= ~bits;
    }
  }
  if (rest != 0 || text.empty()) add(rest == 0 ? "0" : hexadecimal(rest));
  return text;
}

// What a pointer of the program points to may not be there: a driver that ignores a call does not look
// either.
bool readable(void* copy, const void* memory, std::size_t size) {
  const iovec to{copy, size};
  const iovec from{const_cast<void*>(memory), size};
  return process_vm_readv(getpid(), &to, 1, &from, 1, 0) == static_cast<ssize_t>(size);
}

// Up to the first 0, and at most `most` characters (< 0: no limit). False if it cannot be read.
bool readText(const char* memory, std::int64_t most, std::string& text) {
  constexpr std::size_t kPage = 4096;
  while (most < 0 || text.size() < static_cast<std::size_t>(most)) {
    char part[kPage];
    const char* const from = memory + text.size();
    std::size_t size =
        kPage - reinterpret_cast<std::uintptr_t>(from) % kPage;  // pages are there or not, whole
    if (most >= 0) size = std::min(size, static_cast<std::size_t>(most) - text.size());
    if (!readable(part, from, size)) return false;
    const std::size_t length = strnlen(part, size);
    text.append(part, length);
    if (length < size) break;
  }
  return true;
}

std::string quoted(const char* memory, std::int64_t most) {
  std::string text;
  if (!readText(memory, most, text)) return hexadecimal(reinterpret_cast<std::uintptr_t>(memory));
  std::string result = "\"";
  for (const char c : text.substr(0, kMostCharacters)) {
    if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (c == '\n')
      result += "\\n";
    else if (c == '\t')
      result += "\\t";
    else if (c == '\r')
      result += "\\r";
    else
      result += c;
  }
  result += "\"";
  return text.size() > kMostCharacters ? result + "... (" + decimal(text.size()) + " characters)" : result;
}

std::string scalar(Element element, unsigned group, std::uint64_t word) {
  switch (element) {
    case Element::int8:
      return decimal(static_cast<int>(as<std::int8_t>(word)));
    case Element::int16:
      return decimal(as<std::int16_t>(word));
    case Element::int32:
      return decimal(as<std::int32_t>(word));
    case Element::int64:
      return decimal(as<std::int64_t>(word));
    case Element::uint8:
      return decimal(static_cast<unsigned>(as<std::uint8_t>(word)));
    case Element::uint16:
      return decimal(as<std::uint16_t>(word));
    case Element::uint32:
      return decimal(as<std::uint32_t>(word));
    case Element::uint64:
      return decimal(word);
    case Element::float32:
      return decimal(as<float>(word));
    case Element::float64:
      return decimal(as<double>(word));
    case Element::boolean:
      return as<std::uint8_t>(word) == 0   ? "GL_FALSE"
             : as<std::uint8_t>(word) == 1 ? "GL_TRUE"
                                           : decimal(word & 0xff);
    case Element::enumerant:
      return enumerant(group, as<std::uint32_t>(word));
    case Element::bitmask:
      return bitmask(group, as<std::uint32_t>(word));
    case Element::hexadecimal:
      return hexadecimal(as<std::uint32_t>(word));
    case Element::text:
    case Element::nothing:
    case Element::address:
      break;
  }
  return word == 0 ? "NULL" : hexadecimal(word);
}

std::string list(std::int64_t count, bool more, auto element) {
  const std::int64_t shown = std::min(count, kMostElements);
  std::string text = "{";
  for (std::int64_t i = 0; i < shown; ++i) text += (i > 0 ? ", " : "") + element(i);
  if (more) return text + ", ...}";
  return text + (count > shown ? ", ... (" + decimal(count) + " elements)}" : "}");
}

// `count` < 0: how many there are depends on another argument's meaning; the first is shown.
std::string array(const ValueKind& kind, const void* memory, std::int64_t count) {
  const std::size_t size = elementBytes(kind.element);
  const std::int64_t known = count < 0 ? 1 : count;
  char copy[kMostElements * 8];
  const std::size_t shown = static_cast<std::size_t>(std::min(known, kMostElements)) * size;
  if (!readable(copy, memory, shown)) return hexadecimal(reinterpret_cast<std::uintptr_t>(memory));
  return list(known, count < 0, [&](std::int64_t i) {
    std::uint64_t word = 0;
    std::memcpy(&word, copy + static_cast<std::size_t>(i) * size, size);
    return scalar(kind.element, kind.group, word);
  });
}

std::string textArray(const void* memory, std::int64_t count) {
  const char* strings[kMostElements];
  const std::size_t shown = static_cast<std::size_t>(std::min(count, kMostElements)) * sizeof(char*);
  if (!readable(strings, memory, shown)) return hexadecimal(reinterpret_cast<std::uintptr_t>(memory));
  return list(count, false,
              [&](std::int64_t i) { return strings[i] == nullptr ? "NULL" : quoted(strings[i], -1); });
}

}  // namespace

std::size_t elementBytes(Element element) {
  switch (element) {
    case Element::int8:
    case Element::uint8:
    case Element::boolean:
    case Element::text:
      return 1;
    case Element::int16:
    case Element::uint16:
      return 2;
    case Element::int32:
    case Element::uint32:
    case Element::float32:
    case Element::enumerant:
    case Element::bitmask:
    case Element::hexadecimal:
      return 4;
    case Element::nothing:
      return 0;
    default:
      return 8;
  }
}

std::int64_t elementCount(const CallDescription& call, const ValueKind& array, const std::uint64_t* words) {
  const Length& length = array.length;
  if (length.factor == 0) return -1;
  if (length.parameter < 0) return length.factor;
  const ValueKind& kind = call.parameters[length.parameter];
  const std::uint64_t word = words[length.parameter];
  const std::int64_t count =
      elementBytes(kind.element) == 8 ? as<std::int64_t>(word) : as<std::int32_t>(word);
  return std::clamp<std::int64_t>(count, 0, 1 << 20) * length.factor;
}

std::string valueText(const CallDescription& call, const ValueKind& kind, std::uint64_t word,
                      const std::uint64_t* words, bool written) {
  if (kind.pointers == 0) return scalar(kind.element, kind.group, word);
  const void* memory = as<const void*>(word);
  if (memory == nullptr) return "NULL";
  const std::int64_t count = elementCount(call, kind, words);
  if (!kind.constant && !written) return hexadecimal(word);
  const bool known = kind.element != Element::text || count >= 0 || kind.constant;
  if (kind.element == Element::text && kind.pointers == 1 && known)
    return quoted(static_cast<const char*>(memory), count);
  if (kind.element == Element::text && kind.pointers == 2 && count >= 0) return textArray(memory, count);
  if (kind.element != Element::nothing && kind.element != Element::text && kind.pointers == 1 && known)
    return array(kind, memory, count);
  return hexadecimal(word);
}

}  // namespace shadestep::calls
