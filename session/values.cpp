#include "session/values.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace shadestep::session {
namespace {

using frontend::Basic;
using frontend::Type;

template <class Real>
std::string formatReal(Real value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

std::uint64_t wide(const std::uint32_t* words) {
  return words[0] | (static_cast<std::uint64_t>(words[1]) << 32);
}

// Writes the value of `type` that starts at `word`, and moves `word` past it.
std::string format(const Type& type, const std::uint32_t*& word) {
  if (type.isScalar()) {
    std::string text = formatComponent(type.basic, word);
    word += wordsPerComponent(type.basic);
    return text;
  }
  std::string text = glslName(type) + "(";
  const auto append = [&](const Type& part) {
    if (text.back() != '(') text += ", ";
    text += format(part, word);
  };
  if (type.isArray()) {
    for (int i = 0; i < type.array.front(); ++i) append(type.element());
  } else if (type.basic == Basic::struct_) {
    for (const frontend::Member& member : type.members->members) append(member.type);
  } else {
    Type scalar;
    scalar.basic = type.basic;
    for (int i = 0; i < type.rows * type.columns; ++i) append(scalar);
  }
  return text + ")";
}

}  // namespace

int wordsPerComponent(Basic basic) {
  return basic == Basic::double_ || basic == Basic::int64_ || basic == Basic::uint64_ ? 2 : 1;
}

std::string formatComponent(Basic basic, const std::uint32_t* words) {
  switch (basic) {
    case Basic::bool_:
      return words[0] != 0 ? "true" : "false";
    case Basic::int_:
      return std::to_string(static_cast<std::int32_t>(words[0]));
    case Basic::uint_:
      return std::to_string(words[0]);
    case Basic::float_:
      return formatReal(std::bit_cast<float>(words[0]));
    case Basic::double_:
      return formatReal(std::bit_cast<double>(wide(words)));
    case Basic::int64_:
      return std::to_string(static_cast<std::int64_t>(wide(words)));
    case Basic::uint64_:
      return std::to_string(wide(words));
    default:
      return "?";
  }
}

std::string formatValue(const instrumenter::Value& value) {
  if (value.words.empty()) return glslName(value.type) + "()";
  const std::uint32_t* word = value.words.data();
  return format(value.type, word);
}

double componentAsDouble(Basic basic, const std::uint32_t* words) {
  switch (basic) {
    case Basic::bool_:
      return words[0] != 0 ? 1 : 0;
    case Basic::int_:
      return static_cast<std::int32_t>(words[0]);
    case Basic::uint_:
      return words[0];
    case Basic::float_:
      return static_cast<double>(std::bit_cast<float>(words[0]));
    case Basic::double_:
      return std::bit_cast<double>(wide(words));
    case Basic::int64_:
      return static_cast<double>(static_cast<std::int64_t>(wide(words)));
    case Basic::uint64_:
      return static_cast<double>(wide(words));
    default:
      return 0;
  }
}

double shortestDouble(float value) {
  if (!std::isfinite(value)) return static_cast<double>(value);
  return std::strtod(formatReal(value).c_str(), nullptr);
}

}  // namespace shadestep::session
