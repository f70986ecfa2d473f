#include "glsl-frontend/types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;

Type vec(int rows, Basic basic = Basic::float_) {
  Type type;
  type.basic = basic;
  type.rows = rows;
  return type;
}

Type mat(int columns, int rows, Basic basic = Basic::float_) {
  Type type = vec(rows, basic);
  type.columns = columns;
  return type;
}

Type arrayOf(Type type, std::vector<int> sizes) {
  type.array = std::move(sizes);
  return type;
}

Type light() {
  auto members = std::make_shared<StructType>();
  members->name = "Light";
  members->members = {{"position", vec(2)}, {"on", vec(1, Basic::bool_)}, {"power", arrayOf(vec(1), {2})}};
  Type type;
  type.basic = Basic::struct_;
  type.members = members;
  return type;
}

std::vector<std::string> accesses(const Type& type) {
  std::vector<std::string> result;
  for (const Component& component : components(type)) result.push_back(component.access);
  return result;
}

TEST(Types, AreNamedAsGlslWritesThem) {
  EXPECT_EQ(glslName(vec(1)), "float");
  EXPECT_EQ(glslName(vec(4)), "vec4");
  EXPECT_EQ(glslName(vec(3, Basic::int_)), "ivec3");
  EXPECT_EQ(glslName(vec(2, Basic::uint_)), "uvec2");
  EXPECT_EQ(glslName(vec(2, Basic::bool_)), "bvec2");
  EXPECT_EQ(glslName(vec(2, Basic::double_)), "dvec2");
  EXPECT_EQ(glslName(vec(1, Basic::uint64_)), "uint64_t");
  EXPECT_EQ(glslName(mat(3, 3)), "mat3");
  EXPECT_EQ(glslName(mat(3, 2)), "mat3x2");
  EXPECT_EQ(glslName(mat(2, 4, Basic::double_)), "dmat2x4");
  EXPECT_EQ(glslName(arrayOf(vec(1), {3, 2})), "float[3][2]");
  EXPECT_EQ(glslName(arrayOf(vec(1), {0})), "float[]");
  EXPECT_EQ(glslName(light()), "Light");
}

TEST(Types, ComponentsFollowTheCanonicalOrder) {
  EXPECT_THAT(accesses(vec(1)), ElementsAre(""));
  EXPECT_THAT(accesses(vec(3)), ElementsAre(".x", ".y", ".z"));
  EXPECT_THAT(accesses(mat(2, 3)), ElementsAre("[0].x", "[0].y", "[0].z", "[1].x", "[1].y", "[1].z"));
  EXPECT_THAT(accesses(arrayOf(vec(1), {2, 2})), ElementsAre("[0][0]", "[0][1]", "[1][0]", "[1][1]"));
  EXPECT_THAT(accesses(light()), ElementsAre(".position.x", ".position.y", ".on", ".power[0]", ".power[1]"));
  EXPECT_EQ(components(light())[2].basic, Basic::bool_);
}

TEST(Types, CountComponentsAndWords) {
  for (const Type& type : {vec(1), vec(4), mat(4, 3), arrayOf(light(), {3, 2}), arrayOf(mat(2, 2), {5})}) {
    EXPECT_EQ(componentCount(type), static_cast<int>(components(type).size())) << glslName(type);
    EXPECT_EQ(wordCount(type), componentCount(type)) << glslName(type);
  }
  EXPECT_EQ(componentCount(mat(2, 3, Basic::double_)), 6);
  EXPECT_EQ(wordCount(mat(2, 3, Basic::double_)), 12);
  EXPECT_EQ(wordCount(vec(2, Basic::int64_)), 4);
}

TEST(Types, WhatHoldsNoValueHasNoComponents) {
  Type sampler;
  sampler.basic = Basic::opaque;
  sampler.opaque_name = "sampler3D";
  EXPECT_EQ(componentCount(sampler), 0);
  EXPECT_EQ(glslName(sampler), "sampler3D");
  EXPECT_EQ(componentCount(Type()), 0);
  EXPECT_EQ(componentCount(arrayOf(vec(4), {0})), 0);
  EXPECT_TRUE(components(arrayOf(vec(4), {0})).empty());
}

TEST(Types, ElementTakesTheOutermostDimensionOff) {
  EXPECT_EQ(arrayOf(vec(1), {3, 2}).element(), arrayOf(vec(1), {2}));
  EXPECT_EQ(arrayOf(vec(1), {3}).element(), vec(1));
}

TEST(Types, StructsAreEqualByNameAndMembers) {
  EXPECT_EQ(light(), light());
  auto other = std::make_shared<StructType>(*light().members);
  other->members[0].type = vec(3);
  Type changed = light();
  changed.members = other;
  EXPECT_FALSE(changed == light());
}

}  // namespace
}  // namespace shadestep::frontend
