#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "glsl-frontend/tokens.h"

namespace shadestep::frontend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> texts(const Preprocessed& result) {
  std::vector<std::string> all;
  for (const Token& token : result.tokens) all.push_back(token.text);
  return all;
}

// The tokens, separated by blanks; or the error.
std::string processed(const std::string& text, const PreprocessorFacts& facts = {}) {
  const Preprocessed result = preprocess({text}, facts);
  if (!result.error.empty()) return "error: " + result.error;
  std::string joined;
  for (const std::string& token : texts(result)) joined += (joined.empty() ? "" : " ") + token;
  return joined;
}

Token tokenNamed(const Preprocessed& result, const std::string& text) {
  for (const Token& token : result.tokens) {
    if (token.text == text) return token;
  }
  ADD_FAILURE() << "no token " << text;
  return {};
}

TEST(Preprocess, CutsTokensByTheLongestMatch) {
  EXPECT_EQ(processed("a+++b<<=c>>d^^e&&f||g"), "a ++ + b <<= c >> d ^^ e && f || g");
  EXPECT_EQ(processed("1.0e-3f .5 0x1Fu 1. 1.5lf a.x v[1].y 2e+4"),
            "1.0e-3f .5 0x1Fu 1. 1.5lf a . x v [ 1 ] . y 2e+4");
  EXPECT_EQ(processed("0xE+1"), "0xE + 1");
  EXPECT_EQ(processed("x-1.0-.5"), "x - 1.0 - .5");
}

TEST(Preprocess, KnowsWhatKindATokenIs) {
  const Preprocessed result = preprocess({"#version 330 core\nfloat a = 1.0;"}, {});
  ASSERT_EQ(result.tokens.size(), 6u);
  EXPECT_EQ(result.tokens[0].kind, TokenKind::directive);
  EXPECT_EQ(result.tokens[1].kind, TokenKind::identifier);
  EXPECT_EQ(result.tokens[3].kind, TokenKind::punctuator);
  EXPECT_EQ(result.tokens[4].kind, TokenKind::number);
}

TEST(Preprocess, PlacesCountPhysicalLinesOverAllStrings) {
  const Preprocessed result = preprocess({"#version 110\nint a;", " int b;\n", "int c;\n"}, {});
  EXPECT_EQ(tokenNamed(result, "a").place, (Place{2, 5}));
  EXPECT_EQ(tokenNamed(result, "b").place, (Place{2, 12}));
  EXPECT_EQ(tokenNamed(result, "c").place, (Place{3, 5}));
}

TEST(Preprocess, AWordMayStretchOverTwoStrings) {
  EXPECT_EQ(processed("flo"), "flo");
  EXPECT_THAT(texts(preprocess({"flo", "at a;"}, {})), ElementsAre("float", "a", ";"));
}

TEST(Preprocess, AllLineEndsCount) {
  for (const std::string end : {"\n", "\r\n", "\r", "\n\r"}) {
    const Preprocessed result = preprocess({"// c" + end + end + "a" + end + "  b"}, {});
    EXPECT_EQ(tokenNamed(result, "a").place, (Place{3, 1}));
    EXPECT_EQ(tokenNamed(result, "b").place, (Place{4, 3}));
  }
}

TEST(Preprocess, CommentsAndContinuationsKeepPlaces) {
  const Preprocessed result = preprocess({"a /* x\n y */ b // z \\\n still comment\nc\\\nd e"}, {});
  EXPECT_THAT(texts(result), ElementsAre("a", "b", "cd", "e"));
  EXPECT_EQ(tokenNamed(result, "b").place, (Place{2, 7}));
  EXPECT_EQ(tokenNamed(result, "cd").place, (Place{4, 1}));
  EXPECT_EQ(tokenNamed(result, "e").place, (Place{5, 3}));
}

TEST(Preprocess, ACommentSeparatesTokensAndMayStandInADirective) {
  EXPECT_EQ(processed("a/**/b"), "a b");
  EXPECT_EQ(processed("#define /* two\nlines */ X 1\nX"), "1");
  EXPECT_EQ(processed("/* never closed"), "error: line 1: this comment is not closed");
}

