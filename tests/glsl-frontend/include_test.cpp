// #include of named strings (GL_ARB_shading_language_include).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shader_text.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Preprocessed included(const std::string& text, const Includes& includes) {
  return preprocess({text}, {}, 1, includes);
}

std::string textOf(const Preprocessed& result) {
  if (!result.error.empty()) return "error: " + result.error;
  std::string text;
  for (const Token& token : result.tokens) text += (text.empty() ? "" : " ") + token.text;
  return text;
}

std::string processed(const std::string& text, const Includes& includes) {
  return textOf(included(text, includes));
}

TEST(Include, PutsAStringInItsPlaceWithLinesOfItsOwn) {
  const Preprocessed result = included("a\n  #include \"/lib/x\" // why\nb __LINE__\n",
                                       {{{"/lib/x", "// x\n x1 __LINE__\nx2"}, {"/other", "no"}}, {}});
  EXPECT_EQ(textOf(result), "a x1 2 x2 b 3");
  EXPECT_THAT(result.lines,
              ElementsAre("a", "  #include \"/lib/x\" // why", "b __LINE__", "// x", " x1 __LINE__", "x2"));
  EXPECT_THAT(result.included, ElementsAre(IncludedString{4, "/lib/x"}));
  EXPECT_EQ(result.tokens.at(1).place, (Place{5, 2}));
  EXPECT_EQ(result.tokens.at(4).place, (Place{3, 1}));
}

TEST(Include, SharesMacrosBothWays) {
  const Includes includes{{{"/a", "#ifdef ON\n#define N (M + 1)\n#undef GONE\n#endif\n"}}, {}};
  EXPECT_EQ(processed("#define ON\n#define M 2\n#define GONE 5\n#include </a>\nN GONE", includes),
            "( 2 + 1 ) GONE");
  EXPECT_EQ(processed("#if 0\n#include \"/nowhere\"\n#endif\nx", includes), "x");
}

TEST(Include, ShowsAStringAgainOnlyIfItBringsTokensAgain) {
  const Preprocessed guarded =
      included("#include \"/g\"\n#include \"/g\"\nb", {{{"/g", "#ifndef G\n#define G\ng\n#endif\n"}}, {}});
  EXPECT_EQ(textOf(guarded), "g b");
  EXPECT_THAT(guarded.included, ElementsAre(IncludedString{4, "/g"}));
  EXPECT_EQ(guarded.lines.size(), 7U);

  const Preprocessed listed =
      included("#define X(n) a##n\n#include \"/l\"\n#undef X\n#define X(n) b##n\n#include \"/l\"\n",
               {{{"/l", "X(1)\nX(2)\n"}}, {}});
  EXPECT_EQ(textOf(listed), "a1 a2 b1 b2");
  EXPECT_THAT(listed.included, ElementsAre(IncludedString{6, "/l"}, IncludedString{8, "/l"}));
  EXPECT_EQ(listed.tokens.at(3).place, (Place{9, 1}));
}

TEST(Include, WalksTheTree) {
  const Includes includes{{{"/a/b", "ab"}, {"/a", "a"}, {"/x/./../a/c", "ac"}, {"/../up", "up"}}, {}};
  EXPECT_EQ(processed("#include \"/a/b\"", includes), "ab");
  EXPECT_EQ(processed("#include \"/a/./c\"", includes), "ac");
  EXPECT_EQ(processed("#include \"/a/b/../../a\"", includes), "a");
  EXPECT_EQ(processed("#include \"/up\"", includes), "up");
  EXPECT_EQ(processed("\n#include \"/no\"", includes),
            "error: line 2: #include: there was no named string '/no' when the shader was compiled");
  EXPECT_THAT(processed("#include \"b\"", includes), HasSubstr("no named string 'b'"));
  EXPECT_EQ(processed("#include \"/s\"", {{{"/s", "old"}, {"/./s", "new"}}, {}}), "new");
}

