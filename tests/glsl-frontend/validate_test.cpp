// The validator itself must be able to complain.
#include "glsl-frontend/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::Contains;
using testing::HasSubstr;

Shader sample() {
  return analysed(
      "float f(float a) { return a; }\nvoid main() {\n for (int i = 0; i < 2; ++i) { float x = f(1.0), y; x "
      "+= 1.0; }\n"
      " if (true) ; else gl_FragColor = vec4(0.0);\n}\n");
}

Statement& mutableStatement(Shader& shader, const std::string& start) {
  return shader.statements[static_cast<std::size_t>(find(shader, start))];
}

void expectComplaint(const std::string& complaint, const std::function<void(Shader&)>& breakIt) {
  Shader shader = sample();
  breakIt(shader);
  EXPECT_THAT(violations(shader), Contains(HasSubstr(complaint)));
}

TEST(Validator, FindsEachBrokenInvariant) {
  expectComplaint("is outside of its parent",
                  [](Shader& s) { mutableStatement(s, "x +=").tokens.last += 4; });
  expectComplaint("has a wrong place", [](Shader& s) { mutableStatement(s, "x +=").place.line++; });
  expectComplaint("has a wrong parent", [](Shader& s) { mutableStatement(s, "x +=").parent = 99; });
  expectComplaint("has a child with another parent",
                  [](Shader& s) { mutableStatement(s, "x +=").parent = 0; });
  expectComplaint("children overlap", [](Shader& s) {
    std::vector<StatementId>& children = mutableStatement(s, "if").children;
    std::swap(children[0], children[1]);
  });
  expectComplaint("expression is outside",
                  [](Shader& s) { mutableStatement(s, "for").expression.first = 0; });
  expectComplaint("declarators overlap", [](Shader& s) {
    std::vector<Declarator>& declarators = mutableStatement(s, "float x").declarators;
    std::swap(declarators[0], declarators[1]);
  });
  expectComplaint("and its calls disagree", [](Shader& s) { s.calls[0].statement = 0; });
  expectComplaint("sees two variables", [](Shader& s) {
    std::vector<VariableId> scope = mutableStatement(s, "x +=").scope;
    scope.push_back(scope.back());
    mutableStatement(s, "x +=").scope = scope;
  });
  expectComplaint("before it is declared", [](Shader& s) {
    const VariableId x = mutableStatement(s, "float x").declarators[0].variable;
    std::vector<VariableId> scope = mutableStatement(s, "float x").scope;
    scope.push_back(x);
    mutableStatement(s, "float x").scope = scope;
  });
  expectComplaint("holds no value", [](Shader& s) {
    s.variables[static_cast<std::size_t>(mutableStatement(s, "x +=").scope.back())].type = Type();
  });
  expectComplaint("is not declared where it says", [](Shader& s) {
    s.variables[static_cast<std::size_t>(mutableStatement(s, "x +=").scope.back())].declared = 0;
  });
  expectComplaint("is opaque without a reason", [](Shader& s) { mutableStatement(s, "x +=").reason = "r"; });
  expectComplaint("without one body", [](Shader& s) { mutableStatement(s, "for").children.clear(); });
  expectComplaint("arguments are not in order", [](Shader& s) { s.calls[0].arguments[0].first = 0; });
  expectComplaint("not as many arguments", [](Shader& s) { s.calls[0].arguments.clear(); });
  expectComplaint("and its body disagree", [](Shader& s) { s.functions[0].body = s.functions[1].body; });
  expectComplaint("has other tokens", [](Shader& s) { s.tokens[3].text += " x"; });
}

}  // namespace
}  // namespace shadestep::frontend
