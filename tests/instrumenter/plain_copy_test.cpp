// The plain copies of a recorded shader's functions: every function once more, calling only copies.
#include <gtest/gtest.h>

#include <algorithm>

#include "shaders.h"

namespace shadestep::instrumenter::test {
namespace {

std::string recorded(const std::string& text) {
  const auto result = instrumentRecording(analysed(text), target());
  if (const auto* failure = std::get_if<Failure>(&result)) return "failure: " + failure->reason;
  std::string squeezed = std::get<RecordingShader>(result).text;
  std::erase_if(squeezed, [](char c) { return c == ' ' || c == '\n'; });
  return squeezed;
}

void expectPart(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no " << part << "\nin " << text;
}

const std::string kShader =
    "#version 450 core\n"
    "out vec4 color;\n"
    "float f(float a);\n"
    "float f(float a, int b) { return f(a) * float(b); }\n"
    "void main() {\n  float f1 = f(2.0, 3);\n  color = vec4(f1, f(f1), 0, 1);\n}\n"
    "float f(float a) { return a + 1.0; }\n";

TEST(PlainCopy, CallsOnlyCopies) {
  const std::string text = recorded(kShader);
  // Functions are numbered in the order of their first declaration or definition.
  expectPart(text, "floatsd_p0(floata);");
  expectPart(text, "floatsd_p1(floata,intb){returnsd_p0(a)*float(b);}");
  expectPart(text, "voidsd_p2(){floatf1=sd_p1(2.0,3);color=vec4(f1,sd_p0(f1),0,1);}");
  expectPart(text, "floatsd_p0(floata){returna+1.0;}");
}

TEST(PlainCopy, RunsWhereNothingIsRecorded) {
  expectPart(recorded(kShader), "for(intsd_turn=sd_begin()?1:0;sd_turn<2;sd_turn+=2)if(sd_turn==0)sd_p2();elsesd_main();");
}

TEST(PlainCopy, HasTheOutputsThatCapturesLeave) {
  const std::string text = recorded("#version 120\nvoid main() { gl_FragColor = vec4(1.0); }\n");
  expectPart(text, "voidsd_p0(){gl_FragData[0]=vec4(1.0);}");
}

}  // namespace
}  // namespace shadestep::instrumenter::test
