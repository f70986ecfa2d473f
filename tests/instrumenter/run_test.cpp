// Single probes run on OSMesa; the truth is the same algorithm in C++.
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <set>

#include "osmesa_draw.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::Basic;
using When = Probe::When;

// A thread came past the probe: the iterations of the loops around it, and the values.
struct Passage {
  std::vector<int> iterations;
  std::vector<double> values;
};
using Trace = std::vector<Passage>;

struct Case {
  std::string name;
  const Body* body;
  std::string at;
  When when;
  std::vector<std::string> watches;
  std::function<void(int x, int y, Trace&)> run;  // what the thread at a pixel does
  bool outcome = false;
  std::vector<std::string> calls =
      {};  // names of the lines with the calls; `call_number` picks one of the last line
  std::size_t call_number = 0;
};

void PrintTo(const Case& test, std::ostream* out) {
  *out << test.name;
}

double number(Basic basic, std::uint32_t word) {
  if (basic == Basic::float_) return static_cast<double>(std::bit_cast<float>(word));
  if (basic == Basic::int_) return static_cast<double>(static_cast<std::int32_t>(word));
  return static_cast<double>(word);
}

std::vector<double> valuesAt(const AttachmentLayout& layout, const std::vector<std::uint32_t>& words) {
  std::vector<double> values;
  for (const Field& field : layout.fields) {
    const Value value = decode(layout, field, words.data());
    std::size_t word = 0;
    for (const frontend::Component& component : frontend::components(field.type))
      values.push_back(number(component.basic, value.words[word++]));
  }
  return values;
}

Probe probeOf(const Case& test, const frontend::Shader& shader) {
  Probe probe;
  probe.when = test.when;
  probe.statement = named(shader, test.at);
  probe.outcome = test.outcome;
  for (const std::string& line : test.calls) {
    const auto& calls = shader.statements[static_cast<std::size_t>(named(shader, line))].calls;
    probe.call_path.push_back(
        calls.at(probe.call_path.size() + 1 == test.calls.size() ? test.call_number : 0));
  }
  for (const std::string& watch : test.watches) {
    const frontend::WatchResult result = frontend::resolveWatch(shader, probe.statement, watch);
    if (!result.watch) throw std::runtime_error(result.error);
    probe.watches.push_back(*result.watch);
  }
  return probe;
}

DrawResult run(const Dialect& dialect, const AttachmentShader& instrumented) {
  DrawRequest request;
  request.text = instrumented.text;
  request.user_outputs = dialect.outputs();
  request.capture = instrumented.layout;
  return draw(dialect.profile, request);
}

void expectCaptured(const Case& test, const AttachmentShader& instrumented, const DrawResult& result,
                    const std::vector<int>& iterations, const DrawResult& plain) {
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      Trace trace;
      test.run(x, y, trace);
      const Passage* last = nullptr;
      for (const Passage& passage : trace)
        if (std::equal(iterations.begin(), iterations.end(), passage.iterations.begin())) last = &passage;

      const auto pixel = static_cast<std::size_t>(y * kSize + x);
      const bool discarded = plain.outputs[0][pixel * 4] == 0 && test.body == &kDiscard;
      const std::uint32_t mark = (discarded ? kDiscarded : 0) | (last ? kLaunched | kReached : kLaunched);
      ASSERT_EQ(decodeMark(instrumented.layout, result.captured[pixel].data()), mark)
          << "pixel " << x << "," << y << " iterations " << testing::PrintToString(iterations) << "\n"
          << instrumented.text;
      if (!last) continue;
      ASSERT_EQ(valuesAt(instrumented.layout, result.captured[pixel]), last->values)
          << "pixel " << x << "," << y << " iterations " << testing::PrintToString(iterations) << "\n"
          << instrumented.text;
    }
  }
}

