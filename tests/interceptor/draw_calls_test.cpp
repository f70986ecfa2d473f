// The wrappers on a driver and hooks of the test's own: what onDraw is told, what replay repeats, what passes
// through.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/dispatch/resolve.h"
#include "interceptor/registry/gl_declarations.h"

namespace {

using testing::ElementsAre;

struct Told {
  std::string name;
  std::uint32_t mode;
  std::int64_t count, instances;
  bool replayable;
};
std::vector<Told> told;
std::vector<std::string> made;  // calls that reached the driver

bool replayOnce = false;

std::string joined(std::initializer_list<std::uintptr_t> values) {
  std::string text;
  for (const std::uintptr_t value : values) text += ' ' + std::to_string(value);
  return text;
}

}  // namespace

namespace shadestep::dispatch {

constinit thread_local unsigned driverDepth = 0;

Function resolveGl(unsigned, Function missing) {
  return missing;
}
Function resolveGlx(unsigned, Function missing) {
  return missing;
}
Function resolveEgl(unsigned, Function missing) {
  return missing;
}
Function resolveOsmesa(unsigned, Function missing) {
  return missing;
}

}  // namespace shadestep::dispatch

namespace shadestep::calls {

void onDraw(const DrawCall& call) {
  told.push_back({call.name, call.mode, call.count, call.instances, call.replay != nullptr});
  if (replayOnce && call.replay) call.replay(call.arguments, call.mode);
}

}  // namespace shadestep::calls

namespace {

class DrawCalls : public testing::Test {
 protected:
  void SetUp() override {
    told.clear();
    made.clear();
    replayOnce = false;
    auto& driver = *shadestep::dispatch::currentTable;
    driver.DrawElementsInstancedBaseVertexBaseInstance = [](GLenum mode, GLsizei count, GLenum type,
                                                            const void* indices, GLsizei instances,
                                                            GLint vertex, GLuint instance) {
      made.push_back(
          "elements" +
          joined({mode, static_cast<std::uintptr_t>(count), type, reinterpret_cast<std::uintptr_t>(indices),
                  static_cast<std::uintptr_t>(instances), static_cast<std::uintptr_t>(vertex), instance}));
    };
    driver.MultiDrawArrays = [](GLenum, const GLint*, const GLsizei*, GLsizei) { made.push_back("multi"); };
    driver.DrawArraysInstancedARB = [](GLenum, GLint, GLsizei, GLsizei) { made.push_back("arb"); };
    driver.DrawArraysIndirect = [](GLenum, const void*) { made.push_back("indirect"); };
    driver.Rectd = [](GLdouble a, GLdouble b, GLdouble c, GLdouble d) {
      made.push_back("rect" + joined({static_cast<std::uintptr_t>(a), static_cast<std::uintptr_t>(b),
                                      static_cast<std::uintptr_t>(c), static_cast<std::uintptr_t>(d)}));
    };
    driver.GetString = [](GLenum name) {
      made.push_back("string" + joined({name}));
      return reinterpret_cast<const GLubyte*>("a driver");
    };
  }
};

MATCHER_P5(IsDraw, name, mode, count, instances, replayable, "") {
  return arg.name == name && arg.mode == static_cast<std::uint32_t>(mode) && arg.count == count &&
         arg.instances == instances && arg.replayable == replayable;
}

TEST_F(DrawCalls, TellsModeCountAndInstances) {
  glDrawElementsInstancedBaseVertexBaseInstance(4, 33, 5, nullptr, 7, 1, 2);
  EXPECT_THAT(told, ElementsAre(IsDraw("glDrawElementsInstancedBaseVertexBaseInstance", 4, 33, 7, true)));
}

TEST_F(DrawCalls, SumsTheParts) {
  const GLint first[] = {0, 3, 9};
  const GLsizei count[] = {3, 6, 300};
  glMultiDrawArrays(5, first, count, 3);
  EXPECT_THAT(told, ElementsAre(IsDraw("glMultiDrawArrays", 5, 309, 1, true)));
}

TEST_F(DrawCalls, AliasesDrawAsTheirOriginals) {
  glDrawArraysInstancedARB(6, 0, 12, 3);
  EXPECT_THAT(told, ElementsAre(IsDraw("glDrawArraysInstancedARB", 6, 12, 3, true)));
  EXPECT_THAT(made, ElementsAre("arb"));
}

TEST_F(DrawCalls, SaysWhatIsNotKnown) {
  glDrawArraysIndirect(4, nullptr);
  glBitmap(0, 0, 0, 0, 0, 0, nullptr);
  glRectd(1, 2, 3, 4);
  EXPECT_THAT(told, ElementsAre(IsDraw("glDrawArraysIndirect", 4, -1, -1, true),
                                IsDraw("glBitmap", shadestep::calls::kNoMode, -1, 1, false),
                                IsDraw("glRectd", shadestep::calls::kNoMode, -1, 1, true)));
}

TEST_F(DrawCalls, ReplaysTheSameCallAndThenMakesIt) {
  replayOnce = true;
  int place = 0;
  glDrawElementsInstancedBaseVertexBaseInstance(1, 2, 3, &place, 5, -6, 7);
  const std::string call = "elements" + joined({1, 2, 3, reinterpret_cast<std::uintptr_t>(&place), 5,
                                                static_cast<std::uintptr_t>(-6), 7});
  EXPECT_THAT(made, ElementsAre(call, call));
  glRectd(1, 2, 3, 4);
  EXPECT_THAT(made, ElementsAre(call, call, "rect 1 2 3 4", "rect 1 2 3 4"));
}

TEST_F(DrawCalls, TheDriversOwnDrawsAreToldToNobody) {
  shadestep::dispatch::inDriver([] { glRectd(1, 2, 3, 4); });
  EXPECT_TRUE(told.empty());
  EXPECT_THAT(made, ElementsAre("rect 1 2 3 4"));
}

TEST_F(DrawCalls, OtherCallsPassThroughWithTheirResult) {
  EXPECT_STREQ(reinterpret_cast<const char*>(glGetString(17)), "a driver");
  EXPECT_THAT(made, ElementsAre("string 17"));
  EXPECT_TRUE(told.empty());
}

TEST_F(DrawCalls, WhatTheDriverLacksReturnsZero) {
  EXPECT_EQ(glGetUniformLocation(1, "x"), 0);
}

}  // namespace
