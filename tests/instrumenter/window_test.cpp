// A window's probes against single probes: all pixels, bit for bit, with the outputs of the bare shader.
#include <gtest/gtest.h>

#include "osmesa_draw.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::CallId;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using When = Probe::When;

constexpr int kWatchedWords = 8;

// Every way from main into a function.
std::vector<std::vector<CallId>> pathsInto(const Shader& shader, frontend::FunctionId function) {
  if (function == shader.main) return {{}};
  std::vector<std::vector<CallId>> paths;
  for (std::size_t i = 0; i < shader.calls.size(); ++i) {
    if (shader.calls[i].callee != function || shader.calls[i].statement == frontend::kNone) continue;
    for (std::vector<CallId> path : pathsInto(shader, shader.calls[i].caller)) {
      path.push_back(static_cast<CallId>(i));
      paths.push_back(std::move(path));
    }
  }
  return paths;
}

// What a variable holds before it is written is undefined, and so may differ from text to text: those that
// have a value from the beginning.
bool initialized(const Shader& shader, frontend::VariableId id) {
  const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  if (variable.storage == frontend::Storage::in) return true;
  if (variable.storage == frontend::Storage::parameter) return variable.parameter_in;
  if (variable.storage == frontend::Storage::global) return true;  // all of these bodies initialize them
  for (const Statement& statement : shader.statements)
    for (const frontend::Declarator& declarator : statement.declarators)
      if (declarator.variable == id) return !declarator.initializer.empty();
  return false;
}

std::vector<frontend::Watch> someOfScope(const Shader& shader, StatementId id) {
  std::vector<frontend::Watch> watches;
  int words = 0;
  const std::vector<frontend::VariableId>& scope = shader.statements[static_cast<std::size_t>(id)].scope;
  for (auto variable = scope.rbegin(); variable != scope.rend(); ++variable) {
    const frontend::WatchResult found =
        frontend::resolveWatch(shader, id, shader.variables[static_cast<std::size_t>(*variable)].name);
    if (!found.watch || !initialized(shader, *variable)) continue;
    const int more = frontend::wordCount(found.watch->type);
    if (more == 0 || words + more > kWatchedWords) continue;
    words += more;
    watches.push_back(*found.watch);
  }
  return watches;
}

// A probe at every place and by every path, each in an iteration of its own.
std::vector<Probe> everyProbe(const Shader& shader) {
  std::vector<Probe> probes;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const Statement& statement = shader.statements[i];
    if (statement.kind == StatementKind::block || statement.kind == StatementKind::case_label) continue;
    if (statement.function == frontend::kNone) continue;
    const bool jumps = statement.kind == StatementKind::return_ || statement.kind == StatementKind::break_ ||
                       statement.kind == StatementKind::continue_ || statement.kind == StatementKind::discard;
    const bool decides = statement.kind == StatementKind::if_ || statement.kind == StatementKind::for_ ||
                         statement.kind == StatementKind::while_ ||
                         statement.kind == StatementKind::do_while ||
                         statement.kind == StatementKind::switch_;
    for (const std::vector<CallId>& path : pathsInto(shader, statement.function)) {
      for (const When when : {When::before, When::after}) {
        if (jumps && when == When::after) continue;
        Probe probe;
        probe.when = when;
        probe.statement = static_cast<StatementId>(i);
        probe.call_path = path;
        probe.outcome = decides && when == When::after;
        probe.watches = someOfScope(shader, probe.statement);
        const std::size_t loops = numberedLoops(shader, probe).size();
        for (std::size_t loop = 0; loop < loops; ++loop)
          probe.iterations.push_back(static_cast<int>((probes.size() + loop) % 3));
        probes.push_back(std::move(probe));
      }
    }
  }
  return probes;
}

WindowShader window(const Shader& shader, const std::vector<Probe>& probes) {
  auto instrumented = instrumentWindow(shader, probes, target());
  if (auto* failure = std::get_if<Failure>(&instrumented)) throw std::runtime_error(failure->reason);
  return std::get<WindowShader>(std::move(instrumented));
}

DrawResult drawn(const Dialect& dialect, const WindowShader& shader, std::size_t chosen,
                 const std::vector<int>& iterations) {
  DrawRequest request;
  request.text = shader.text;
  request.user_outputs = dialect.outputs();
  request.capture = shader.layout.capture;
  frontend::Type integer;
  integer.basic = frontend::Basic::int_;
  request.uniforms[shader.layout.probe_uniform] = {integer, {static_cast<std::uint32_t>(chosen)}};
  for (std::size_t i = 0; i < iterations.size(); ++i)
    request.uniforms[shader.layout.iteration_uniforms.at(i)] = {integer,
                                                                {static_cast<std::uint32_t>(iterations[i])}};
  return draw(dialect.profile, request);
}

DrawResult drawn(const Dialect& dialect, const AttachmentShader& shader) {
  DrawRequest request;
  request.text = shader.text;
  request.user_outputs = dialect.outputs();
  request.capture = shader.layout;
  return draw(dialect.profile, request);
}

AttachmentShader single(const Shader& shader, const Probe& probe) {
  auto instrumented = instrumentSingle(shader, probe, target());
  if (auto* failure = std::get_if<Failure>(&instrumented)) throw std::runtime_error(failure->reason);
  return std::get<AttachmentShader>(std::move(instrumented));
}

