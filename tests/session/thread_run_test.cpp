// From records to steps: iterations, call depth, and what really changed, on a recording made by hand.
#include "session/thread_run.h"

#include <gtest/gtest.h>

#include <bit>

namespace shadestep::session {
namespace {

using frontend::StatementKind;
using instrumenter::Event;

// A shader by hand: main { x = 1 (0); for (1) { call f (2) } } and f { y (3); return (4) }.
struct Fixture {
  frontend::Shader shader;
  instrumenter::RecordingLayout layout;
  instrumenter::ThreadRecording thread;

  int statement(StatementKind kind, int line, int function, int parent) {
    frontend::Statement one;
    one.kind = kind;
    one.place = {line, 1};
    one.function = function;
    one.parent = parent;
    one.scope = std::vector<frontend::VariableId>{0, 1};
    shader.statements.push_back(one);
    return static_cast<int>(shader.statements.size()) - 1;
  }

  int record(Event event, int statement, int function, std::vector<std::string> fields) {
    instrumenter::RecordLayout one;
    one.event = event;
    one.statement = statement;
    one.function = function;
    for (const std::string& name : fields) {
      instrumenter::Field field;
      field.name = name;
      field.type.basic = name.empty() ? frontend::Basic::bool_ : frontend::Basic::int_;
      field.first_word = one.words++;
      one.fields.push_back(field);
    }
    layout.records.push_back(one);
    return static_cast<int>(layout.records.size()) - 1;
  }

  void happens(int record, std::vector<std::uint32_t> words) {
    instrumenter::Record one;
    one.layout = record;
    const auto& fields = layout.records[static_cast<std::size_t>(record)].fields;
    for (std::size_t i = 0; i < words.size(); ++i) one.values.push_back({fields[i].type, {words[i]}});
    thread.records.push_back(one);
  }

  Fixture() {
    frontend::Variable x;
    x.name = "x";
    x.storage = frontend::Storage::local;
    frontend::Variable y = x;
    y.name = "y";
    y.storage = frontend::Storage::global;
    shader.variables = {x, y};
    frontend::Function main;
    main.name = "main";
    main.is_main = true;
    frontend::Function f;
    f.name = "f";
    shader.functions = {main, f};
    shader.main = 0;
  }
};

TEST(StepsOf, CountsIterationsAndFollowsCalls) {
  Fixture f;
  const int assign = f.statement(StatementKind::expression, 1, 0, frontend::kNone);
  const int loop = f.statement(StatementKind::for_, 2, 0, frontend::kNone);
  const int call = f.statement(StatementKind::expression, 3, 0, loop);
  const int body = f.statement(StatementKind::expression, 10, 1, frontend::kNone);
  const int after = f.statement(StatementKind::expression, 5, 0, frontend::kNone);

  const int enter_main = f.record(Event::function_enter, frontend::kNone, 0, {});
  const int assigned = f.record(Event::statement, assign, 0, {"x"});
  const int before_loop = f.record(Event::before, loop, 0, {});
  const int condition = f.record(Event::condition, loop, 0, {"", "x"});
  const int iteration = f.record(Event::iteration, loop, 0, {});
  const int before_call = f.record(Event::before, call, 0, {});
  const int enter_f = f.record(Event::function_enter, frontend::kNone, 1, {});
  const int in_f = f.record(Event::statement, body, 1, {"y"});
  const int leave_f = f.record(Event::function_leave, frontend::kNone, 1, {});
  const int called = f.record(Event::statement, call, 0, {"y"});
  const int end = f.record(Event::statement, after, 0, {"x"});

  f.happens(enter_main, {});
  f.happens(assigned, {1});
  f.happens(before_loop, {});
  for (std::uint32_t i = 0; i < 2; ++i) {
    f.happens(condition, {1, 1 + i});
    f.happens(iteration, {});
    f.happens(before_call, {});
    f.happens(enter_f, {});
    f.happens(in_f, {40 + i});
    f.happens(leave_f, {});
    f.happens(called, {40 + i});
  }
  f.happens(condition, {0, 3});
  f.happens(end, {3});

  const std::vector<Step> steps = stepsOf(f.shader, f.layout, f.thread);
  ASSERT_EQ(steps.size(), 1u + 2u * 6u + 2u);
  EXPECT_EQ(steps[0].line, 1);
  EXPECT_EQ(steps[0].changed.size(), 1u);
  EXPECT_EQ(steps[1].kind, Step::Kind::condition);
  EXPECT_EQ(steps[1].outcome, "true");
  EXPECT_EQ(steps[1].iteration, std::vector<int>{0});
  EXPECT_TRUE(steps[1].changed.empty()) << "x is 1 as before";
  EXPECT_EQ(steps[2].kind, Step::Kind::call);
  EXPECT_EQ(steps[3].kind, Step::Kind::enter);
  EXPECT_EQ(steps[4].function, "f");
  EXPECT_EQ(steps[4].depth, 1);
  EXPECT_EQ(steps[4].iteration, std::vector<int>{0}) << "the caller's loop counts in the callee";
  EXPECT_EQ(steps[6].depth, 0);
  EXPECT_TRUE(steps[6].changed.empty()) << "y was shown as changed inside f";
  EXPECT_EQ(steps[7].iteration, std::vector<int>{1});
  ASSERT_EQ(steps[7].changed.size(), 1u);
  EXPECT_EQ(steps[7].changed[0].value.words[0], 2u);
  EXPECT_EQ(steps[13].outcome, "false");
  EXPECT_EQ(steps[13].iteration, std::vector<int>{2});
  EXPECT_TRUE(steps[14].iteration.empty()) << "after the loop";
}

}  // namespace
}  // namespace shadestep::session
