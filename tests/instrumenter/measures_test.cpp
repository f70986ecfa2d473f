// Loops, counts, clock and isolation run on OSMesa; the truth is the same algorithm in C++.
#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "osmesa_draw.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::Shader;
using frontend::StatementId;
using frontend::StatementKind;

// What kNested does, with a call at each loop's entry, at each start of a body, at each statement or
// condition.
struct NestedTwin {
  int entries[4] = {}, iterations[4] = {}, longest[4] = {};  // for, while, do, for(;;)
  int steps = 0, inner = 0;

  NestedTwin(int x, int y) {
    steps += 2;  // the declarations
    int count = 0;
    int bodies = enter(0);
    for (int i = 0; step(), i < 3; ++i) {
      body(0, ++bodies);
      step();  // int j
      int j = 0;
      int inside = enter(1);
      while (step(), j < x) {
        body(1, ++inside);
        step(), j++;
        if (step(), j == 2) {
          step();  // continue
          continue;
        }
        step(), ++inner, count += i * j;
        if (step(), count > 20) {
          step();  // break
          break;
        }
      }
      inside = enter(2);
      do {
        body(2, ++inside);
        step(), count--;
      } while (step(), count > y);
      inside = enter(3);
      for (;;) {
        step();  // the condition that is not there
        body(3, ++inside);
        if (step(), count++ > 5) {
          step();  // break
          break;
        }
      }
    }
    step();   // the output
    steps++;  // the init of the outer loop
  }

 private:
  void step() { ++steps; }
  int enter(int loop) {
    ++entries[loop];
    return 0;
  }
  void body(int loop, int bodies) {
    ++iterations[loop];
    longest[loop] = std::max(longest[loop], bodies);
  }
};

DrawResult run(const Dialect& dialect, const AttachmentShader& instrumented) {
  DrawRequest request;
  request.text = instrumented.text;
  request.user_outputs = dialect.outputs();
  request.capture = instrumented.layout;
  return draw(dialect.profile, request);
}

AttachmentShader made(const Result<AttachmentShader>& result) {
  if (const auto* failure = std::get_if<Failure>(&result)) throw std::runtime_error(failure->reason);
  return std::get<AttachmentShader>(result);
}

std::uint32_t field(const AttachmentShader& shader, const DrawResult& result, int x, int y,
                    const std::string& name) {
  for (const Field& candidate : shader.layout.fields)
    if (candidate.name == name)
      return decode(shader.layout, candidate, result.captured[static_cast<std::size_t>(y * kSize + x)].data())
          .words[0];
  throw std::runtime_error("no field " + name);
}

std::vector<StatementId> loopsOf(const Shader& shader) {
  std::vector<StatementId> loops;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const StatementKind kind = shader.statements[i].kind;
    if (kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while)
      loops.push_back(static_cast<StatementId>(i));
  }
  return loops;
}

class Measures : public testing::TestWithParam<Dialect> {};

TEST_P(Measures, LoopsAreCounted) {
  const Shader shader = analysed(GetParam().text(kNested.text));
  const std::vector<StatementId> loops = loopsOf(shader);
  ASSERT_EQ(loops.size(), 4u);
  // In dialects without integer attachments a count takes two words, so two loops at a time.
  for (const std::size_t first : {0u, 2u}) {
    const AttachmentShader instrumented =
        made(instrumentLoops(shader, {loops[first], loops[first + 1]}, target()));
    const DrawResult result = run(GetParam(), instrumented);
    ASSERT_EQ(result.error, "");
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const NestedTwin twin(x, y);
        for (std::size_t loop = first; loop < first + 2; ++loop) {
          const std::string name = std::to_string(loops[loop]);
          ASSERT_EQ(field(instrumented, result, x, y, name + ".entries"),
                    static_cast<std::uint32_t>(twin.entries[loop]));
          ASSERT_EQ(field(instrumented, result, x, y, name + ".iterations"),
                    static_cast<std::uint32_t>(twin.iterations[loop]));
          ASSERT_EQ(field(instrumented, result, x, y, name + ".longest"),
                    static_cast<std::uint32_t>(twin.longest[loop]));
          ASSERT_EQ(field(instrumented, result, x, y, name + ".cut"), 0u) << instrumented.text;
        }
      }
    }
  }
}

