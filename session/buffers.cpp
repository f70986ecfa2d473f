#include "session/buffers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>

#include "session/values.h"

namespace shadestep::session {
namespace {

using frontend::Basic;

struct GlType {
  std::uint32_t gl;
  Basic basic;
  int columns, rows;
};
// OpenGL 4.6, table 7.3; with GL_ARB_gpu_shader_int64.
constexpr std::array kTypes = {
    GlType{0x1406, Basic::float_, 1, 1},  GlType{0x8B50, Basic::float_, 1, 2},
    GlType{0x8B51, Basic::float_, 1, 3},  GlType{0x8B52, Basic::float_, 1, 4},
    GlType{0x140A, Basic::double_, 1, 1}, GlType{0x8FFC, Basic::double_, 1, 2},
    GlType{0x8FFD, Basic::double_, 1, 3}, GlType{0x8FFE, Basic::double_, 1, 4},
    GlType{0x1404, Basic::int_, 1, 1},    GlType{0x8B53, Basic::int_, 1, 2},
    GlType{0x8B54, Basic::int_, 1, 3},    GlType{0x8B55, Basic::int_, 1, 4},
    GlType{0x1405, Basic::uint_, 1, 1},   GlType{0x8DC6, Basic::uint_, 1, 2},
    GlType{0x8DC7, Basic::uint_, 1, 3},   GlType{0x8DC8, Basic::uint_, 1, 4},
    GlType{0x8B56, Basic::bool_, 1, 1},   GlType{0x8B57, Basic::bool_, 1, 2},
    GlType{0x8B58, Basic::bool_, 1, 3},   GlType{0x8B59, Basic::bool_, 1, 4},
    GlType{0x140E, Basic::int64_, 1, 1},  GlType{0x8FE9, Basic::int64_, 1, 2},
    GlType{0x8FEA, Basic::int64_, 1, 3},  GlType{0x8FEB, Basic::int64_, 1, 4},
    GlType{0x140F, Basic::uint64_, 1, 1}, GlType{0x8FF5, Basic::uint64_, 1, 2},
    GlType{0x8FF6, Basic::uint64_, 1, 3}, GlType{0x8FF7, Basic::uint64_, 1, 4},
    GlType{0x8B5A, Basic::float_, 2, 2},  GlType{0x8B5B, Basic::float_, 3, 3},
    GlType{0x8B5C, Basic::float_, 4, 4},  GlType{0x8B65, Basic::float_, 2, 3},
    GlType{0x8B66, Basic::float_, 2, 4},  GlType{0x8B67, Basic::float_, 3, 2},
    GlType{0x8B68, Basic::float_, 3, 4},  GlType{0x8B69, Basic::float_, 4, 2},
    GlType{0x8B6A, Basic::float_, 4, 3},  GlType{0x8F46, Basic::double_, 2, 2},
    GlType{0x8F47, Basic::double_, 3, 3}, GlType{0x8F48, Basic::double_, 4, 4},
    GlType{0x8F49, Basic::double_, 2, 3}, GlType{0x8F4A, Basic::double_, 2, 4},
    GlType{0x8F4B, Basic::double_, 3, 2}, GlType{0x8F4C, Basic::double_, 3, 4},
    GlType{0x8F4D, Basic::double_, 4, 2}, GlType{0x8F4E, Basic::double_, 4, 3},
    GlType{0x92DB, Basic::uint_, 1, 1},  // GL_UNSIGNED_INT_ATOMIC_COUNTER
};

const GlType* find(std::uint32_t gl_type) {
  const auto found =
      std::find_if(kTypes.begin(), kTypes.end(), [gl_type](const GlType& one) { return one.gl == gl_type; });
  return found == kTypes.end() ? nullptr : &*found;
}

frontend::Type typeOf(const GlType& gl) {
  frontend::Type type;
  type.basic = gl.basic;
  type.rows = gl.rows;
  type.columns = gl.columns;
  return type;
}

// In memory a vector's components lie side by side, and so do those of a matrix's columns, or of its rows.
// Nothing where the bytes end before the value does.
std::optional<instrumenter::Value> valueAt(const BlockMember& member, const GlType& type,
                                           const std::vector<std::byte>& bytes, std::uint64_t offset) {
  const std::uint64_t size = 4 * static_cast<std::uint64_t>(wordsPerComponent(type.basic));
  instrumenter::Value value{typeOf(type), {}};
  for (int column = 0; column < type.columns; ++column)
    for (int row = 0; row < type.rows; ++row) {
      const auto minor = static_cast<std::uint64_t>(member.row_major ? column : row);
      const auto major = static_cast<std::uint64_t>(member.row_major ? row : column);
      const std::uint64_t at = offset + (type.columns > 1 ? major * member.matrix_stride + minor * size
                                                          : static_cast<std::uint64_t>(row) * size);
      if (at > bytes.size() || size > bytes.size() - at) return std::nullopt;
      for (std::uint64_t word = 0; word < size / 4; ++word) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, bytes.data() + at + 4 * word, 4);
        value.words.push_back(bits);
      }
    }
  return value;
}