TEST(Preprocess, CommentsMayBeInAnyEncoding) {
  for (const std::string comment : {"\xC3\xA4\xE2\x82\xAC", "\xE4\xF6", "\xFF\xFE\x80 \xC3"}) {
    const Preprocessed result = preprocess({"/*" + comment + "*/ a // " + comment + "\nb"}, {});
    EXPECT_THAT(texts(result), ElementsAre("a", "b"));
    EXPECT_EQ(tokenNamed(result, "a").place.column, static_cast<int>(comment.size()) + 6);  // bytes
    EXPECT_EQ(tokenNamed(result, "b").place, (Place{2, 1}));
  }
}

TEST(Preprocess, AnythingMayStretchOverStrings) {
  EXPECT_THAT(texts(preprocess({"a /", "/ b\nc /", "* d *", "/ e"}, {})), ElementsAre("a", "c", "e"));
  EXPECT_THAT(texts(preprocess({"#def", "ine X ", "1 \\", "\n + 2\nX"}, {})), ElementsAre("1", "+", "2"));
  EXPECT_THAT(texts(preprocess({"x +", "", "= 1.", "5;"}, {})), ElementsAre("x", "+=", "1.5", ";"));
  EXPECT_THAT(texts(preprocess({"", "#version 330\n", "#line 7 2\n__LINE__ ", "__FILE__"}, {})),
              ElementsAre("#version 330", "7", "2"));
  EXPECT_THAT(texts(preprocess({"a\r", "\nb"}, {})), ElementsAre("a", "b"));
  EXPECT_EQ(tokenNamed(preprocess({"a\r", "\nb"}, {}), "b").place, (Place{2, 1}));
}

// As Mesa 22.3.6 has them, of its own list of extensions.
TEST(Macros, OfExtensionsExistOnlyForTheShadingLanguage) {
  PreprocessorFacts driver;
  driver.extensions = {"GL_ARB_shader_clock",  "GL_ARB_texture_rectangle", "GL_ARB_texture_non_power_of_two",
                       "GL_ARB_vertex_shader", "GL_ARB_gpu_shader_fp64",   "GL_OES_geometry_shader"};
  const auto defined = [&](const std::string& version, bool es) {
    driver.es = es;
    std::string text = version;
    for (std::size_t i = 0; i < driver.extensions.size(); ++i)
      text += "#ifdef " + driver.extensions[i] + "\n" + std::to_string(i) + "\n#endif\n";
    const std::vector<std::string> found = texts(preprocess({text}, driver));
    return std::vector<std::string>(found.begin() + (version.empty() ? 0 : 1), found.end());
  };
  EXPECT_THAT(defined("", false), ElementsAre("0", "1"));
  EXPECT_THAT(defined("#version 140\n", false), ElementsAre("0", "1"));
  EXPECT_THAT(defined("#version 150\n", false), ElementsAre("0", "1", "4"));
  EXPECT_THAT(defined("", true), ElementsAre("0", "1"));
  EXPECT_THAT(defined("#version 310 es\n", true), ElementsAre("0", "1", "5"));
}

TEST(Macros, ObjectLikeAreReplacedAtTheirUse) {
  const Preprocessed result = preprocess({"#define N (2 + 3)\nint a = N;"}, {});
  EXPECT_THAT(texts(result), ElementsAre("int", "a", "=", "(", "2", "+", "3", ")", ";"));
  EXPECT_EQ(tokenNamed(result, "+").place, (Place{2, 9}));
  EXPECT_TRUE(tokenNamed(result, "+").from_macro);
  EXPECT_FALSE(tokenNamed(result, ";").from_macro);
  EXPECT_EQ(tokenNamed(result, ";").place, (Place{2, 10}));
}

TEST(Macros, FunctionLikeTakeArguments) {
  EXPECT_EQ(processed("#define SQ(x) ((x)*(x))\nSQ(a, b)"),
            "error: line 2: macro 'SQ' takes 1 arguments, not 2");
  EXPECT_EQ(processed("#define MAX(a,b) (a>b?a:b)\nMAX(f(1,2), [3,4])"),
            "error: line 2: macro 'MAX' takes 2 arguments, not 3");
  EXPECT_EQ(processed("#define MAX(a,b) (a>b?a:b)\nMAX(f(1,2), 3)"), "( f ( 1 , 2 ) > 3 ? f ( 1 , 2 ) : 3 )");
  EXPECT_EQ(processed("#define F() x\nF() F"), "x F");
  EXPECT_EQ(processed("#define F (x)\nF"), "( x )");
  EXPECT_EQ(processed("#define F(x) x\nF\n(\n1\n)"), "1");
  EXPECT_EQ(processed("#define F(x) x\nF(1"), "error: line 2: the call of macro 'F' is not closed");
}

