// Loops, counts, clock and isolation run on OSMesa; the truth is the same algorithm in C++.
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <map>

#include "instrumenter/measures.h"
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
  const AttachmentShader one = made(instrumentCount(shader, {{Counted::Kind::runs, inner}}, target()));
  const DrawResult steps = run(GetParam(), all), runs = run(GetParam(), one);
  ASSERT_EQ(steps.error + runs.error, "");
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const NestedTwin twin(x, y);
      ASSERT_EQ(field(all, steps, x, y, "steps"), static_cast<std::uint32_t>(twin.steps))
          << x << "," << y << all.text;
      ASSERT_EQ(field(one, runs, x, y, "runs." + std::to_string(inner)),
                static_cast<std::uint32_t>(twin.inner));
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

// Branches, calls and texture lookups; the truth is the same in C++. (An unbound texture reads as black.)
TEST_P(Measures, BranchesCallsAndLookupsAreCounted) {
  const Dialect& dialect = GetParam();
  const bool es_or_new = dialect.version >= 130;
  const Shader shader = analysed(dialect.text(std::string("uniform sampler2D map;\n") +
                                              (es_or_new ? R"(
#define LOOKUP(p) texture(map, p)
)"
                                                         : R"(
#define LOOKUP(p) texture2D(map, p)
)") + R"(
float look(vec2 p) { return LOOKUP(p).r + LOOKUP(p.yx).g; }
void main() {
  int x = int(gl_FragCoord.x), y = int(gl_FragCoord.y);
  float f = 0.0;
  for (int i = 0; i < y; i++)
    if (i < x) f += look(place);
  if (x > 7) f += LOOKUP(place).b;
  COLOR = vec4(f);
})"));
  std::vector<Counted> asked;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const StatementKind kind = shader.statements[i].kind;
    if (kind == StatementKind::for_ || kind == StatementKind::if_)
      asked.push_back({Counted::Kind::taken, static_cast<int>(i)});
  }
  ASSERT_EQ(asked.size(), 3u);
  asked.push_back({Counted::Kind::entered, 0});
  const std::vector<TextureFetch> fetches = textureFetches(shader);
  ASSERT_EQ(fetches.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(fetches[static_cast<std::size_t>(i)].sampler, "map");
    asked.push_back({Counted::Kind::fetched, i});
  }
  const AttachmentShader instrumented = made(instrumentCount(shader, asked, target()));
  const DrawResult result = run(dialect, instrumented);
  ASSERT_EQ(result.error, "") << instrumented.text;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const auto calls = static_cast<std::uint32_t>(std::min(x, y));
      const std::uint32_t far = x > 7 ? 1 : 0;
      const std::uint32_t expected[] = {static_cast<std::uint32_t>(y), calls, far, calls, calls, calls, far};
      for (std::size_t i = 0; i < asked.size(); ++i)
        ASSERT_EQ(field(instrumented, result, x, y, nameOf(asked[i])), expected[i])
            << x << "," << y << " " << nameOf(asked[i]) << instrumented.text;
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

// The uniform that hands over the captured inputs of these pixels.
Uniform inputsOf(const IsolatedShader& isolated, const AttachmentShader& inputs, const DrawResult& captured,
                 const std::vector<std::size_t>& pixels) {
  Uniform uniform;
  uniform.type.basic = isolated.floats ? frontend::Basic::float_ : frontend::Basic::uint_;
  uniform.type.rows = 4;
  const auto stride = static_cast<std::size_t>(4 * isolated.vectors_per_thread);
  uniform.words.resize(pixels.size() * stride);
  for (std::size_t p = 0; p < pixels.size(); ++p)
    for (std::size_t i = 0; i < isolated.inputs.size(); ++i) {
      EXPECT_EQ(inputs.layout.fields.at(i).name, isolated.inputs[i].input);
      const Value value = decode(inputs.layout, inputs.layout.fields[i], captured.captured[pixels[p]].data());
      const bool truth = isolated.floats && value.type.basic == frontend::Basic::bool_;
      for (std::size_t w = 0; w < value.words.size(); ++w)
        uniform.words[p * stride + static_cast<std::size_t>(isolated.inputs[i].first_word) + w] =
            truth && value.words[w] != 0 ? std::bit_cast<std::uint32_t>(1.0f) : value.words[w];
    }
  return uniform;
}

class Isolated : public testing::TestWithParam<Dialect> {};

TEST_P(Isolated, EveryFragmentDoesWhatTheChosenOneDid) {
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
  request.uniforms[isolated.words_uniform] = inputsOf(isolated, inputs, captured, {pixel});
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

INSTANTIATE_TEST_SUITE_P(All, Isolated, testing::ValuesIn(kDialects),
                         [](const auto& parameters) { return parameters.param.name; });

// Derivatives are differences between the threads of a quad: between copies of one thread there are none.
TEST_P(Isolated, QuadsHaveTheTrueDerivatives) {
  const Dialect& dialect = GetParam();
  const Shader shader = analysed(dialect.text(R"(
void main() {
  float f = place.x * place.x + 3.0 * place.y;
  COLOR = vec4(dFdx(f), dFdy(f), fwidth(place.x * place.y), gl_FragCoord.x);
})"));
  DrawRequest original;
  original.text = uninstrumented(shader);
  original.user_outputs = dialect.outputs();
  const DrawResult plain = draw(dialect.profile, original);
  ASSERT_EQ(plain.error, "");
  const AttachmentShader inputs = made(instrumentSingle(shader, inputsProbe(shader), target()));
  const DrawResult captured = run(dialect, inputs);
  ASSERT_EQ(captured.error, "");

  const std::size_t corner = 10 * kSize + 6;  // of a quad
  const std::vector<std::size_t> threads = {corner, corner + 1, corner + kSize, corner + kSize + 1};
  const auto alone = [&](Isolation mode, const std::vector<std::size_t>& pixels) {
    const auto result = instrumentIsolate(shader, target(), mode);
    const auto& isolated = std::get<IsolatedShader>(result);
    DrawRequest request;
    request.text = isolated.text;
    request.vertex_text = isolated.vertex_text;
    request.user_outputs = dialect.outputs();
    request.uniforms[isolated.words_uniform] = inputsOf(isolated, inputs, captured, pixels);
    DrawResult drawn = draw(dialect.profile, request);
    EXPECT_EQ(drawn.error, "") << isolated.text;
    return drawn;
  };
  const DrawResult quads = alone(Isolation::quad, threads);
  ASSERT_EQ(quads.error, "");
  for (std::size_t y = 0; y < kSize; ++y)
    for (std::size_t x = 0; x < kSize; ++x)
      for (std::size_t channel = 0; channel < 4; ++channel)
        ASSERT_EQ(quads.outputs[0][(y * kSize + x) * 4 + channel],
                  plain.outputs[0][threads[y % 2 * 2 + x % 2] * 4 + channel])
            << x << "," << y << " " << channel;

  const DrawResult copies = alone(Isolation::plain, {corner});
  ASSERT_EQ(copies.error, "");
  EXPECT_EQ(copies.outputs[0][0], 0u) << "a derivative between copies";
  EXPECT_NE(copies.outputs[0][0], plain.outputs[0][corner * 4]);
}

// An input of every kind and type reaches the isolated thread bit for bit.
TEST(IsolatedInputs, AreHandedOverInEveryType) {
  const std::string vertex = R"(#version 450 core
struct Light { vec3 direction; float power[2]; };
layout(location = 0) flat out ivec3 i; layout(location = 1) flat out uvec2 u;
layout(location = 2) noperspective out vec2 n; layout(location = 3) centroid out mat2 m;
layout(location = 5) out vec4 a[2]; layout(location = 7) flat out dvec2 d;
layout(location = 8) out Light light;
out Named { flat int number; vec2 where; } named;
out Nameless { vec3 free; };
void main() {
  vec2 c = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(c, 0.0, 1.0);
  i = ivec3(-7, 1 << 30, gl_VertexID); u = uvec2(0xfffffff0u, 3u); n = c * 0.3; m = mat2(c, c.yx);
  a[0] = c.xyxy; a[1] = c.yyyy * 1.5; d = dvec2(1.0lf / 3.0lf, -2.0lf);
  light.direction = vec3(c, 0.25); light.power[0] = c.x; light.power[1] = c.y;
  named.number = 12345; named.where = c * 7.0; free = vec3(c.y, c.x, 1.0);
})";
  const Shader shader = analysed(R"(#version 450 core
struct Light { vec3 direction; float power[2]; };
layout(location = 0) flat in ivec3 i; layout(location = 1) flat in uvec2 u;
layout(location = 2) noperspective in vec2 n; layout(location = 3) centroid in mat2 m;
layout(location = 5) in vec4 a[2]; layout(location = 7) flat in dvec2 d;
layout(location = 8) in Light light;
in Named { flat int number; vec2 where; } named;
in Nameless { vec3 free; };
out vec4 color;
void main() {
  int sum = i.x ^ i.y + i.z + named.number + gl_PrimitiveID + int(gl_FrontFacing);
  float f = n.x + m[1].y + a[0].z + a[1].w + float(d.x) + light.direction.y + light.power[1];
  color = vec4(float(sum), float(u.x), f, named.where.x + free.x + gl_FragCoord.y);
})");
  DrawRequest original;
  original.text = uninstrumented(shader);
  original.vertex_text = vertex;
  original.user_outputs = {"color"};
  const DrawResult plain = draw(Profile::core, original);
  ASSERT_EQ(plain.error, "");

  const auto result = instrumentIsolate(shader, target());
  ASSERT_TRUE(std::holds_alternative<IsolatedShader>(result)) << std::get<Failure>(result).reason;
  const auto& isolated = std::get<IsolatedShader>(result);
  // As many passes as the draw buffers demand.
  std::map<std::string, Value> values;
  const std::size_t pixel = 9 * kSize + 4;
  for (const frontend::Watch& watch : inputsProbe(shader).watches) {
    Probe probe = inputsProbe(shader);
    probe.watches = {watch};
    const AttachmentShader one = made(instrumentSingle(shader, probe, target()));
    DrawRequest capture = original;
    capture.text = one.text;
    capture.capture = one.layout;
    const DrawResult captured = draw(Profile::core, capture);
    ASSERT_EQ(captured.error, "") << one.text;
    values[watch.expression] = decode(one.layout, one.layout.fields.at(0), captured.captured[pixel].data());
  }
  Uniform words;
  words.type.basic = frontend::Basic::uint_;
  words.type.rows = 4;
  words.words.resize(static_cast<std::size_t>(4 * isolated.vectors_per_thread));
  ASSERT_GE(isolated.inputs.size(), 11u);
  for (const IsolatedInput& input : isolated.inputs)
    std::copy(values.at(input.input).words.begin(), values.at(input.input).words.end(),
              words.words.begin() + input.first_word);

  DrawRequest request;
  request.text = isolated.text;
  request.vertex_text = isolated.vertex_text;
  request.user_outputs = {"color"};
  request.uniforms[isolated.words_uniform] = words;
  const DrawResult everywhere = draw(Profile::core, request);
  ASSERT_EQ(everywhere.error, "") << isolated.text;
  for (std::size_t channel = 0; channel < 4; ++channel)
    EXPECT_EQ(everywhere.outputs[0][channel], plain.outputs[0][pixel * 4 + channel])
        << channel << isolated.text;
}

std::string isolatedText(const std::string& text) {
  const auto result = instrumentIsolate(analysed(text), target());
  if (const auto* failure = std::get_if<Failure>(&result)) return failure->reason;
  std::string squeezed = std::get<IsolatedShader>(result).text;
  std::erase_if(squeezed, [](char c) { return c == ' ' || c == '\n'; });
  return squeezed;
}

TEST(IsolationText, DropsWhatVariablesCannotHave) {
  const auto holds = [](const std::string& text, const std::string& part) {
    EXPECT_NE(isolatedText(text).find(part), std::string::npos) << isolatedText(text);
  };
  holds(
      "#version 330 core\nlayout(location = 1) flat in ivec2 a; flat in ivec2 b, d; "
      "centroid in vec2 c[2]; out vec4 o;\n"
      "void main() { o = vec4(a, c[1]); }",
      "ivec2a;ivec2b,d;vec2c[2];outvec4o;");
  holds(
      "#version 330 core\nlayout(pixel_center_integer) in vec4 gl_FragCoord; out vec4 o;\n"
      "void main() { o = gl_FragCoord; }",
      "outvec4o;voidsd_main(){o=sd_FragCoord;}");
  holds(
      "#version 120\nvarying vec4 gl_TexCoord[2];\nvoid main() { gl_FragColor = gl_TexCoord[1] "
      "+ gl_Color; }",
      "voidsd_main(){gl_FragColor=sd_TexCoord1+sd_Color;}");
  holds(
      "#version 330 core\nin float gl_ClipDistance[2]; out vec4 o;\n"
      "void main() { o = vec4(gl_ClipDistance[1], gl_ClipDistance[0], 0.0, 1.0); }",
      "outvec4o;voidsd_main(){o=vec4(sd_ClipDistance1,sd_ClipDistance0,0.0,1.0);}");
  holds(
      "#version 330 core\nuniform int i; in float gl_ClipDistance[2]; out vec4 o;\n"
      "void main() { o = vec4(gl_ClipDistance[i], gl_ClipDistance[0], 0.0, 1.0); }",
      "outvec4o;voidsd_main(){o=vec4(sd_ClipDistance[i],sd_ClipDistance[0],0.0,1.0);}");
  holds("#version 110\nvoid main() { gl_FragColor = gl_TexCoord[0 + 1]; }", "vec4sd_TexCoord[2];");
  holds(
      "#version 330 core\nin Block { noperspective vec2 a; flat int b; } block; out vec4 o;\n"
      "void main() { o = block.a.xyxy; }",
      "structBlock{vec2a;intb;}block;outvec4o;");
  holds(
      "#version 330 core\nin Block { centroid vec2 a; vec3 b[2]; }; out vec4 o;\n"
      "void main() { o = a.xyxy; }",
      "vec2a;vec3b[2];outvec4o;");
  holds("#version 330 core\nstruct S { vec2 a; };\nsmooth in S s; out vec4 o;\nvoid main() { o = s.a.xyxy; }",
        "structS{vec2a;};Ss;outvec4o;");
  holds("#version 400 core\nin vec2 a; out vec4 o;\nvoid main() { o = interpolateAtCentroid(a).xyxy; }",
        "o=sd_AtCentroid(a).xyxy;");
}

}  // namespace
}  // namespace shadestep::instrumenter::test
