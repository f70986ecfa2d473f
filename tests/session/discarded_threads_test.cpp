// Discarded threads beside visible ones, on a target of 2 x 2 pixels with one attachment.
#include "session/discarded_threads.h"

#include <gtest/gtest.h>

#include <bit>

namespace shadestep::session {
namespace {

using instrumenter::AttachmentLayout;
using instrumenter::Carrier;

struct Listed {
  int x, y;
  float depth;
  std::uint32_t value;
};

// The target after the threads of a list that has room for `room` of them were added to it. Pixel 0,0 shows a
// thread with the value 9.
struct Target {
  AttachmentLayout layout;
  ThreadWords threads;
  std::string left_out;

  std::uint32_t word(float number) const {
    return layout.carrier == Carrier::float_attachments ? std::bit_cast<std::uint32_t>(number)
                                                        : static_cast<std::uint32_t>(number);
  }

  Target(Carrier carrier, const std::vector<Listed>& list, bool from_top = false, std::size_t room = 8) {
    layout.carrier = carrier;
    layout.words = 2;
    layout.discarded_block = "Discarded";
    layout.discarded_words = 8;
    threads = {2, 2, 2, std::vector<std::uint32_t>{word(3), 9, 0, 0, 0, 0, 0, 0}};
    std::vector<std::uint32_t> block = {static_cast<std::uint32_t>(list.size()),
                                        static_cast<std::uint32_t>(room), 0, 0};
    for (const Listed& one : list)
      for (const std::uint32_t next :
           {word(static_cast<float>(one.x)), word(static_cast<float>(one.y)),
            std::bit_cast<std::uint32_t>(one.depth), word(1), word(3), one.value, 0U, 0U})
        block.push_back(next);
    block.resize(4 + room * 8);
    left_out = addDiscarded(threads, layout, instrumenter::decodeDiscarded(layout, block), from_top);
  }

  std::uint32_t mark(int x, int y) const {
    return instrumenter::decodeMark(layout, threads.head(threads.index(x, y)));
  }
  std::uint32_t value(int x, int y) const { return threads.word(threads.index(x, y), 1); }
};

constexpr std::uint32_t kEnded = instrumenter::kLaunched | instrumenter::kReached | instrumenter::kDiscarded;

class DiscardedThreads : public testing::TestWithParam<Carrier> {};

TEST_P(DiscardedThreads, StandWhereNoOtherThreadIsShown) {
  const Target target(GetParam(), {{0, 0, 0.1F, 1}, {1, 0, 0.5F, 2}});
  EXPECT_EQ(target.mark(0, 0), instrumenter::kLaunched | instrumenter::kReached);
  EXPECT_EQ(target.value(0, 0), 9u);
  EXPECT_EQ(target.mark(1, 0), kEnded);
  EXPECT_EQ(target.value(1, 0), 2u);
  EXPECT_EQ(target.mark(0, 1), 0u);
  EXPECT_EQ(target.left_out, "");
}

TEST_P(DiscardedThreads, CountRowsAsTheShaderDoes) {
  const Target target(GetParam(), {{1, 0, 0.5F, 2}}, true);
  EXPECT_EQ(target.mark(1, 0), 0u);
  EXPECT_EQ(target.mark(1, 1), kEnded);
}

TEST_P(DiscardedThreads, OfSeveralTheNearestIsShown) {
  const Target target(GetParam(), {{1, 1, 0.5F, 1}, {1, 1, 0.25F, 2}, {1, 1, 0.75F, 3}});
  EXPECT_EQ(target.value(1, 1), 2u);
  EXPECT_EQ(target.left_out, "");
}

TEST_P(DiscardedThreads, OfEquallyNearOnesNoneIs) {
  const Target target(GetParam(), {{1, 1, 0.25F, 1}, {0, 1, 0.5F, 7}, {1, 1, 0.25F, 2}, {1, 1, 0.5F, 3}});
  EXPECT_EQ(target.mark(1, 1), 0u);
  EXPECT_EQ(target.value(0, 1), 7u);
  EXPECT_NE(target.left_out.find("on 1 pixel several threads"), std::string::npos) << target.left_out;
}

TEST_P(DiscardedThreads, ThatFoundNoRoomAreSaidToBeLeftOut) {
  const Target target(GetParam(), {{1, 1, 0.25F, 1}, {0, 1, 0.5F, 7}}, false, 1);
  EXPECT_EQ(target.value(1, 1), 1u);
  EXPECT_EQ(target.mark(0, 1), 0u);
  EXPECT_NE(target.left_out.find("of 2 threads"), std::string::npos) << target.left_out;
}

INSTANTIATE_TEST_SUITE_P(All, DiscardedThreads,
                         testing::Values(Carrier::uint_attachments, Carrier::float_attachments),
                         [](const auto& parameter) {
                           return parameter.param == Carrier::uint_attachments ? "words" : "floats";
                         });

}  // namespace
}  // namespace shadestep::session
