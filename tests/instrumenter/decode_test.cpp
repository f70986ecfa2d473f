// Hand-made words -> values.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "instrumenter/instrumenter.h"

namespace shadestep::instrumenter {
namespace {

using frontend::Basic;
using frontend::Type;

Type type(Basic basic, int rows = 1) {
  Type made;
  made.basic = basic;
  made.rows = rows;
  return made;
}

std::uint32_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

TEST(Decode, TakesUintWordsAsTheyAre) {
  AttachmentLayout layout;
  layout.fields = {{"a", type(Basic::float_, 2), 1}, {"b", type(Basic::double_), 3}};
  const std::vector<std::uint32_t> words = {3, 0x7fc00001, 0x80000000, 0x11111111, 0x3ff00000};
  EXPECT_EQ(decodeMark(layout, words.data()), kLaunched | kReached);
  EXPECT_EQ(decode(layout, layout.fields[0], words.data()).words,
            (std::vector<std::uint32_t>{0x7fc00001, 0x80000000}));
  EXPECT_EQ(decode(layout, layout.fields[1], words.data()).words,
            (std::vector<std::uint32_t>{0x11111111, 0x3ff00000}));
}

TEST(Decode, PutsTheHalvesOfIntegersTogether) {
  AttachmentLayout layout;
  layout.carrier = Carrier::float_attachments;
  layout.fields = {
      {"i", type(Basic::int_, 2), 1}, {"f", type(Basic::float_), 5}, {"b", type(Basic::bool_), 6}};
  const std::vector<std::uint32_t> words = {bits(1.0F),     bits(65535.0F), bits(65535.0F), bits(0.0F),
                                            bits(32768.0F), 0xff800000,     bits(1.0F),     bits(0.0F)};
  EXPECT_EQ(decodeMark(layout, words.data()), kLaunched);
  EXPECT_EQ(decode(layout, layout.fields[0], words.data()).words,
            (std::vector<std::uint32_t>{0xffffffff, 0x80000000}));
  EXPECT_EQ(decode(layout, layout.fields[1], words.data()).words, (std::vector<std::uint32_t>{0xff800000}));
  EXPECT_EQ(decode(layout, layout.fields[2], words.data()).words, (std::vector<std::uint32_t>{1}));
}

class DecodeRecording : public testing::Test {
 protected:
  DecodeRecording() {
    RecordLayout statement;
    statement.fields = {{"a", type(Basic::float_), 0}, {"b", type(Basic::int_), 1}};
    statement.words = 2;
    RecordLayout jump;
    jump.event = Event::jump;
    layout.records = {statement, jump};
  }
  // Two threads of 10 words; the second one is discarded after its first record.
  std::vector<std::uint32_t> words = {2, 10, 4, 0,                             //
                                      8, 5,  6, 1, 1, bits(1.5F), 7, 2, 0, 0,  //
                                      5, 7,  8, 2, 2, 0,          0, 0, 0, 0,  //
                                      0, 0,  0, 0, 0, 0,          0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  RecordingLayout layout;
};

TEST_F(DecodeRecording, ReadsThreadsAndRecords) {
  const Recording recording = decodeRecording(layout, words);
  ASSERT_EQ(recording.error, "");
  EXPECT_EQ(recording.started, 2u);
  ASSERT_EQ(recording.threads.size(), 2u);
  const ThreadRecording& first = recording.threads[0];
  EXPECT_EQ(first.x, 5);
  EXPECT_EQ(first.y, 6);
  EXPECT_EQ(first.invocation, 1u);
  EXPECT_TRUE(first.complete);
  EXPECT_FALSE(first.discarded);
  ASSERT_EQ(first.records.size(), 2u);
  EXPECT_EQ(first.records[0].layout, 0);
  EXPECT_EQ(first.records[0].values[0].words, std::vector<std::uint32_t>{bits(1.5F)});
  EXPECT_EQ(first.records[0].values[1].words, std::vector<std::uint32_t>{7});
  EXPECT_EQ(first.records[1].layout, 1);
  const ThreadRecording& second = recording.threads[1];
  EXPECT_TRUE(second.discarded);
  EXPECT_EQ(second.invocation, 2u);
  EXPECT_EQ(second.records.size(), 1u);
}

TEST_F(DecodeRecording, SaysWhenThereWasNotEnoughRoom) {
  words[4] = 50;
  const Recording recording = decodeRecording(layout, words);
  ASSERT_EQ(recording.error, "");
  EXPECT_FALSE(recording.threads[0].complete);
  EXPECT_EQ(recording.threads[0].wanted, 50u);
  EXPECT_EQ(recording.threads[0].records.size(), 2u);
}

TEST_F(DecodeRecording, KeepsToTheThreadsThatHadRoom) {
  words[0] = 9;
  words[2] = 2;
  const Recording recording = decodeRecording(layout, words);
  ASSERT_EQ(recording.error, "");
  EXPECT_EQ(recording.started, 9u);
  EXPECT_EQ(recording.threads.size(), 2u);
}

TEST_F(DecodeRecording, ReadsWhatAThreadWithoutAnEndLeft) {
  words[7] = 0;
  words[4] = 0;
  const Recording recording = decodeRecording(layout, words);
  ASSERT_EQ(recording.error, "");
  EXPECT_FALSE(recording.threads[0].complete);
  EXPECT_EQ(recording.threads[0].records.size(), 2u);
}

TEST_F(DecodeRecording, RefusesUnknownIds) {
  words[8] = 3;
  const Recording recording = decodeRecording(layout, words);
  EXPECT_NE(recording.error.find("unknown id 3"), std::string::npos) << recording.error;
  EXPECT_TRUE(recording.threads.empty());
}

TEST_F(DecodeRecording, RefusesGapsInACompleteThread) {
  words[11] = 0;
  EXPECT_NE(decodeRecording(layout, words).error.find("unknown id 0"), std::string::npos);
}

TEST_F(DecodeRecording, RefusesRecordsThatAreCutOff) {
  words[11] = 1;
  EXPECT_NE(decodeRecording(layout, words).error.find("cut off"), std::string::npos);
}

TEST_F(DecodeRecording, RefusesABufferThatIsTooShort) {
  words.resize(20);
  EXPECT_NE(decodeRecording(layout, words).error, "");
  words.resize(3);
  EXPECT_NE(decodeRecording(layout, words).error, "");
}

TEST_F(DecodeRecording, RefusesMarksThatNoThreadWrites) {
  words[7] = 3;
  EXPECT_NE(decodeRecording(layout, words).error.find("mark is 3"), std::string::npos);
}

}  // namespace
}  // namespace shadestep::instrumenter
