// The record of contexts, with hooks of the test's own.
#include "interceptor/dispatch/contexts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "interceptor/calls/hooks.h"
#include "interceptor/dispatch/resolve.h"

namespace shadestep::dispatch {

constinit GlTable tables[4] = {};
constinit thread_local GlTable* currentTable = &tables[0];
constinit thread_local unsigned driverDepth = 0;

GlTable* tableOf(Provider provider) {
  return &tables[static_cast<int>(provider)];
}

}  // namespace shadestep::dispatch

namespace {

std::vector<void*> gone;
int changes = 0;

}  // namespace

namespace shadestep::calls {

void onContextCurrent() {
  ++changes;
}
void onContextGone(const dispatch::Context& context) {
  gone.push_back(context.handle);
}

}  // namespace shadestep::calls

namespace {

using namespace shadestep::dispatch;
using testing::ElementsAre;
using testing::IsEmpty;

class Contexts : public testing::Test {
 protected:
  void TearDown() override {
    for (const Provider provider : {Provider::glx, Provider::egl, Provider::osmesa}) {
      contextMadeCurrent(provider, {});
      for (char& handle : handles) contextDestroyed(provider, &handle);
    }
    gone.clear();
  }
  static void use(Provider provider, void* handle) { contextMadeCurrent(provider, {.handle = handle}); }

  char handles[4] = {};
  void* a = &handles[0];
  void* b = &handles[1];
  void* c = &handles[2];
};

TEST_F(Contexts, CallsGoToTheContextMadeCurrentLast) {
  contextCreated(Provider::glx, nullptr, a, nullptr);
  contextCreated(Provider::osmesa, nullptr, b, nullptr);
  EXPECT_EQ(currentContext(), nullptr);
  EXPECT_EQ(currentTable, tableOf(Provider::none));
  use(Provider::glx, a);
  EXPECT_EQ(currentTable, tableOf(Provider::glx));
  use(Provider::osmesa, b);
  EXPECT_EQ(currentContext()->handle, b);
  EXPECT_EQ(currentTable, tableOf(Provider::osmesa));
  use(Provider::osmesa, nullptr);
  EXPECT_EQ(currentContext()->handle, a);
  EXPECT_EQ(currentTable, tableOf(Provider::glx));
  use(Provider::glx, nullptr);
  EXPECT_EQ(currentContext(), nullptr);
  EXPECT_EQ(currentTable, tableOf(Provider::none));
}

TEST_F(Contexts, SharingIsTransitive) {
  const auto group = [](void* handle) {
    use(Provider::egl, handle);
    return currentContext()->share_group;
  };
  contextCreated(Provider::egl, nullptr, a, nullptr);
  contextCreated(Provider::egl, nullptr, b, a);
  contextCreated(Provider::egl, nullptr, c, b);
  EXPECT_EQ(group(a), group(c));
  EXPECT_NE(group(a), 0u);
  contextCreated(Provider::egl, nullptr, &handles[3], nullptr);
  EXPECT_NE(group(a), group(&handles[3]));
}

TEST_F(Contexts, ADestroyedContextLivesWhileItIsCurrent) {
  contextCreated(Provider::glx, nullptr, a, nullptr);
  use(Provider::glx, a);
  contextDestroyed(Provider::glx, a);
  EXPECT_THAT(gone, IsEmpty());
  EXPECT_EQ(currentContext()->handle, a);
  use(Provider::glx, nullptr);
  EXPECT_THAT(gone, ElementsAre(a));
}

TEST_F(Contexts, ANewContextAtAnOldAddressIsNew) {
  contextCreated(Provider::glx, nullptr, a, nullptr);
  use(Provider::glx, a);
  const auto before = currentContext()->share_group;
  contextDestroyed(Provider::glx, a);
  contextCreated(Provider::glx, nullptr, a, nullptr);
  use(Provider::glx, a);
  EXPECT_NE(currentContext()->share_group, before);
  EXPECT_THAT(gone, ElementsAre(a));
}

TEST_F(Contexts, AContextThatWentWithItsDisplayIsForgottenWhenItsAddressComesAgain) {
  contextCreated(Provider::egl, nullptr, a, nullptr);
  use(Provider::egl, a);
  const auto before = currentContext()->share_group;
  use(Provider::egl, nullptr);
  contextCreated(Provider::egl, nullptr, a, nullptr);
  use(Provider::egl, a);
  EXPECT_NE(currentContext()->share_group, before);
  EXPECT_THAT(gone, ElementsAre(a));
}

TEST_F(Contexts, BoundIsWhatTheThreadHoldsOfEachProvider) {
  use(Provider::glx, a);
  use(Provider::osmesa, b);
  EXPECT_TRUE(isBound(Provider::glx, a));
  EXPECT_TRUE(isBound(Provider::osmesa, b));
  EXPECT_FALSE(isBound(Provider::glx, b));
  use(Provider::glx, nullptr);
  EXPECT_FALSE(isBound(Provider::glx, a));
}

TEST_F(Contexts, ContextsOfUnknownOriginAreKnownWhenUsed) {
  contextMadeCurrent(Provider::osmesa, {.handle = a, .width = 30, .height = 20});
  EXPECT_EQ(currentProvider(), Provider::osmesa);
  EXPECT_EQ(currentContext()->width, 30);
  EXPECT_EQ(currentContext()->height, 20);
}

TEST_F(Contexts, EveryThreadHasItsOwn) {
  use(Provider::glx, a);
  std::thread([] {
    EXPECT_EQ(currentContext(), nullptr);
    EXPECT_EQ(currentTable, tableOf(Provider::none));
  }).join();
}

TEST_F(Contexts, EveryChangeIsTold) {
  const int before = changes;
  use(Provider::glx, a);
  use(Provider::glx, nullptr);
  EXPECT_EQ(changes, before + 2);
}

TEST_F(Contexts, AFailedCreationLeavesNothing) {
  contextCreated(Provider::glx, nullptr, nullptr, nullptr);
  contextMadeCurrent(Provider::glx, {});
  EXPECT_EQ(currentContext(), nullptr);
}

}  // namespace
