// Two plans, one truth: every record of a recording equals what a single probe captures at that step. And
// neither plan changes the shader's outputs.
#include <gtest/gtest.h>

#include <map>

#include "osmesa_draw.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::CallId;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;

constexpr std::uint32_t kRoom = 4096;

struct Recorded {
  RecordingShader shader;
  DrawResult result;
  Recording recording;
};

Recorded record(const Dialect& dialect, const Shader& shader, int x, int y, int width, int height,
                std::uint32_t room = kRoom) {
  Recorded recorded;
  auto instrumented = instrumentRecording(shader, target());
  if (auto* failure = std::get_if<Failure>(&instrumented)) throw std::runtime_error(failure->reason);
  recorded.shader = std::get<RecordingShader>(instrumented);
  const RecordingLayout& layout = recorded.shader.layout;

  DrawRequest request;
  request.text = recorded.shader.text;
  request.user_outputs = dialect.outputs();
  request.capture = layout.attachment;
  request.storage_block = layout.block;
  const auto threads = static_cast<std::uint32_t>(width * height);
  request.storage.resize(kRecordingHeader + threads * room);
  request.storage[1] = room;
  request.storage[2] = threads;
  frontend::Type pixel;
  pixel.basic = frontend::Basic::int_;
  pixel.rows = 4;
  request.uniforms[layout.pixel_uniform] = {
      pixel,
      {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(width),
       static_cast<std::uint32_t>(height)}};
  recorded.result = draw(dialect.profile, request);
  if (!recorded.result.error.empty()) throw std::runtime_error(recorded.result.error);
  recorded.recording = decodeRecording(layout, recorded.result.storage);
  return recorded;
}

DrawResult plain(const Dialect& dialect, const Shader& shader) {
  DrawRequest request;
  request.text = uninstrumented(shader);
  request.user_outputs = dialect.outputs();
  return draw(dialect.profile, request);
}

// A step of a recording as a probe that must capture the same.
struct Step {
  StatementId statement;
  std::vector<CallId> call_path;
  std::vector<int> iterations;
  const Record* record;
};

// Follows a recording through functions and loops. A function that a statement calls twice, or a `for` in its
// head, is followed with its call unknown: its steps are left out.
class Follower {
 public:
  Follower(const Shader& shader, const RecordingLayout& layout) : shader_(shader), layout_(layout) {}

  std::vector<Step> follow(const ThreadRecording& thread) {
    std::vector<Step> steps;
    for (const Record& record : thread.records) {
      const RecordLayout& layout = layout_.records[static_cast<std::size_t>(record.layout)];
      advance(layout);
      if (layout.event == Event::statement || layout.event == Event::condition) {
        Step step{layout.statement, {}, {}, &record};
        if (describe(step)) steps.push_back(step);
      }
      if (layout.event == Event::return_ || layout.event == Event::function_leave) frames_.pop_back();
    }
    return steps;
  }

 private:
  struct Loop {
    StatementId statement;
    int iteration;
  };
  struct Frame {
    CallId call = frontend::kNone;  // that led here
    bool known = true;
    std::vector<Loop> loops;                // entered and not left
    StatementId calling = frontend::kNone;  // the statement that is being run, if it calls functions
  };

  const Statement& at(StatementId id) const { return shader_.statements[static_cast<std::size_t>(id)]; }
  bool isLoop(StatementId id) const {
    const StatementKind kind = at(id).kind;
    return kind == StatementKind::for_ || kind == StatementKind::while_ || kind == StatementKind::do_while;
  }
  bool encloses(StatementId loop, StatementId id) const {
    while (id != frontend::kNone && id != loop) id = at(id).parent;
    return id == loop;
  }