// kDiscard's keep.
bool dropped(int v) {
  return v == 7 || v > 20;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"loop_body",
       &kLoops,
       "add",
       When::before,
       {"s", "i", "f"},
       [](int x, int y, Trace& trace) {
         int s = 0;
         double f = 0.5;
         for (int i = 0; i < 10; i++) {
           if (i == x) continue;
           if (i > y) break;
           trace.push_back({{i}, {double(s), double(i), f}});
           s += i;
           f = f * 0.5 + i;
         }
       }},
      {"after_statement",
       &kLoops,
       "add",
       When::after,
       {"s"},
       [](int x, int y, Trace& trace) {
         int s = 0;
         for (int i = 0; i < 10 && (i == x || i <= y); i++) {
           if (i == x) continue;
           s += i;
           trace.push_back({{i}, {double(s)}});
         }
       }},
      {"for_condition",
       &kLoops,
       "head",
       When::after,
       {"s"},
       [](int x, int y, Trace& trace) {
         int s = 0;
         for (int i = 0;; i++) {
           trace.push_back({{i}, {i < 10 ? 1.0 : 0.0, double(s)}});
           if (i == 10) break;
           if (i == x) continue;
           if (i > y) break;
           s += i;
         }
       },
       true},
      {"if_condition",
       &kLoops,
       "leave",
       When::after,
       {"i"},
       [](int x, int y, Trace& trace) {
         for (int i = 0; i < 10; i++) {
           if (i == x) continue;
           trace.push_back({{i}, {i > y ? 1.0 : 0.0, double(i)}});
           if (i > y) break;
         }
       },
       true},
      {"nested_while",
       &kNested,
       "inner",
       When::before,
       {"count", "j"},
       [](int x, int y, Trace& trace) {
         int count = 0;
         for (int i = 0; i < 3; ++i) {
           int j = 0;
           for (int n = 0; j < x; ++n) {
             j++;
             if (j == 2) continue;
             trace.push_back({{i, n}, {double(count), double(j)}});
             count += i * j;
             if (count > 20) break;
           }
           do count--;
           while (count > y);
           while (count++ <= 5) {
           }
         }
       }},
      {"do_while_condition",
       &kNested,
       "down",
       When::after,
       {"count"},
       [](int x, int y, Trace& trace) {
         int count = 0;
         for (int i = 0; i < 3; ++i) {
           for (int j = 0; j < x;) {
             j++;
             if (j == 2) continue;
             count += i * j;
             if (count > 20) break;
           }
           int n = 0;
           do {
             count--;
             trace.push_back({{i, n++}, {count > y ? 1.0 : 0.0, double(count)}});
           } while (count > y);
           while (count++ <= 5) {
           }
         }
       },
       true},
      {"one_of_two_calls",
       &kFunctions,
       "double",
       When::before,
       {"a", "b"},
       [](int x, int y, Trace& trace) {
         double b = 1.0 + x;  // what the first call starts from
         if (b <= 6.0) b *= 4.0;
         b += y;
         if (b <= 6.0) trace.push_back({{}, {double(y), b}});
       },
       false,
       {"twice"},
       1},
      {"call_in_a_loop",
       &kFunctions,
       "halve",
       When::after,
       {"v"},
       [](int, int y, Trace& trace) {
         int h = y;
         for (int i = 0; i < 3; i++) {
           const int v = h + i;
           trace.push_back({{i}, {v > 3 ? 1.0 : 0.0, double(v)}});
           h = v > 3 ? v / 2 : v;
         }
       },
       true,
       {"halves"}},
      {"out_parameters",
       &kFunctions,
       "split",
       When::after,
       {"low", "high", "v"},
       [](int x, int, Trace& trace) {
         trace.push_back({{}, {double(x % 4), double(x / 4), double(x)}});
       },
       false,
       {"call"}},
      {"condition_with_side_effect",
       &kConditions,
       "first",
       When::after,
       {"n"},
       [](int x, int, Trace& trace) {
         trace.push_back({{}, {x < 4 ? 1.0 : 0.0, x + 1.0}});
       },
       true},
      {"while_condition",
       &kConditions,
       "while",
       When::after,
       {"n", "stop", "calls"},
       [](int x, int y, Trace& trace) {
         int n = x, calls = 0;
         const auto odd = [&calls](int v) { return ++calls, v % 2 == 1; };
         if (n++ < 4) {
         } else if (odd(n)) {
           odd(y);
         }
         bool stop = false;
         for (int i = 0;; ++i) {
           const bool more = !stop && n-- > 3;
           trace.push_back({{i}, {more ? 1.0 : 0.0, double(n), stop ? 1.0 : 0.0, double(calls)}});
           if (!more) break;
           if (!odd(n)) stop = y > 8;
         }
       },
       true},
      {"before_discard",
       &kDiscard,
       "keep",
       When::before,
       {"i"},
       [](int x, int y, Trace& trace) {
         for (int i = 0; i < 4 && i != x; i++) {
           trace.push_back({{i}, {double(i)}});
           if (dropped(x + y + i)) return;
         }
       }},
      {"before_discard_in_a_call",
       &kDiscard,
       "drop",
       When::before,
       {"v"},
       [](int x, int y, Trace& trace) {
         for (int i = 0; i < 4 && i != x; i++)
           if (dropped(x + y + i)) {
             if (x + y + i == 7) trace.push_back({{i}, {7.0}});
             return;
           }
       },
       false,
       {"keep"}},
      {"condition_of_discard",
       &kDiscard,
       "which",
       When::after,
       {"i"},
       [](int x, int y, Trace& trace) {
         for (int i = 0; i < 4; i++) {
           trace.push_back({{i}, {i == x ? 1.0 : 0.0, double(i)}});
           if (i == x || dropped(x + y + i)) return;
         }
       },
       true},
      {"returned_early",
       &kDiscard,
       "end",
       When::before,
       {"x"},
       [](int x, int y, Trace& trace) {
         for (int i = 0; i < 4; i++)
           if (i == x || dropped(x + y + i)) return;
         if (y != 3) trace.push_back({{}, {double(x)}});
       }},
      {"structures_and_matrices",
       &kValues,
       "end",
       When::before,
       {"ray", "m", "flags"},
       [](int x, int y, Trace& trace) {
         const double hit = x > 4 ? 1.0 : 0.0;
         trace.push_back({{},
                          {double(x), 2.0 * x, 4.0 * x, 0.5, double(x), hit, 1.0, 2.0, 3.0, 0.5 * y,
                           x > y ? 1.0 : 0.0, hit}});
       }},
      {"integers_of_all_sizes",
       &kValues,
       "end",
       When::before,
       {"big", "least"},
       [](int x, int y, Trace& trace) {
         trace.push_back({{}, {double(x * 65536 + y - 40000000), -2147483648.0}});
       }},
      {"switch_selector",
       &kSwitch,
       "select",
       When::after,
       {"r"},
       [](int x, int y, Trace& trace) {
         int r = 0;
         for (int i = 0; i < 3; i++) {
           const int selector = x - i;
           trace.push_back({{i}, {double(selector), double(r)}});
           if (selector == 0) r += 1;
           if (selector == 0 || selector == 1) {
             r += 10;
           } else {
             if (selector == 2 && y <= 4) r += 100;
             if (selector != 2 || y <= 4) {
               r += y;
               if (y == 2) continue;
             }
           }
           r++;
         }
       },
       true},
  };
  return all;
}