TEST(Macros, TokensOfACallSitAtTheMacrosName) {
  const Preprocessed result = preprocess({"#define TWICE(x) x + x\n  TWICE(abc) end"}, {});
  EXPECT_EQ(tokenNamed(result, "abc").place, (Place{2, 3}));
  EXPECT_TRUE(tokenNamed(result, "abc").from_macro);
  EXPECT_EQ(tokenNamed(result, "end").place, (Place{2, 14}));
}

// The examples of the C standard's preprocessor (ISO 9899, 6.10.3.5) that need neither # nor variable
// arguments.
TEST(Macros, RescanningFollowsTheStandardsExamples) {
  const std::string definitions =
      "#define x 3\n#define f(a) f(x * (a))\n#undef x\n#define x 2\n#define g f\n#define z z[0]\n"
      "#define h g(~\n#define m(a) a(w)\n#define w 0,1\n#define t(a) a\n#define p() int\n#define q(x) x\n"
      "#define r(x,y) x ## y\n";
  EXPECT_EQ(processed(definitions + "f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);"),
            "f ( 2 * ( y + 1 ) ) + f ( 2 * ( f ( 2 * ( z [ 0 ] ) ) ) ) % f ( 2 * ( 0 ) ) + t ( 1 ) ;");
  EXPECT_EQ(processed(definitions + "g(x+(3,4)-w) | h 5) & m(f)^m(m);"),
            "f ( 2 * ( 2 + ( 3 , 4 ) - 0 , 1 ) ) | f ( 2 * ( ~ 5 ) ) & f ( 2 * ( 0 , 1 ) ) ^ m ( 0 , 1 ) ;");
  EXPECT_EQ(processed(definitions + "p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };"),
            "int i [ ] = { 1 , 23 , 4 , 5 , } ;");
}

TEST(Macros, PastingMakesOneToken) {
  EXPECT_EQ(processed("#define V(n) v ## n ## _t\nV(1) V(ab)"), "v1_t vab_t");
  EXPECT_EQ(processed("#define X 1\n#define J(a,b) a ## b\nJ(X,X) J(a,X)"), "XX aX");
  EXPECT_THAT(processed("#define J(a,b) a ## b\nJ(+,/)"),
              HasSubstr("error: line 2: '+ ## /' does not make one token"));
}

TEST(Macros, SelfReferenceEnds) {
  EXPECT_EQ(processed("#define a a + b\n#define b a\na"), "a + a");
}

TEST(Macros, UndefTakesAMacroAway) {
  EXPECT_EQ(processed("#define A 1\nA\n#undef A\nA"), "1 A");
}

TEST(Macros, LineFileAndVersionAreNumbers) {
  EXPECT_EQ(processed("__LINE__\n__LINE__ __FILE__ __VERSION__"), "1 2 0 110");
  EXPECT_EQ(processed("#define L __LINE__\n\nL"), "3");
  EXPECT_EQ(processed("#version 330\n#line 100 7\n__LINE__ __FILE__\n__LINE__ __VERSION__"),
            "#version 330 100 7 101 330");
  EXPECT_EQ(tokenNamed(preprocess({"#line 100\na"}, {}), "a").place, (Place{2, 1}));
}

TEST(Conditions, TakeOneBranch) {
  const std::string text = "#if A == 1\none\n#elif A == 2\ntwo\n#else\nother\n#endif\nend";
  EXPECT_EQ(processed("#define A 1\n" + text), "one end");
  EXPECT_EQ(processed("#define A 2\n" + text), "two end");
  EXPECT_EQ(processed("#define A 3\n" + text), "other end");
}