  void advance(const RecordLayout& layout) {
    if (layout.event == Event::function_enter) return enter(layout.function);
    Frame& frame = frames_.back();
    while (!frame.loops.empty() && !encloses(frame.loops.back().statement, layout.statement))
      frame.loops.pop_back();
    const bool begins = layout.event == Event::before;
    frame.calling = begins ? layout.statement : frontend::kNone;
    if (!isLoop(layout.statement)) return;
    if (begins) frame.loops.push_back({layout.statement, -1});
    const Event counted =
        at(layout.statement).kind == StatementKind::do_while ? Event::iteration : Event::condition;
    if (layout.event == counted) ++frame.loops.back().iteration;
  }

  void enter(frontend::FunctionId function) {
    Frame frame;
    if (!frames_.empty()) {
      Frame& caller = frames_.back();
      // Between the statements of a loop, it is the loop's condition that calls.
      if (caller.calling == frontend::kNone && !caller.loops.empty())
        caller.calling = caller.loops.back().statement;
      std::vector<CallId> candidates;
      if (caller.calling != frontend::kNone && at(caller.calling).kind != StatementKind::for_)
        for (const CallId call : at(caller.calling).calls)
          if (shader_.calls[static_cast<std::size_t>(call)].callee == function) candidates.push_back(call);
      frame.known = caller.known && candidates.size() == 1;
      if (frame.known) frame.call = candidates.front();
    }
    frames_.push_back(frame);
  }

  bool describe(Step& step) const {
    for (const Frame& frame : frames_) {
      if (!frame.known) return false;
      if (frame.call != frontend::kNone) step.call_path.push_back(frame.call);
      for (const Loop& loop : frame.loops) {
        // What a condition calls runs before the record that counts it.
        const bool ahead = &frame != &frames_.back() && frame.calling == loop.statement &&
                           at(loop.statement).kind == StatementKind::while_;
        step.iterations.push_back(loop.iteration + (ahead ? 1 : 0));
      }
    }
    return true;
  }

  const Shader& shader_;
  const RecordingLayout& layout_;
  std::vector<Frame> frames_;
};

class Agreement : public testing::TestWithParam<std::tuple<Dialect, Body>> {};

TEST_P(Agreement, RecordingLeavesOutputsAndEnds) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  const DrawResult bare = plain(dialect, shader);
  ASSERT_EQ(bare.error, "");
  const Recorded recorded = record(dialect, shader, 0, 0, kSize, kSize);
  EXPECT_EQ(recorded.result.outputs, bare.outputs) << recorded.shader.text;
  ASSERT_EQ(recorded.recording.error, "") << recorded.shader.text;
  ASSERT_EQ(recorded.recording.threads.size(), static_cast<std::size_t>(kPixels));

  std::vector<int> seen(kPixels);
  for (const ThreadRecording& thread : recorded.recording.threads) {
    EXPECT_TRUE(thread.complete);
    const auto pixel = static_cast<std::size_t>(thread.y * kSize + thread.x);
    ++seen.at(pixel);
    // Every shader here covers the whole target, and writes something else than zeros.
    const bool empty = bare.outputs[0][pixel * 4] == 0 && bare.outputs[0][pixel * 4 + 3] == 0;
    EXPECT_EQ(thread.discarded, empty && body.name == "discard") << thread.x << "," << thread.y;
    const AttachmentLayout& layout = recorded.shader.layout.attachment;
    const std::vector<std::uint32_t>& words = recorded.result.captured[pixel];
    if (!thread.discarded) {
      EXPECT_EQ(decodeMark(layout, words.data()), kLaunched | kReached);
      EXPECT_EQ(decode(layout, layout.fields[0], words.data()).words[0], thread.invocation);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(kPixels, 1));
}