class SingleRun : public testing::TestWithParam<std::tuple<Dialect, Case>> {};

TEST_P(SingleRun, CapturesWhatTheThreadHad) {
  const auto& [dialect, test] = GetParam();
  if (dialect.version < test.body->version) GTEST_SKIP() << "needs GLSL " << test.body->version;
  const frontend::Shader shader = analysed(dialect.text(test.body->text));
  DrawRequest original;
  original.text = uninstrumented(shader);
  original.user_outputs = dialect.outputs();
  const DrawResult plain = draw(dialect.profile, original);
  ASSERT_EQ(plain.error, "");

  std::set<std::vector<int>> iterations = {{}};
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    Trace trace;
    test.run(pixel % kSize, pixel / kSize, trace);
    for (const Passage& passage : trace) iterations.insert(passage.iterations);
  }
  for (const std::vector<int>& chosen : iterations) {
    Probe probe = probeOf(test, shader);
    probe.iterations = chosen;
    const auto instrumented = instrumentSingle(shader, probe, target());
    ASSERT_TRUE(std::holds_alternative<AttachmentShader>(instrumented))
        << std::get<Failure>(instrumented).reason;
    const auto& single = std::get<AttachmentShader>(instrumented);
    const DrawResult result = run(dialect, single);
    ASSERT_EQ(result.error, "");
    EXPECT_EQ(result.outputs, plain.outputs) << single.text;
    expectCaptured(test, single, result, chosen, plain);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SingleRun,
                         testing::Combine(testing::ValuesIn(kDialects), testing::ValuesIn(cases())),
                         [](const auto& parameters) {
                           return std::get<0>(parameters.param).name + "_" +
                                  std::get<1>(parameters.param).name;
                         });

// ---- outputs of old dialects on two draw buffers
// -----------------------------------------------------------------

void expectSameOutputs(const std::string& text) {
  const frontend::Shader shader = analysed(text);
  DrawRequest request;
  request.text = uninstrumented(shader);
  request.color_buffers = 2;
  const DrawResult plain = draw(Profile::compatibility, request);
  ASSERT_EQ(plain.error, "");
  ASSERT_NE(plain.outputs[1], std::vector<std::uint32_t>(kPixels * 4, 0));

  Probe probe;
  probe.statement = shader.functions[static_cast<std::size_t>(shader.main)].body;
  const auto instrumented = instrumentSingle(shader, probe, target(2));
  ASSERT_TRUE(std::holds_alternative<AttachmentShader>(instrumented));
  request.text = std::get<AttachmentShader>(instrumented).text;
  request.capture = std::get<AttachmentShader>(instrumented).layout;
  const DrawResult result = draw(Profile::compatibility, request);
  ASSERT_EQ(result.error, "");
  EXPECT_EQ(result.outputs, plain.outputs) << request.text;
  EXPECT_EQ(decodeMark(request.capture, result.captured[0].data()), kLaunched | kReached);
}

TEST(TwoDrawBuffers, GlFragColorGoesToBoth) {
  expectSameOutputs(
      "#version 120\nvarying vec2 place;\nvoid main() { gl_FragColor = place.xyxy; gl_FragColor.b += 1.0; }");
}

TEST(TwoDrawBuffers, GlFragDataGoesToEach) {
  expectSameOutputs(
      "#version 120\nvarying vec2 place;\n"
      "void main() { gl_FragData[0] = place.xyxy; gl_FragData[1] = gl_FragData[0] * 2.0; gl_FragData[2] = "
      "vec4(9.0); }");
}

}  // namespace
}  // namespace shadestep::instrumenter::test