// Elements of an array that goes on as far as there is room for it.
std::uint64_t countOf(std::uint64_t told, std::uint64_t stride, std::uint64_t offset, std::uint64_t bytes) {
  if (told > 0) return told;
  return stride == 0 || offset >= bytes ? 0 : (bytes - offset) / stride;
}

// Where the array of structures begins that a member is in: with the first of those that are named after it.
std::uint64_t beginOf(const BoundBuffer& block, const BlockMember& member) {
  const std::string array = member.name.substr(0, member.name.find("[0]"));
  std::uint64_t begin = member.offset;
  for (const BlockMember& other : block.members)
    if (other.outer_stride == member.outer_stride && other.name.starts_with(array + "[0]"))
      begin = std::min(begin, other.offset);
  return begin;
}

// "items[0].pos" with the first index in place of the 0.
std::string withOuter(const std::string& name, std::uint64_t index) {
  const std::size_t open = name.find("[0]");
  return open == std::string::npos ? name
                                   : name.substr(0, open + 1) + std::to_string(index) + name.substr(open + 2);
}

std::string element(const std::string& name, std::uint64_t index) {
  const bool array = name.ends_with("[0]");
  return array ? name.substr(0, name.size() - 2) + std::to_string(index) + "]" : name;
}

double half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const double fraction = (bits & 1023) / 1024.0;
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31) return fraction != 0 ? std::nan("") : sign * HUGE_VAL;
  return exponent == 0 ? sign * std::ldexp(fraction, -14) : sign * std::ldexp(1 + fraction, exponent - 15);
}

template <class Number>
Number numberAt(const std::byte* at) {
  Number number;
  std::memcpy(&number, at, sizeof number);
  return number;
}

std::string floatText(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return formatComponent(Basic::float_, &bits);
}

template <class Whole>
std::string wholeText(const std::byte* at, bool normalized) {
  const Whole number = numberAt<Whole>(at);
  if (!normalized) return std::to_string(number);
  const double scaled = static_cast<double>(number) / static_cast<double>(std::numeric_limits<Whole>::max());
  return floatText(static_cast<float>(std::max(scaled, -1.0)));
}

std::string hexText(std::uint64_t number, int digits) {
  char text[24];
  std::snprintf(text, sizeof text, "%0*llx", digits, static_cast<unsigned long long>(number));
  return text;
}

}  // namespace

std::string typeName(std::uint32_t gl_type) {
  const GlType* type = find(gl_type);
  return type == nullptr ? std::string() : glslName(typeOf(*type));
}

BlockValues blockValues(const BoundBuffer& block, const std::vector<std::byte>& bytes, std::size_t most) {
  BlockValues values;
  for (const BlockMember& member : block.members) {
    const GlType* type = find(member.type);
    const std::uint64_t outer =
        countOf(member.outer_count, member.outer_stride, beginOf(block, member), bytes.size());
    for (std::uint64_t o = 0; o < outer; ++o) {
      if (values.members.size() >= most) {
        values.left_out += (outer - o) * std::max<std::uint64_t>(member.count, 1);
        break;
      }
      const std::uint64_t first = member.offset + o * member.outer_stride;
      const std::string name = member.outer_stride > 0 ? withOuter(member.name, o) : member.name;
      const std::uint64_t count = countOf(member.count, member.stride, first, bytes.size());
      for (std::uint64_t i = 0; i < count; ++i) {
        if (values.members.size() >= most) {
          values.left_out += count - i;
          break;
        }
        const std::uint64_t offset = first + i * member.stride;
        MemberValue one{element(name, i), typeName(member.type), offset, {}};
        const auto value = type == nullptr ? std::nullopt : valueAt(member, *type, bytes, offset);
        if (value) one.value = formatValue(*value);
        values.members.push_back(std::move(one));
      }
    }
  }
  std::stable_sort(values.members.begin(), values.members.end(),
                   [](const MemberValue& a, const MemberValue& b) { return a.offset < b.offset; });
  return values;
}

std::size_t ElementFormat::componentBytes() const {
  switch (kind) {
    case Kind::int8:
    case Kind::uint8:
    case Kind::hex8:
      return 1;
    case Kind::float16:
    case Kind::int16:
    case Kind::uint16:
      return 2;
    case Kind::float64:
    case Kind::int64:
    case Kind::uint64:
      return 8;
    default:
      return 4;
  }
}