TEST_P(Agreement, SingleEqualsRecordingBitForBit) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  const Recorded recorded = record(dialect, shader, 6, 2, 1, 1);
  ASSERT_EQ(recorded.recording.error, "");
  ASSERT_EQ(recorded.recording.threads.size(), 1u);
  ASSERT_FALSE(recorded.recording.threads[0].discarded);

  const std::vector<Step> steps =
      Follower(shader, recorded.shader.layout).follow(recorded.recording.threads[0]);
  EXPECT_GE(steps.size(), 5u);
  // Of what runs often, a few iterations are enough.
  std::map<StatementId, int> checked;
  for (const Step& step : steps) {
    if (++checked[step.statement] > 4) continue;
    const RecordLayout& layout =
        recorded.shader.layout.records[static_cast<std::size_t>(step.record->layout)];
    Probe probe;
    probe.when = Probe::When::after;
    probe.statement = step.statement;
    probe.call_path = step.call_path;
    probe.iterations = step.iterations;
    const frontend::VariableId declared = frontend::declaredByCondition(shader, step.statement);
    for (const Field& field : layout.fields) {
      if (field.name.empty())
        probe.outcome = true;
      else if (declared != frontend::kNone &&
               field.name == shader.variables[static_cast<std::size_t>(declared)].name)
        EXPECT_EQ(step.record->values.back(), step.record->values.front());  // the outcome is its value
      else
        probe.watches.push_back(frontend::Watch{field.name, frontend::kNone, field.type});
    }
    const auto single = instrumentSingle(shader, probe, target());
    ASSERT_TRUE(std::holds_alternative<AttachmentShader>(single)) << std::get<Failure>(single).reason;
    const auto& instrumented = std::get<AttachmentShader>(single);
    DrawRequest request;
    request.text = instrumented.text;
    request.user_outputs = dialect.outputs();
    request.capture = instrumented.layout;
    const DrawResult result = draw(dialect.profile, request);
    ASSERT_EQ(result.error, "");
    const std::vector<std::uint32_t>& words = result.captured[2 * kSize + 6];
    EXPECT_EQ(decodeMark(instrumented.layout, words.data()), kLaunched | kReached) << instrumented.text;
    for (std::size_t i = 0; i < instrumented.layout.fields.size(); ++i)
      EXPECT_EQ(decode(instrumented.layout, instrumented.layout.fields[i], words.data()),
                step.record->values[i])
          << instrumented.layout.fields[i].name << " at line "
          << shader.statements[static_cast<std::size_t>(step.statement)].place.line << "\n"
          << instrumented.text;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Agreement,
                         testing::Combine(testing::ValuesIn(kDialects), testing::ValuesIn(kBodies)),
                         [](const auto& parameters) {
                           return std::get<0>(parameters.param).name + "_" +
                                  std::get<1>(parameters.param).name;
                         });

TEST(RecordingRoom, SaysHowMuchIsWanted) {
  const Shader shader = analysed(kGlsl330.text(kLoops.text));
  const Recorded full = record(kGlsl330, shader, 3, 3, 1, 1);
  const Recorded tight = record(kGlsl330, shader, 3, 3, 1, 1, 20);
  ASSERT_EQ(tight.recording.error, "");
  const ThreadRecording& all = full.recording.threads.at(0);
  const ThreadRecording& some = tight.recording.threads.at(0);
  EXPECT_FALSE(some.complete);
  EXPECT_EQ(some.wanted, all.wanted);
  ASSERT_GT(some.records.size(), 0u);
  ASSERT_LT(some.records.size(), all.records.size());
  for (std::size_t i = 0; i < some.records.size(); ++i) {
    EXPECT_EQ(some.records[i].layout, all.records[i].layout);
    EXPECT_EQ(some.records[i].values, all.records[i].values);
  }
}

TEST(RecordingRoom, RecordsOnlyTheChosenPixels) {
  const Shader shader = analysed(kGlsl330.text(kLoops.text));
  const Recorded recorded = record(kGlsl330, shader, 3, 7, 2, 3);
  EXPECT_EQ(recorded.recording.started, 6u);
  for (const ThreadRecording& thread : recorded.recording.threads) {
    EXPECT_TRUE(thread.x == 3 || thread.x == 4);
    EXPECT_TRUE(thread.y >= 7 && thread.y < 10);
  }
}

}  // namespace
}  // namespace shadestep::instrumenter::test
