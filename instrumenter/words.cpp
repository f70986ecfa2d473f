#include "instrumenter/words.h"

#include "instrumenter/helpers/helpers.h"

namespace shadestep::instrumenter {

using frontend::Basic;
using frontend::Component;
using frontend::Type;

namespace {

// `integer` is the type of the words: "uint" or "int". GLSL's conversions between the two keep the bits, in
// ES at full precision only.
std::vector<std::string> integerWords(const Draft& draft, const std::string& expression, const Type& type,
                                      const std::string& integer) {
  const Basic other = integer == "uint" ? Basic::int_ : Basic::uint_;
  const bool has_uint = draft.shader().version >= 130;
  const std::string from_float = integer == "uint" ? "floatBitsToUint(" : "floatBitsToInt(";
  std::vector<std::string> words;
  for (const Component& component : frontend::components(type)) {
    const std::string value = expression + component.access;
    const auto both = [&](const std::string& unpack) {
      words.push_back(integer + "(" + unpack + "(" + value + ").x)");
      words.push_back(integer + "(" + unpack + "(" + value + ").y)");
    };
    switch (component.basic) {
      case Basic::float_:
        words.push_back(from_float + value + ")");
        break;
      case Basic::double_:
        both("unpackDouble2x32");
        break;
      case Basic::int64_:
        both("unpackInt2x32");
        break;
      case Basic::uint64_:
        both("unpackUint2x32");
        break;
      default:
        words.push_back((draft.es() && has_uint && component.basic == other ? draft.name(integer) : integer) +
                        "(" + value + ")");
    }
  }
  return words;
}

}  // namespace

std::vector<std::string> uintWords(const Draft& draft, const std::string& expression, const Type& type) {
  return integerWords(draft, expression, type, "uint");
}

std::vector<std::string> intWords(const Draft& draft, const std::string& expression, const Type& type) {
  return integerWords(draft, expression, type, "int");
}

std::vector<std::string> floatChannels(const Draft& draft, const std::string& expression, const Type& type) {
  const bool has_uint = draft.shader().version >= 130;
  std::vector<std::string> channels;
  for (const Component& component : frontend::components(type)) {
    const std::string value = expression + component.access;
    if (component.basic == Basic::float_) {
      channels.push_back(value);
      continue;
    }
    Type scalar;
    scalar.basic = component.basic;
    for (const std::string& word :
         has_uint ? uintWords(draft, value, scalar) : intWords(draft, value, scalar)) {
      channels.push_back(has_uint ? "float(" + word + " & 65535u)" : draft.name("low(") + word + ")");
      channels.push_back(has_uint ? "float(" + word + " >> 16)" : draft.name("high(") + word + ")");
    }
  }
  return channels;
}

int channelCount(const Type& type) {
  int channels = 0;
  for (const Component& component : frontend::components(type)) {
    Type scalar;
    scalar.basic = component.basic;
    channels += component.basic == Basic::float_ ? 1 : 2 * frontend::wordCount(scalar);
  }
  return channels;
}

void prepareWords(Draft& draft) {
  if (draft.es()) draft.declare(draft.adapt(helpers::k_es_words));
  if (!draft.es() && draft.shader().version < 330) draft.require("GL_ARB_shader_bit_encoding");
}

}  // namespace shadestep::instrumenter
