// Calls as text: what a command's arguments and result mean, by the registry.
// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace shadestep::calls {

struct EnumerantName {
  std::uint32_t value;
  const char* name;
};
struct EnumerantNames {  // sorted by value
  const EnumerantName* first;
  unsigned count;
};
extern const EnumerantNames kEnumerantGroups[];  // [0]: all enumerants above 1
extern const unsigned kEnumerantGroupCount;

enum class Element : std::uint8_t {
  nothing,
  int8,
  int16,
  int32,
  int64,
  uint8,
  uint16,
  uint32,
  uint64,
  float32,
  float64,
  boolean,
  enumerant,
  bitmask,
  hexadecimal,
  text,
  address,
};

// Of an array: arguments[parameter] * factor elements, or `factor` if there is no such parameter; 0 = not
// known.
struct Length {
  std::int16_t parameter;
  std::int16_t factor;
};

struct ValueKind {
  const char* name;  // of the parameter; "" for the result
  Element element;
  std::uint8_t pointers;
  bool constant;  // points to what the call reads, not to what it writes
  std::uint16_t group;
  Length length;
};

struct CallDescription {
  const char* name;
  const ValueKind* parameters;  // behind them stands the result's kind
  unsigned count;

  const ValueKind& result() const { return parameters[count]; }
};
extern const CallDescription kGlCalls[];  // by the index in the API's table
extern const CallDescription kGlxCalls[];
extern const CallDescription kEglCalls[];
extern const CallDescription kOsmesaCalls[];

std::size_t elementBytes(Element);

// How many elements the array has that a parameter points to; -1: not known.
std::int64_t elementCount(const CallDescription&, const ValueKind&, const std::uint64_t* words);

// A value as an expression would spell it: 7, 0.5, GL_TRIANGLES, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
// "text", {1, 2, 3}, 0x55d0. `words` are all arguments of the call, each in 64 bits. Reads the memory that
// pointers point to.
// `written`: what the call writes is there by now.
std::string valueText(const CallDescription&, const ValueKind&, std::uint64_t word,
                      const std::uint64_t* words, bool written);

}  // namespace shadestep::calls