TEST_P(Measures, StepsAreCounted) {
  const Shader shader = analysed(GetParam().text(kNested.text));
  const AttachmentShader all = made(instrumentCount(shader, {}, target()));
  const StatementId inner = named(shader, "inner");
  const AttachmentShader one = made(instrumentCount(shader, {inner}, target()));
  const DrawResult steps = run(GetParam(), all), runs = run(GetParam(), one);
  ASSERT_EQ(steps.error + runs.error, "");
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const NestedTwin twin(x, y);
      ASSERT_EQ(field(all, steps, x, y, "steps"), static_cast<std::uint32_t>(twin.steps))
          << x << "," << y << all.text;
      ASSERT_EQ(field(one, runs, x, y, std::to_string(inner)), static_cast<std::uint32_t>(twin.inner));
    }
  }
}

TEST_P(Measures, LeaveTheOutputsAlone) {
  const Dialect& dialect = GetParam();
  for (const Body& body : kBodies) {
    if (dialect.version < body.version) continue;
    const Shader shader = analysed(dialect.text(body.text));
    DrawRequest request;
    request.text = uninstrumented(shader);
    request.user_outputs = dialect.outputs();
    const DrawResult plain = draw(dialect.profile, request);
    ASSERT_EQ(plain.error, "");
    for (const AttachmentShader& instrumented :
         {made(instrumentCount(shader, {}, target())), made(instrumentLoops(shader, {}, target()))}) {
      const DrawResult result = run(dialect, instrumented);
      EXPECT_EQ(result.error, "");
      EXPECT_EQ(result.outputs, plain.outputs) << instrumented.text;
    }
  }
}

