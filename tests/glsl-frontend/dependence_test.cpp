// Which variables may hold something that was computed from others.
#include "glsl-frontend/dependence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::UnorderedElementsAre;

std::vector<std::string> dependents(const std::string& text, const std::string& source) {
  const Shader shader =
      analysed("#version 330\nout vec4 color;\nuniform float u;\nuniform bool on;\n" + text);
  std::vector<VariableId> sources;
  for (std::size_t i = 0; i < shader.variables.size(); ++i)
    if (shader.variables[i].name == source) sources.push_back(static_cast<VariableId>(i));
  return names(shader, mayDependOn(shader, sources));
}

TEST(Dependence, FollowsAssignments) {
  EXPECT_THAT(
      dependents(
          "void main() { float a = u, b = a * 2.0, c = 1.0; vec2 d; d.x = b; c += 1.0; color = vec4(c); }",
          "u"),
      UnorderedElementsAre("a", "b", "d"));
}

TEST(Dependence, MembersAndInnerVariablesOfTheNameAreOthers) {
  EXPECT_THAT(
      dependents(
          "struct S { bool on; }; bool same(bool on) { return on; } void main() { S s = S(true); bool a = "
          "s.on, b = same(true); color = vec4(a); }",
          "u"),
      testing::IsEmpty());
}

TEST(Dependence, FollowsConditionsAndJumps) {
  EXPECT_THAT(dependents("void main() { int a = 0, b = 0, c = 0, d = 0; if (on) a = 1; else b = 1; "
                         "for (int i = 0; i < 3; ++i) { if (a == 1) break; c++; } d++; color = vec4(1.0); }",
                         "on"),
              UnorderedElementsAre("a", "b", "c", "i"));
}

TEST(Dependence, FollowsCalls) {
  EXPECT_THAT(
      dependents(
          "float g = 0.0, h = 0.0; float twice(float x) { g = 1.0; return 2.0 * x; } float same(float y) { "
          "return y; } void set(out float z) { z = u; } void main() { float a = twice(u); float b = "
          "same(1.0), c; "
          "set(c); if (on) h = 1.0; color = vec4(b); }",
          "u"),
      UnorderedElementsAre("x", "a", "c", "z", "g"))
      << "g: by a call in a statement that depends on u";
  EXPECT_THAT(
      dependents("float g = 0.0; bool next() { g += 1.0; return true; } void main() { bool a = on && next(); "
                 "bool b = next(); color = vec4(g); }",
                 "on"),
      UnorderedElementsAre("g", "a", "b"))
      << "whether a call runs";
}

}  // namespace
}  // namespace shadestep::frontend
