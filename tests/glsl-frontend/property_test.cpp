// Properties over many generated texts: what goes in comes out again.
#include <gtest/gtest.h>

#include <random>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  template <class Container>
  auto pick(const Container& container) {
    return *(std::begin(container) + below(static_cast<int>(std::size(container))));
  }

 private:
  std::mt19937 engine_;
};

TEST(RoundTrip, EmittedTokensAreReadAgainAsTheyWere) {
  const std::vector<std::string> words = {
      "a",   "x1", "_b", "1", "2.5", ".5", "1e-3", "0x1F", "3u", "1.0lf", "+",  "++", "-",   "--", "<", "<<",
      "<<=", "=",  "==", "!", "!=",  "&",  "&&",   "|",    "||", "^",     "^^", "(",  ")",   "[",  "]", "{",
      "}",   ".",  ",",  ";", "?",   ":",  "*",    "/",    "%",  "~",     ">",  ">=", ">>=", "/=", "*="};
  for (unsigned seed = 0; seed < 300; ++seed) {
    Random random(seed);
    std::string source;
    for (int i = 0; i < 60; ++i) {
      source += random.pick(words);
      source += random.pick(std::vector<std::string>{" ", "\n", " /* c */ ", "\t", " // c\n", "\\\n "});
    }
    const Preprocessed first = preprocess({source}, {});
    ASSERT_EQ(first.error, "") << source;
    const Preprocessed second = preprocess({emit(first.tokens)}, {});
    ASSERT_EQ(second.tokens.size(), first.tokens.size()) << source;
    for (std::size_t i = 0; i < first.tokens.size(); ++i) {
      ASSERT_EQ(second.tokens[i].text, first.tokens[i].text) << source;
      ASSERT_EQ(second.tokens[i].kind, first.tokens[i].kind) << source;
    }
  }
}

// A random body together with the statement tree that it must have.
class Program {
 public:
  explicit Program(unsigned seed) : random_(seed) {}

  std::pair<std::string, std::string> body(int depth) {
    std::string source, expected;
    for (int i = 1 + random_.below(4); i > 0; --i) {
      const auto [text, node] = statement(depth);
      source += text + (random_.below(2) ? "\n" : " ");
      expected += (expected.empty() ? "" : " ") + node;
    }
    return {source, expected};
  }

 private:
  std::pair<std::string, std::string> block(int depth) {
    const auto [source, expected] = body(depth - 1);
    return {"{ " + source + "}", "block(" + expected + ")"};
  }

  std::pair<std::string, std::string> nested(int depth) {
    return random_.below(2) ? block(depth) : statement(depth - 1);
  }

  std::pair<std::string, std::string> statement(int depth) {
    switch (depth > 0 ? random_.below(9) : random_.below(4)) {
      case 0:
        return {"x += 1.0;", "expression"};
      case 1: {
        const std::string number = std::to_string(++names_);
        return {"float y" + number + " = x, z" + number + ";", "declaration"};
      }
      case 2:
        return {";", "expression"};
      case 3:
        return {"x = f(x);", "expression"};
      case 4:
        return block(depth);
      case 5: {
        // Braces, so that an `else` belongs to this `if`.
        const auto [then, then_node] = block(depth);
        if (random_.below(2)) return {"if (x > 1.0) " + then, "if(" + then_node + ")"};
        const auto [other, other_node] = nested(depth);
        return {"if (x > 1.0) " + then + " else " + other, "if(" + then_node + " " + other_node + ")"};
      }
      case 6: {
        const auto [inner, node] = nested(depth);
        return {"for (int i = 0; i < 2; ++i) " + inner, "for(declaration " + node + ")"};
      }
      case 7: {
        const auto [inner, node] = nested(depth);
        return {"while (bool again = x < 1.0) " + inner, "while(" + node + ")"};
      }
      default: {
        const auto [inner, node] = nested(depth);
        return {"do " + inner + " while (x < 1.0);", "do(" + node + ")"};
      }
    }
  }

  Random random_;
  int names_ = 0;
};

TEST(StatementTrees, OfGeneratedProgramsAreTheOnesGenerated) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const auto [source, expected] = Program(seed).body(4);
    const Shader shader = analysed("float f(float a) { return a; }\nvoid main() { float x = 0.0; " + source +
                                   "\ngl_FragColor = vec4(x); }\n");
    ASSERT_NE(shader.main, kNone) << source;
    ASSERT_EQ(tree(shader, mainOf(shader).body), "block(declaration " + expected + " expression)") << source;
  }
}

TEST(Size, TenThousandStatementsAreAnalysed) {
  std::string source = "void main() {\n float x = 0.0;\n";
  for (int i = 0; i < 10000; ++i) source += " x += " + std::to_string(i) + ".0;\n";
  const Shader shader = analysed(source + " gl_FragColor = vec4(x);\n}\n");
  EXPECT_EQ(shader.statements.size(), 10003u);
}

TEST(Size, TenThousandVariablesInOneScopeAreAnalysed) {
  std::string source = "void main() {\n float y0 = 0.0;\n";
  for (int i = 1; i < 10000; ++i)
    source += " float y" + std::to_string(i) + " = y" + std::to_string(i - 1) + ";\n";
  const Analysis analysis = analyse(Stage::fragment, {source + " gl_FragColor = vec4(y9999);\n}\n"}, {});
  ASSERT_TRUE(analysis.shader) << analysis.error;
  EXPECT_EQ(statement(*analysis.shader, "float y5000").scope.size(), 5001u);  // with gl_FragColor
  EXPECT_EQ(statement(*analysis.shader, "gl_FragColor").scope.size(), 10001u);
}

TEST(Size, DeepNestingIsAnalysed) {
  std::string source = "void main() { float x = 0.0; ";
  for (int i = 0; i < 150; ++i) source += "if (x < 1.0) { ";
  source += "x = ";
  for (int i = 0; i < 150; ++i) source += "(";
  source += "1.0";
  for (int i = 0; i < 150; ++i) source += " + x)";
  source += ";";
  for (int i = 0; i < 150; ++i) source += " }";
  const Shader shader = analysed(source + " gl_FragColor = vec4(x); }");
  EXPECT_EQ(shader.statements.size(), 304u);
}

}  // namespace
}  // namespace shadestep::frontend
