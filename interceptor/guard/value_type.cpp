#include "interceptor/guard/value_type.h"

#include <algorithm>
#include <array>

#include "interceptor/registry/gl_enums.h"

namespace shadestep::guard {
namespace {

constexpr std::array kTypes = {
    ValueType{GL_FLOAT, Scalar::float_, 1, 1},
    ValueType{GL_FLOAT_VEC2, Scalar::float_, 2, 1},
    ValueType{GL_FLOAT_VEC3, Scalar::float_, 3, 1},
    ValueType{GL_FLOAT_VEC4, Scalar::float_, 4, 1},
    ValueType{GL_INT, Scalar::int_, 1, 1},
    ValueType{GL_INT_VEC2, Scalar::int_, 2, 1},
    ValueType{GL_INT_VEC3, Scalar::int_, 3, 1},
    ValueType{GL_INT_VEC4, Scalar::int_, 4, 1},
    ValueType{GL_UNSIGNED_INT, Scalar::uint_, 1, 1},
    ValueType{GL_UNSIGNED_INT_VEC2, Scalar::uint_, 2, 1},
    ValueType{GL_UNSIGNED_INT_VEC3, Scalar::uint_, 3, 1},
    ValueType{GL_UNSIGNED_INT_VEC4, Scalar::uint_, 4, 1},
    ValueType{GL_BOOL, Scalar::int_, 1, 1},
    ValueType{GL_BOOL_VEC2, Scalar::int_, 2, 1},
    ValueType{GL_BOOL_VEC3, Scalar::int_, 3, 1},
    ValueType{GL_BOOL_VEC4, Scalar::int_, 4, 1},
    ValueType{GL_DOUBLE, Scalar::double_, 1, 1},
    ValueType{GL_DOUBLE_VEC2, Scalar::double_, 2, 1},
    ValueType{GL_DOUBLE_VEC3, Scalar::double_, 3, 1},
    ValueType{GL_DOUBLE_VEC4, Scalar::double_, 4, 1},
    ValueType{GL_FLOAT_MAT2, Scalar::float_, 2, 2},
    ValueType{GL_FLOAT_MAT3, Scalar::float_, 3, 3},
    ValueType{GL_FLOAT_MAT4, Scalar::float_, 4, 4},
    ValueType{GL_FLOAT_MAT2x3, Scalar::float_, 3, 2},
    ValueType{GL_FLOAT_MAT2x4, Scalar::float_, 4, 2},
    ValueType{GL_FLOAT_MAT3x2, Scalar::float_, 2, 3},
    ValueType{GL_FLOAT_MAT3x4, Scalar::float_, 4, 3},
    ValueType{GL_FLOAT_MAT4x2, Scalar::float_, 2, 4},
    ValueType{GL_FLOAT_MAT4x3, Scalar::float_, 3, 4},
    ValueType{GL_DOUBLE_MAT2, Scalar::double_, 2, 2},
    ValueType{GL_DOUBLE_MAT3, Scalar::double_, 3, 3},
    ValueType{GL_DOUBLE_MAT4, Scalar::double_, 4, 4},
    ValueType{GL_DOUBLE_MAT2x3, Scalar::double_, 3, 2},
    ValueType{GL_DOUBLE_MAT2x4, Scalar::double_, 4, 2},
    ValueType{GL_DOUBLE_MAT3x2, Scalar::double_, 2, 3},
    ValueType{GL_DOUBLE_MAT3x4, Scalar::double_, 4, 3},
    ValueType{GL_DOUBLE_MAT4x2, Scalar::double_, 2, 4},
    ValueType{GL_DOUBLE_MAT4x3, Scalar::double_, 3, 4},
    ValueType{GL_INT64_ARB, Scalar::int64_, 1, 1},
    ValueType{GL_INT64_VEC2_ARB, Scalar::int64_, 2, 1},
    ValueType{GL_INT64_VEC3_ARB, Scalar::int64_, 3, 1},
    ValueType{GL_INT64_VEC4_ARB, Scalar::int64_, 4, 1},
    ValueType{GL_UNSIGNED_INT64_ARB, Scalar::uint64_, 1, 1},
    ValueType{GL_UNSIGNED_INT64_VEC2_ARB, Scalar::uint64_, 2, 1},
    ValueType{GL_UNSIGNED_INT64_VEC3_ARB, Scalar::uint64_, 3, 1},
    ValueType{GL_UNSIGNED_INT64_VEC4_ARB, Scalar::uint64_, 4, 1},
};

}  // namespace

const ValueType* valueType(GLenum type) {
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const ValueType& known) { return known.type == type; });
  return found != kTypes.end() ? &*found : nullptr;
}

}  // namespace shadestep::guard