// The number of threads that got to the probe.
std::size_t expectSame(const AttachmentLayout& layout, const DrawResult& result,
                       const AttachmentLayout& single_layout, const DrawResult& single_result) {
  EXPECT_EQ(layout.words, single_layout.words);
  std::size_t reached = 0;
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    const std::vector<std::uint32_t>& words = result.captured[pixel];
    const std::vector<std::uint32_t>& expected = single_result.captured[pixel];
    const std::uint32_t mark = decodeMark(layout, words.data());
    EXPECT_EQ(mark, decodeMark(single_layout, expected.data())) << "pixel " << pixel;
    if ((mark & kReached) == 0) continue;  // its words mean nothing
    ++reached;
    const auto used = static_cast<std::ptrdiff_t>(layout.words);
    EXPECT_TRUE(std::equal(words.begin(), words.begin() + used, expected.begin())) << "pixel " << pixel;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_EQ(result.outputs, single_result.outputs);
  return reached;
}

class Window : public testing::TestWithParam<std::tuple<Dialect, Body>> {};

TEST_P(Window, ProbesAreWhatTheyAreAlone) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  const std::vector<Probe> probes = everyProbe(shader);
  const WindowShader together = window(shader, probes);
  DrawRequest bare;
  bare.text = uninstrumented(shader);
  bare.user_outputs = dialect.outputs();
  const DrawResult plain = draw(dialect.profile, bare);

  std::size_t met = 0;
  for (std::size_t i = 0; i < probes.size(); i += 5) {
    const AttachmentShader alone = single(shader, probes[i]);
    const DrawResult expected = drawn(dialect, alone);
    ASSERT_EQ(expected.error, "");
    const DrawResult result = drawn(dialect, together, i, probes[i].iterations);
    ASSERT_EQ(result.error, "");
    met += expectSame(together.layout.probes[i], result, alone.layout, expected) > 0 ? 1 : 0;
    EXPECT_EQ(result.outputs, plain.outputs);
    ASSERT_FALSE(HasFailure()) << "probe " << i << " at line "
                               << shader.statements[static_cast<std::size_t>(probes[i].statement)].place.line
                               << "\n"
                               << together.text << "\nalone:\n"
                               << alone.text;
  }
  EXPECT_GE(met, 2u);
}

INSTANTIATE_TEST_SUITE_P(
    All, Window, testing::Combine(testing::Values(kGlsl120, kGlsl330, kEs310), testing::ValuesIn(kBodies)),
    [](const auto& parameters) {
      return std::get<0>(parameters.param).name + "_" + std::get<1>(parameters.param).name;
    });

TEST(WindowText, ServesEveryIteration) {
  const Shader shader = analysed(kGlsl330.text(kNested.text));
  Probe probe;
  probe.statement = named(shader, "inner");
  probe.watches = someOfScope(shader, probe.statement);
  probe.iterations = {0, 0};
  const WindowShader together = window(shader, {probe});
  std::size_t met = 0;
  for (int i = 0; i < 4; ++i) {
    probe.iterations = {i % 2, i};
    const AttachmentShader alone = single(shader, probe);
    met += expectSame(together.layout.probes[0], drawn(kGlsl330, together, 0, probe.iterations), alone.layout,
                      drawn(kGlsl330, alone)) > 0
               ? 1
               : 0;
  }
  EXPECT_GE(met, 3u);
}

TEST(WindowText, CapturesNothingForANumberThatNoProbeHas) {
  const Shader shader = analysed(kGlsl330.text(kLoops.text));
  Probe probe;
  probe.statement = named(shader, "end");
  const WindowShader together = window(shader, {probe});
  const DrawResult result = drawn(kGlsl330, together, 1, {});
  ASSERT_EQ(result.error, "");
  for (const std::vector<std::uint32_t>& words : result.captured)
    ASSERT_EQ(decodeMark(together.layout.capture, words.data()), kLaunched);
}

TEST(WindowText, RefusesWhatDoesNotFit) {
  const Shader shader = analysed(kGlsl330.text(kValues.text));
  Probe probe;
  probe.statement = named(shader, "end");
  for (const char* name : {"m", "inverse_m", "ray", "ray"})
    probe.watches.push_back(*frontend::resolveWatch(shader, probe.statement, name).watch);
  Target small = target();
  small.max_draw_buffers = 5;
  const auto instrumented = instrumentWindow(shader, {probe}, small);
  ASSERT_TRUE(std::holds_alternative<Failure>(instrumented));
  EXPECT_NE(std::get<Failure>(instrumented).reason.find("'ray'"), std::string::npos);
}

TEST(WindowText, RefusesAnyCallBesideACertainOne) {
  const Shader shader = analysed(kGlsl330.text(kFunctions.text));
  Probe any;
  any.statement = named(shader, "halve");
  Probe certain = any;
  certain.call_path =
      pathsInto(shader, shader.statements[static_cast<std::size_t>(any.statement)].function).front();
  const auto instrumented = instrumentWindow(shader, {any, certain}, target());
  ASSERT_TRUE(std::holds_alternative<Failure>(instrumented));
  EXPECT_NE(std::get<Failure>(instrumented).reason.find("'half_of'"), std::string::npos);
}

}  // namespace
}  // namespace shadestep::instrumenter::test
