// The compiler itself says whether a scope list is right: each variable of it, read before its statement,
// must compile and have the type that the list says.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "permutation.h"
#include "shader_text.h"

namespace shadestep::frontend {
namespace {

const char* scalar(Basic basic) {
  switch (basic) {
    case Basic::bool_:
      return "bool";
    case Basic::int_:
      return "int";
    case Basic::uint_:
      return "uint";
    case Basic::double_:
      return "double";
    default:
      return "float";
  }
}

// { float r0 = a.x; bool r1 = b[0]; } for the last component of each variable in scope.
std::string reads(const Shader& shader, const Statement& statement) {
  std::string result = "{ ";
  int number = 0;
  for (VariableId id : statement.scope) {
    const Variable& read = variable(shader, id);
    const Component last = components(read.type).back();
    result += std::string(scalar(last.basic)) + " read" + std::to_string(number++) + " = " + read.name +
              last.access + "; ";
  }
  return result + "} ";
}

// The shader with reads before each statement that stands in a block.
std::string readEverywhere(const Shader& shader) {
  std::vector<std::string> before(shader.tokens.size());
  for (const Statement& statement : shader.statements) {
    if (statement.parent == kNone) continue;
    const StatementKind parent = shader.statements[static_cast<std::size_t>(statement.parent)].kind;
    if (parent == StatementKind::block)
      before[static_cast<std::size_t>(statement.tokens.first)] = reads(shader, statement);
  }
  std::string result;
  for (std::size_t i = 0; i < shader.tokens.size(); ++i) {
    const bool directive = shader.tokens[i].kind == TokenKind::directive;
    result += before[i] + shader.tokens[i].text + (directive ? "\n" : " ");
  }
  return result;
}

void expectReadable(const Shader& shader) {
  const std::string source = readEverywhere(shader);
  EXPECT_EQ(analyse(shader.stage, {source}, {}).error, "") << source;
}

TEST(Scopes, AreVisibleAndOfTheirTypeInTheCorpus) {
  int shaders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SHADER_FOLDER)) {
    if (entry.path().extension() != ".frag") continue;
    std::ifstream file(entry.path());
    std::stringstream source;
    source << file.rdbuf();
    expectReadable(analysed(source.str()));
    ++shaders;
  }
  for (const auto glsl : {raycaster::Glsl::v120, raycaster::Glsl::v330}) {
    expectReadable(analysed(raycaster::shaderText(raycaster::Permutation{.glsl = glsl}).fragment));
    ++shaders;
  }
  EXPECT_GE(shaders, 8);
}

TEST(Scopes, AreVisibleWhereNamesHideEachOther) {
  expectReadable(analysed(
      "#version 330\nint a; bool b; struct c { vec2 v; }; uniform mat3 d; out vec4 o; const float k = 1.0;\n"
      "float f(float a, inout bool d) { d = a > k; { vec3 a = vec3(b); float k = a.x; a.x = k; } return a; "
      "}\n"
      "void main() {\n"
      "  bool t = false; float b = f(float(a), t); ivec2 d = ivec2(int(b));\n"
      "  for (float a = 0.0; a < 2.0; ++a) { uint b = uint(a); for (bool a = true; a; a = false) { o.x = "
      "float(b); } }\n"
      "  while (bool o2 = a > 3) { bool t = o2; b += 1.0; }\n"
      "  o.zw = vec2(d);\n"
      "}\n"));
}

TEST(Scopes, ATypesNameHidesAVariable) {
  expectReadable(
      analysedMain("gl_FragColor = vec4(a, b);\n { struct a { float m; }; a b; b.m = 1.0; gl_FragColor.x = "
                   "b.m; }\n gl_FragColor.y = b;",
                   "#version 120\nvec3 a; float b;\n"));
}

TEST(Scopes, ABuiltInThatIsDeclaredAgainIsVisibleBehindThat) {
  const Shader shader = analysed(
      "#version 150\nfloat f() { return 1.0; }\nlayout(origin_upper_left) in vec4 gl_FragCoord;\n"
      "out vec4 color;\nvoid main() { color = gl_FragCoord * f(); }\n");
  expectReadable(shader);
  const auto sees = [&](int line) {
    const Scope& scope =
        shader.statements[static_cast<std::size_t>(statementsAt(shader, line).front())].scope;
    return std::any_of(scope.begin(), scope.end(),
                       [&](VariableId id) { return variable(shader, id).name == "gl_FragCoord"; });
  };
  EXPECT_FALSE(sees(2));
  EXPECT_TRUE(sees(5));
}

}  // namespace
}  // namespace shadestep::frontend
