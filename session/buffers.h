// What stands in the buffers that a draw reads: uniform and storage blocks member by member, as the driver
// laid them out, and any buffer's bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

const char* useName(BufferUse);  // "uniform block"

// One member of a block, or one element of an array in it.
struct MemberValue {
  std::string name;          // "light.colour", "weights[2]"
  std::string type;          // "vec3"
  std::uint64_t offset = 0;  // bytes from where the block begins
  std::string value;         // as values are written everywhere; empty where the buffer ends before it
};
// The members of a block, arrays element by element, in the order of their offsets; `bytes` is what stands in
// it. No more than `most`: `left_out` counts the others.
struct BlockValues {
  std::vector<MemberValue> members;
  std::uint64_t left_out = 0;
};
BlockValues blockValues(const BoundBuffer&, const std::vector<std::byte>& bytes, std::size_t most = 10'000);

// "vec3", "mat4x3"; empty for what is no value in memory. `gl_type`: GL_FLOAT_VEC3, ...
std::string typeName(std::uint32_t gl_type);

// How plain bytes are read: elements of `components` numbers, each `stride` bytes behind the one before.
struct ElementFormat {
  enum class Kind {
    float16,
    float32,
    float64,
    int8,
    int16,
    int32,
    int64,
    uint8,
    uint16,
    uint32,
    uint64,
    hex8,
    hex32,
  };
  Kind kind = Kind::float32;
  int components = 1;
  std::uint64_t stride = 0;  // 0: without gaps
  bool normalized = false;   // whole numbers stand for 0..1, or -1..1

  std::size_t componentBytes() const;
  std::size_t bytes() const { return componentBytes() * static_cast<std::size_t>(components); }
  std::uint64_t step() const { return stride == 0 ? bytes() : stride; }
  // Elements that are whole.
  std::uint64_t count(std::uint64_t bytes) const;
};
// How a vertex attribute or an indexed draw reads its buffer; floats for all others.
ElementFormat formatOf(const BoundBuffer&);
// A component of an element; empty where there is none.
std::string elementText(const ElementFormat&, const std::vector<std::byte>&, std::uint64_t element,
                        int component);

// What stands in a buffer at the draw. It takes a replay: what the draw itself changes, `check` counts, in
// bytes.
struct BufferContents {
  static constexpr std::uint64_t kMostBytes = 64ULL << 20;  // more of a buffer is not read

  std::vector<std::byte> bytes;
  BlockValues values;  // of a block
  Check check;
};
BufferContents bufferContents(Session&, const BoundBuffer&);

}  // namespace shadestep::session