// A loop of n iterations whose n is chosen by the pixel: more work must read as more ticks.
TEST_P(Measures, TheClockTicksWithTheWork) {
  const Dialect& dialect = GetParam();
  if (dialect.version >= 300 && dialect.name.starts_with("es")) GTEST_SKIP() << "no shader clock in ES";
  const Shader shader = analysed(dialect.text(R"(
void main() {
  int n = gl_FragCoord.y < 8.0 ? 10 : 10000;
  float f = place.x;
  for (int i = 0; i < n; i++) f = sin(f) + place.y;
  COLOR = vec4(f);
})"));
  const AttachmentShader instrumented = made(instrumentClock(shader, target()));
  const DrawResult result = run(dialect, instrumented);
  ASSERT_EQ(result.error, "");
  for (int x = 0; x < kSize; ++x) {
    const std::uint32_t little = field(instrumented, result, x, 2, "low"),
                        much = field(instrumented, result, x, 13, "low");
    EXPECT_GT(little, 0u);
    EXPECT_GT(much, little);
    EXPECT_EQ(field(instrumented, result, x, 13, "high"), 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Measures, testing::ValuesIn(kDialects),
                         [](const auto& parameters) { return parameters.param.name; });

// ---- isolation
// --------------------------------------------------------------------------------------------------

const std::string kShading = R"(
void main() {
  float place_x = place.x;
  vec2 p = place;
  { vec2 place = vec2(2.0); p += place; }
  p.x += gl_FragCoord.x * 0.25 + (gl_FrontFacing ? 1.0 : 0.0);
  COLOR = vec4(p, place_x, gl_FragCoord.y);
})";

class Isolation : public testing::TestWithParam<Dialect> {};

TEST_P(Isolation, EveryFragmentDoesWhatTheChosenOneDid) {
  const Dialect& dialect = GetParam();
  const Shader shader = analysed(dialect.text(kShading));
  DrawRequest original;
  original.text = uninstrumented(shader);
  original.user_outputs = dialect.outputs();
  const DrawResult plain = draw(dialect.profile, original);
  ASSERT_EQ(plain.error, "");

  const auto result = instrumentIsolate(shader, target());
  ASSERT_TRUE(std::holds_alternative<IsolatedShader>(result)) << std::get<Failure>(result).reason;
  const auto& isolated = std::get<IsolatedShader>(result);
  const AttachmentShader inputs = made(instrumentSingle(shader, inputsProbe(shader), target()));
  const DrawResult captured = run(dialect, inputs);
  ASSERT_EQ(captured.error, "");
  ASSERT_EQ(isolated.inputs.size(), 3u);

  const std::size_t pixel = 11 * kSize + 6;
  DrawRequest request;
  request.text = isolated.text;
  request.vertex_text = isolated.vertex_text;
  request.user_outputs = dialect.outputs();
  for (std::size_t i = 0; i < isolated.inputs.size(); ++i) {
    ASSERT_EQ(inputs.layout.fields[i].name, isolated.inputs[i].input);
    const Value value = decode(inputs.layout, inputs.layout.fields[i], captured.captured[pixel].data());
    request.uniforms[isolated.inputs[i].uniform] = {value.type, value.words};
  }
  const DrawResult everywhere = draw(dialect.profile, request);
  ASSERT_EQ(everywhere.error, "");
  for (std::size_t other = 0; other < kPixels; ++other)
    for (std::size_t channel = 0; channel < 4; ++channel)
      ASSERT_EQ(everywhere.outputs[0][other * 4 + channel], plain.outputs[0][pixel * 4 + channel])
          << other << "\n"
          << isolated.text;

  request.text = isolated.baseline_text;
  request.uniforms.clear();
  const DrawResult baseline = draw(dialect.profile, request);
  EXPECT_EQ(baseline.error, "");
  EXPECT_EQ(baseline.outputs[0], std::vector<std::uint32_t>(kPixels * 4, 0));
}

INSTANTIATE_TEST_SUITE_P(All, Isolation, testing::ValuesIn(kDialects),
                         [](const auto& parameters) { return parameters.param.name; });

std::string isolatedText(const std::string& text) {
  const auto result = instrumentIsolate(analysed(text), target());
  if (const auto* failure = std::get_if<Failure>(&result)) return failure->reason;
  std::string squeezed = std::get<IsolatedShader>(result).text;
  std::erase_if(squeezed, [](char c) { return c == ' ' || c == '\n'; });
  return squeezed;
}

TEST(IsolationText, DropsWhatUniformsCannotHave) {
  EXPECT_NE(isolatedText("#version 330 core\nlayout(location = 1) flat in ivec2 a; flat in ivec2 b, d; "
                         "centroid in vec2 c[2]; out vec4 o;\n"
                         "void main() { o = vec4(a, c[1]); }")
                .find("uniformivec2a;uniformivec2b,d;uniformvec2c[2];outvec4o;"),
            std::string::npos);
  EXPECT_NE(isolatedText("#version 330 core\nlayout(pixel_center_integer) in vec4 gl_FragCoord; out vec4 o;\n"
                         "void main() { o = gl_FragCoord; }")
                .find("uniformvec4sd_FragCoord;outvec4o;voidmain(){o=sd_FragCoord;}"),
            std::string::npos);
  EXPECT_NE(
      isolatedText("#version 120\nvarying vec4 gl_TexCoord[2];\nvoid main() { gl_FragColor = gl_TexCoord[1] "
                   "+ gl_Color; }")
          .find(
              "uniformvec4sd_TexCoord1;uniformvec4sd_Color;voidmain(){gl_FragColor=sd_TexCoord1+sd_Color;}"),
      std::string::npos);
}

TEST(IsolationText, SaysWhatCannotBeIsolated) {
  EXPECT_EQ(
      isolatedText(
          "#version 330 core\nin Block { vec2 a; } block; out vec4 o;\nvoid main() { o = block.a.xyxy; }")
          .substr(0, 46),
      "The inputs cannot be turned into uniforms yet:");
}

}  // namespace
}  // namespace shadestep::instrumenter::test
