// What a recording says about the places that a thread came by, on a real layout and a run made by hand.
#include "session/recorded_visits.h"

#include <gtest/gtest.h>

#include <bit>

namespace shadestep::session {
namespace {

using instrumenter::Event;
using instrumenter::Probe;

constexpr const char* kShader = R"(#version 330
out vec4 color;
float g;
void main() {
  float x;
  for (int i = 0; i < 2; ++i) {
    x = float(i);
    g = x + 1.0;
  }
  if (g > 1.5)
    color = vec4(g);
}
)";

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

class RecordedVisits : public testing::Test {
 protected:
  RecordedVisits() {
    auto analysis = frontend::analyse(frontend::Stage::fragment, {kShader}, {});
    shader = std::move(*analysis.shader);
    instrumenter::Target target;
    target.storage_buffers = true;
    target.bit_encoding = true;
    auto recording = instrumenter::instrumentRecording(shader, target);
    layout = std::get<instrumenter::RecordingShader>(recording).layout;
  }

  // The thread makes the record that the layout has for this event at this line.
  void happens(Event event, int line, const std::vector<std::uint32_t>& words) {
    for (std::size_t i = 0; i < layout.records.size(); ++i) {
      const instrumenter::RecordLayout& one = layout.records[i];
      const int at = one.statement == frontend::kNone
                         ? 0
                         : shader.statements[static_cast<std::size_t>(one.statement)].place.line;
      if (one.event != event || at != line) continue;
      instrumenter::Record record;
      record.layout = static_cast<int>(i);
      ASSERT_EQ(one.fields.size(), words.size()) << "line " << line;
      for (std::size_t w = 0; w < words.size(); ++w)
        record.values.push_back({one.fields[w].type, {words[w]}});
      thread.records.push_back(record);
      return;
    }
    FAIL() << "no record at line " << line;
  }

  // x holds garbage when it is declared.
  void run() {
    happens(Event::function_enter, 4, {});
    happens(Event::statement, 5, {bits(77)});
    happens(Event::before, 6, {});
    for (std::uint32_t i = 0; i < 2; ++i) {
      happens(Event::condition, 6, {1, i});
      happens(Event::iteration, 6, {});
      happens(Event::statement, 7, {bits(static_cast<float>(i))});
      happens(Event::statement, 8, {bits(static_cast<float>(i) + 1)});
    }
    happens(Event::condition, 6, {0, 2});
    happens(Event::condition, 10, {1});
  }

  std::optional<LastVisit> at(int line, Probe::When when, std::vector<int> iterations = {}) const {
    Probe probe;
    probe.statement = frontend::statementsAt(shader, line).front();
    probe.when = when;
    probe.iterations = std::move(iterations);
    return lastVisit(shader, layout, thread, probe);
  }

  // The variable's known word there; nothing if it is unknown or the thread never came by.
  std::optional<std::uint32_t> word(const std::optional<LastVisit>& visit, const std::string& name) const {
    if (!visit) return std::nullopt;
    for (const auto& [id, known] : visit->known) {
      if (shader.variables[static_cast<std::size_t>(id)].name == name) return known.value.words.at(0);
    }
    return std::nullopt;
  }

  frontend::Shader shader;
  instrumenter::RecordingLayout layout;
  instrumenter::ThreadRecording thread;
};

TEST_F(RecordedVisits, HoldTheValuesBeforeAndAfterAStatement) {
  run();
  EXPECT_EQ(word(at(8, Probe::When::before), "x"), bits(1));
  EXPECT_EQ(word(at(8, Probe::When::before), "g"), bits(1));
  EXPECT_EQ(word(at(8, Probe::When::after), "g"), bits(2));
  EXPECT_EQ(word(at(8, Probe::When::before), "i"), 1u);
}

TEST_F(RecordedVisits, AreToldApartByIteration) {
  run();
  EXPECT_EQ(word(at(8, Probe::When::after, {0}), "g"), bits(1));
  EXPECT_EQ(word(at(7, Probe::When::before, {0}), "x"), bits(77));
  EXPECT_FALSE(at(8, Probe::When::after, {2}));
}

TEST_F(RecordedVisits, KnowTheOutcomeOfACondition) {
  run();
  const auto loop = at(6, Probe::When::after, {1});
  ASSERT_TRUE(loop && loop->outcome);
  EXPECT_EQ(loop->outcome->words, std::vector<std::uint32_t>{1});
  const auto left = at(6, Probe::When::after);
  ASSERT_TRUE(left && left->outcome);
  EXPECT_EQ(left->outcome->words, std::vector<std::uint32_t>{0});
  EXPECT_EQ(word(left, "i"), 2u);
}

TEST_F(RecordedVisits, EndWhereTheThreadWent) {
  run();
  EXPECT_TRUE(at(10, Probe::When::before));
  EXPECT_FALSE(at(11, Probe::When::before)) << "the run ends at the condition";
}

TEST_F(RecordedVisits, SayWhichWordsTheShaderNeverDefined) {
  run();
  const auto defined = [&](const std::optional<LastVisit>& visit, const std::string& name) {
    for (const auto& [id, known] : visit->known) {
      if (shader.variables[static_cast<std::size_t>(id)].name == name) return bool(known.defined.at(0));
    }
    return false;
  };
  EXPECT_FALSE(defined(at(7, Probe::When::before, {0}), "x"));
  EXPECT_TRUE(defined(at(7, Probe::When::after, {0}), "x"));
  EXPECT_TRUE(defined(at(8, Probe::When::after, {0}), "g"));
}

}  // namespace
}  // namespace shadestep::session