TEST(Include, SearchesThePathsOfTheCompilationInTheirOrder) {
  const Includes includes{{{"/one/x", "x1"}, {"/two/x", "x2"}, {"/two/y", "y2"}, {"/z", "z"}},
                          {"/none", "/one", "/two", "/"}};
  EXPECT_EQ(processed("#include <x>\n#include \"y\"\n#include <z>", includes), "x1 y2 z");
}

// Mesa starts at the search point that the string that includes was found from.
TEST(Include, SearchesAQuotedPathFirstWhereTheIncluderWasFound) {
  const Includes includes{
      {{"/one/x", "x1"}, {"/two/x", "x2"}, {"/two/q", "#include \"x\"\n"}, {"/two/b", "#include <x>\n"}},
      {"/one", "/two"}};
  EXPECT_EQ(processed("#include \"q\"\n#include \"b\"\n#include \"x\"\n", includes), "x2 x1 x1");
}

TEST(Include, TakesAStringBesideTheIncluderUnlessAnotherIsMeant) {
  EXPECT_EQ(processed("#include \"/lib/a\"", {{{"/lib/a", "#include \"b\"\n"}, {"/lib/b", "b"}}, {}}), "b");
  EXPECT_THAT(
      processed("#include \"/lib/a\"",
                {{{"/lib/a", "\n#include \"b\"\n"}, {"/lib/b", "b"}, {"/s/b", "other"}}, {"/s"}}),
      HasSubstr("error: line 2 of the included string /lib/a: #include: 'b' may mean /s/b or /lib/b"));
  EXPECT_EQ(processed("#include \"/lib/a\"",
                      {{{"/lib/a", "\n#include \"b\"\n"}, {"/lib/b", "b"}, {"/s/b", "b"}}, {"/s"}}),
            "b");
}

TEST(Include, RefusesWhatDoesNotCloseOrEnd) {
  const auto once = [](const std::string& text) {
    return processed("#if 1\n#include \"/a\"\n#endif\n", {{{"/a", text}}, {}});
  };
  EXPECT_EQ(once("\n#if 1\n"), "error: line 2 of the included string /a: this conditional has no #endif");
  EXPECT_EQ(once("#endif\n"), "error: line 1 of the included string /a: #endif without #if");
  EXPECT_EQ(once("#else\n"), "error: line 1 of the included string /a: #else without #if");
  EXPECT_EQ(once("a /* b"), "error: line 1 of the included string /a: this comment is not closed");
  EXPECT_THAT(once("#include \"/a\"\n"), HasSubstr("include each other without end"));
  EXPECT_THAT(processed("#include /a\n", {}), HasSubstr("needs the form"));
  EXPECT_THAT(processed("#include\n", {}), HasSubstr("needs the form"));
  EXPECT_THAT(processed("#include \"/a\n", {}), HasSubstr("needs the form"));
}

TEST(Include, IsPartOfAnAnalysedStageOfSeveralObjects) {
  const Includes includes{{{"/half", "float half_of(float x) {\n  return 0.5 * x;\n}\n"}}, {}};
  const std::string extension = "#extension GL_ARB_shading_language_include : require\n";
  const Analysis analysis =
      analyseLinked(Stage::fragment,
                    {{{extension + "float g(float x);\n#include \"/half\"\nvoid main() {\n gl_FragColor = "
                                   "vec4(half_of(g(1.0)));\n}\n"},
                      includes},
                     {{"float g(float x) {\n return x;\n}\n"}, {}}},
                    {});
  ASSERT_TRUE(analysis.shader) << analysis.error;
  const Shader& shader = *analysis.shader;
  EXPECT_THAT(violations(shader), IsEmpty());
  EXPECT_THAT(shader.object_lines, ElementsAre(1, 10));
  EXPECT_THAT(shader.included, ElementsAre(IncludedString{7, "/half"}));
  EXPECT_EQ(statement(shader, "return 0.5").place, (Place{8, 3}));
  EXPECT_EQ(statement(shader, "return x").place, (Place{11, 2}));
  EXPECT_EQ(shader.lines.at(7), "  return 0.5 * x;");
}

}  // namespace
}  // namespace shadestep::frontend