std::uint64_t ElementFormat::count(std::uint64_t there) const {
  return there < bytes() ? 0 : (there - bytes()) / std::max<std::uint64_t>(step(), 1) + 1;
}

ElementFormat formatOf(const BoundBuffer& bound) {
  using Kind = ElementFormat::Kind;
  ElementFormat format;
  if (bound.use == BufferUse::commands) format.kind = Kind::uint32;
  const bool vertices = bound.use == BufferUse::vertices && bound.components != 0;
  if (!vertices && bound.use != BufferUse::indices) return format;
  constexpr std::pair<std::uint32_t, Kind> kKinds[] = {
      {0x1400, Kind::int8},    {0x1401, Kind::uint8},   {0x1402, Kind::int16},
      {0x1403, Kind::uint16},  {0x1404, Kind::int32},   {0x1405, Kind::uint32},
      {0x1406, Kind::float32}, {0x140A, Kind::float64}, {0x140B, Kind::float16}};
  format.kind = Kind::hex32;  // packed numbers
  format.components = 1;
  for (const auto& [gl_type, kind] : kKinds)
    if (gl_type == bound.type) format.kind = kind, format.components = std::clamp(bound.components, 1, 4);
  if (bound.components == 0x80E1) format.components = 4;  // GL_BGRA
  format.normalized = bound.normalized;
  format.stride = static_cast<std::uint64_t>(std::max(bound.stride, 0));
  return format;
}

std::string elementText(const ElementFormat& format, const std::vector<std::byte>& bytes,
                        std::uint64_t element, int component) {
  using Kind = ElementFormat::Kind;
  const std::uint64_t at =
      element * format.step() + static_cast<std::uint64_t>(component) * format.componentBytes();
  if (at > bytes.size() || format.componentBytes() > bytes.size() - at) return {};
  const std::byte* const from = bytes.data() + at;
  switch (format.kind) {
    case Kind::float16:
      return floatText(static_cast<float>(half(numberAt<std::uint16_t>(from))));
    case Kind::float32:
      return floatText(numberAt<float>(from));
    case Kind::float64: {
      const auto words = numberAt<std::array<std::uint32_t, 2>>(from);
      return formatComponent(Basic::double_, words.data());
    }
    case Kind::int8:
      return wholeText<std::int8_t>(from, format.normalized);
    case Kind::int16:
      return wholeText<std::int16_t>(from, format.normalized);
    case Kind::int32:
      return wholeText<std::int32_t>(from, format.normalized);
    case Kind::int64:
      return wholeText<std::int64_t>(from, false);
    case Kind::uint8:
      return wholeText<std::uint8_t>(from, format.normalized);
    case Kind::uint16:
      return wholeText<std::uint16_t>(from, format.normalized);
    case Kind::uint32:
      return wholeText<std::uint32_t>(from, format.normalized);
    case Kind::uint64:
      return wholeText<std::uint64_t>(from, false);
    case Kind::hex8:
      return hexText(numberAt<std::uint8_t>(from), 2);
    case Kind::hex32:
      return hexText(numberAt<std::uint32_t>(from), 8);
  }
  return {};
}

const char* useName(BufferUse use) {
  switch (use) {
    case BufferUse::uniform_block:
      return "uniform block";
    case BufferUse::storage_block:
      return "storage block";
    case BufferUse::atomic_counters:
      return "atomic counters";
    case BufferUse::vertices:
      return "vertex attribute";
    case BufferUse::indices:
      return "indices";
    case BufferUse::commands:
      return "indirect commands";
    case BufferUse::feedback:
      return "transform feedback";
  }
  return "";
}

namespace {

// A draw may write to the buffers that it reads: what stands before it must stand there behind a replay, too.
Check readAgain(Session& session, const BoundBuffer& bound, const std::vector<std::byte>& bytes) {
  Check check;
  try {
    ExecuteOptions options;
    options.compare = false;
    options.read_captures = false;
    session.execute(session.prepareOriginal(), options);
  } catch (const Error& error) {
    if (error.outcome() == Outcome::ended) throw;
    check.reason = error.what();
    return check;
  }
  const std::vector<std::byte> again = session.readBuffer(bound.buffer, bound.offset, bytes.size());
  check.compared_at_all = true;
  check.compared = bytes.size();
  for (std::size_t i = 0; i < bytes.size(); ++i) check.differing += bytes[i] != again[i] ? 1 : 0;
  return check;
}

}  // namespace

BufferContents bufferContents(Session& session, const BoundBuffer& bound) {
  BufferContents contents;
  contents.bytes =
      session.readBuffer(bound.buffer, bound.offset, std::min(bound.bytes, BufferContents::kMostBytes));
  contents.values = blockValues(bound, contents.bytes);
  contents.check = readAgain(session, bound, contents.bytes);
  return contents;
}

}  // namespace shadestep::session