TEST(Conditions, AreEvaluatedAsIntegers) {
  const auto holds = [](const std::string& condition) {
    return processed("#if " + condition + "\nyes\n#endif");
  };
  for (const char* condition : {"1",
                                "1 + 2 * 3 == 7",
                                "(1 + 2) * 3 == 9",
                                "10 - 4 - 3 == 3",
                                "1 << 4 == 16",
                                "7 % 4 == 3",
                                "0x10 == 16",
                                "010 == 8",
                                "-1 < 0",
                                "~0 == -1",
                                "!0",
                                "!defined X",
                                "!defined(X)",
                                "defined(GL_ARB_shader_clock)",
                                "0 && 1 / 0 || 1",
                                "1 || 1 / 0",
                                "2 > 1 && 1 >= 1 && 1 <= 1 && 1 != 2",
                                "(6 & 3) == 2",
                                "(6 ^ 3) == 5",
                                "(6 | 3) == 7",
                                "UNKNOWN == 0",
                                "__VERSION__ == 110"}) {
    PreprocessorFacts facts;
    facts.extensions = {"GL_ARB_shader_clock"};
    EXPECT_EQ(processed(std::string("#if ") + condition + "\nyes\n#endif", facts), "yes") << condition;
  }
  EXPECT_EQ(holds("0"), "");
  EXPECT_EQ(holds("1 / 0"), "error: line 1: the condition divides by zero");
  EXPECT_THAT(holds("1 +"), HasSubstr("error: line 1"));
  EXPECT_THAT(holds("(1"), HasSubstr("error: line 1"));
  EXPECT_THAT(holds("1.5"), HasSubstr("'1.5' is no integer"));
}

TEST(Conditions, NestAndSkipWhatDoesNotCount) {
  EXPECT_EQ(
      processed("#if 0\n#if 1\na\n#else\nb\n#endif\n#error no\n#bogus\n#define X 1\n#else\nc X\n#endif"),
      "c X");
  EXPECT_EQ(processed("#ifdef X\na\n#endif\n#ifndef X\nb\n#endif"), "b");
}

TEST(Conditions, ThatDoNotCloseAreErrors) {
  EXPECT_EQ(processed("\n#if 1\na"), "error: line 2: this conditional has no #endif");
  EXPECT_EQ(processed("#endif"), "error: line 1: #endif without #if");
  EXPECT_EQ(processed("#if 1\n#else\n#else\n#endif"), "error: line 3: #else after #else");
}

TEST(Directives, ForTheDriverStay) {
  const Preprocessed result = preprocess(
      {"#version 330 core // c\n#extension GL_ARB_x : enable\n #  pragma optimize(off)\nvoid main(){}"}, {});
  EXPECT_EQ(result.version, 330);
  EXPECT_EQ(result.profile, "core");
  EXPECT_THAT(result.extensions, ElementsAre(testing::Pair("GL_ARB_x", "enable")));
  EXPECT_EQ(result.tokens[0].text, "#version 330 core");
  EXPECT_EQ(result.tokens[1].text, "#extension GL_ARB_x : enable");
  EXPECT_EQ(result.tokens[2].text, "#pragma optimize ( off )");
  EXPECT_EQ(result.tokens[2].place, (Place{3, 2}));
}

TEST(Directives, ErrorsAreReportedWithTheirLine) {
  EXPECT_EQ(processed("\n#error too bad"), "error: line 2: #error too bad");
  EXPECT_THAT(processed("#import \"a\""), HasSubstr("error: line 1: #import is not known here"));
}

TEST(Directives, VersionsDefineTheirMacros) {
  PreprocessorFacts es;
  es.es = true;
  const std::string probes =
      "#ifdef GL_ES\nes\n#endif\n#ifdef GL_core_profile\ncore\n#endif\n#ifdef "
      "GL_compatibility_profile\ncompat\n#endif";
  EXPECT_EQ(processed(probes), "");
  EXPECT_EQ(processed(probes, es), "es");
  EXPECT_EQ(processed("#version 100\n" + probes), "#version 100 es");
  EXPECT_EQ(processed("#version 300 es\n" + probes), "#version 300 es es");
  EXPECT_EQ(processed("#version 330\n" + probes), "#version 330 core");
  EXPECT_EQ(processed("#version 330 compatibility\n" + probes), "#version 330 compatibility compat");
  EXPECT_EQ(preprocess({"a"}, es).version, 100);
  EXPECT_EQ(preprocess({"a"}, {}).version, 110);
}

TEST(Emit, PutsDirectivesOnLinesOfTheirOwn) {
  const std::string text = "#version 120\nint a=1; // c\n#pragma debug(on)\nint\n b;\n";
  EXPECT_EQ(emit(preprocess({text}, {}).tokens),
            "#version 120\nint a = 1 ;\n#pragma debug ( on )\nint\nb ;\n");
  EXPECT_THAT(emit({}), IsEmpty());
}

}  // namespace
}  // namespace shadestep::frontend
