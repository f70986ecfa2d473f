// GLSL types as a debugger needs them: what a value is called, and how many 32-bit words it takes.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace shadestep::frontend {

enum class Basic { void_, bool_, int_, uint_, float_, double_, int64_, uint64_, struct_, opaque };

struct StructType;

// A GLSL type. Scalars have rows == 1 and columns == 1; vecN has rows == N; matCxR has columns == C, rows == R.
struct Type {
  Basic basic = Basic::void_;
  int rows = 1;
  int columns = 1;
  std::vector<int> array;                      // outermost dimension first; 0 = unsized
  std::shared_ptr<const StructType> members;   // for Basic::struct_
  std::string opaque_name;                     // for Basic::opaque: "sampler3D", "image2D", ...

  bool isScalar() const { return rows == 1 && columns == 1 && array.empty() && basic != Basic::struct_; }
  bool isVector() const { return rows > 1 && columns == 1 && array.empty(); }
  bool isMatrix() const { return columns > 1 && array.empty(); }
  bool isArray() const { return !array.empty(); }
  // The type of one element of an array (its outermost dimension taken off).
  Type element() const;
  bool operator==(const Type&) const;
};

struct Member {
  std::string name;
  Type type;
};

struct StructType {
  std::string name;
  std::vector<Member> members;
};

// The type as GLSL writes it: "vec4", "mat3x2", "float[3][2]", "Light".
std::string glslName(const Type&);

// Number of scalar components ("leaves"): vec4 = 4, mat2 = 4, float[3] = 3, a struct the sum of its members.
// 0 for what holds no value (opaque types, void, unsized arrays).
int componentCount(const Type&);

// One scalar component of a value: how GLSL reaches it from the value's own expression.
struct Component {
  std::string access;  // "", ".x", "[1].z" (column 1 of a matrix, third row), ".field[2]"
  Basic basic = Basic::float_;
};

// The components in canonical order: members in order, array elements in order, matrices column by column.
// Every layout of captured words follows this order; 64-bit components take two words, low word first.
std::vector<Component> components(const Type&);

// 32-bit words that a value of this type takes when captured.
int wordCount(const Type&);

}  // namespace shadestep::frontend
