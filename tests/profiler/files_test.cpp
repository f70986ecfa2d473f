#include "profiler/pictures/files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>

namespace shadestep::profiler {
namespace {

class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "shadestep-files-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    directory_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory_),
                                                  std::filesystem::directory_iterator()));
  }
  static std::string content(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  std::filesystem::path directory_;
};

TEST_F(Files, are_replaced_whole_and_leave_nothing_beside) {
  writeFile(path("a.txt"), "a long first content");
  writeFile(path("a.txt"), "second");
  EXPECT_EQ(content(path("a.txt")), "second");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, directories_are_made) {
  writeFile(path("new/deeper/a.txt"), "x");
  EXPECT_EQ(content(path("new/deeper/a.txt")), "x");
}

TEST_F(Files, a_failure_names_the_file_and_leaves_nothing) {
  std::filesystem::create_directory(path("taken"));
  try {
    writeFile(path("taken"), "x");
    FAIL() << "wrote over a directory";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path("taken")), std::string::npos) << error.what();
  }
  EXPECT_EQ(entries(), 1U);
}

// All pixels of one 32-bit channel, from the top row down.
std::vector<std::uint32_t> readChannel(const std::string& file, const std::string& name,
                                       Imf::PixelType type) {
  Imf::InputFile input(file.c_str());
  const Imath::Box2i box = input.header().dataWindow();
  const auto width = static_cast<std::size_t>(box.max.x + 1);
  const auto height = static_cast<std::size_t>(box.max.y + 1);
  const Imf::Channel* channel = input.header().channels().findChannel(name);
  if (channel == nullptr || channel->type != type) return {};
  std::vector<std::uint32_t> words(width * height);
  Imf::FrameBuffer frame;
  frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(words.data()), 4, 4 * width));
  input.setFrameBuffer(frame);
  input.readPixels(box.min.y, box.max.y);
  return words;
}

TEST_F(Files, exr_keeps_every_bit_and_turns_the_rows) {
  const float inf = std::numeric_limits<float>::infinity();
  const float denormal = std::numeric_limits<float>::denorm_min();
  const std::vector<double> bottom_up{static_cast<double>(0.1F), -0.0, static_cast<double>(denormal),
                                      static_cast<double>(inf),  -2,   static_cast<double>(3.4e38F)};
  const std::vector<double> counts{0, 1, 2, 4294967295.0, 16777217, 5};
  writeExr(path("a.exr"), 3, 2, {{"Y", bottom_up}, {"count", counts}});
  EXPECT_EQ(readChannel(path("a.exr"), "Y", Imf::FLOAT),
            (std::vector<std::uint32_t>{
                std::bit_cast<std::uint32_t>(inf), std::bit_cast<std::uint32_t>(-2.0F),
                std::bit_cast<std::uint32_t>(3.4e38F), std::bit_cast<std::uint32_t>(0.1F), 0x80000000U, 1U}));
  EXPECT_EQ(readChannel(path("a.exr"), "count", Imf::UINT),
            (std::vector<std::uint32_t>{4294967295U, 16777217U, 5, 0, 1, 2}));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, exr_refuses_what_it_would_have_to_round) {
  EXPECT_THROW(writeExr(path("a.exr"), 1, 1, {{"Y", std::vector<double>{0.1}}}), std::runtime_error);
  EXPECT_THROW(writeExr(path("a.exr"), 1, 1, {{"Y", std::vector<double>{-16777217}}}), std::runtime_error);
  EXPECT_EQ(entries(), 0U);
}

TEST(ExactText, reads_back_as_the_same_bits) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    const auto value = std::bit_cast<float>(bits);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(std::strtof(exactText(value).c_str(), nullptr)), bits);
  }
  EXPECT_EQ(exactText(0.1F), "0.1");
  EXPECT_EQ(exactText(0.1), "0.1");
  EXPECT_EQ(exactText(std::numeric_limits<float>::quiet_NaN()), "nan");
  EXPECT_EQ(exactText(-std::numeric_limits<float>::infinity()), "-inf");
}

}  // namespace
}  // namespace shadestep::profiler
