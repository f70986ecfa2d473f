// Volumes: synthetic ones against their formulas, files against what was written into them, and files that
// are broken in every way.
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>

#include "volume_file.h"

namespace raycaster {
namespace {

class VolumeFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "volumeXXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

 private:
  std::filesystem::path folder_;
};

std::string refusal(const std::string& name, const std::string& contents,
                    const std::optional<RawLayout>& layout = {}) {
  try {
    decodeVolume(name, contents, layout);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string bytes(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += static_cast<char>(i * 37);
  return text;
}

std::string number(std::int64_t value, int size, bool bigEndian) {
  std::string text;
  for (int i = 0; i < size; ++i) text += static_cast<char>(value >> 8 * (bigEndian ? size - 1 - i : i));
  return text;
}

std::string den(int x, int y, int z, bool bigEndian, const std::string& data) {
  std::string text = number(1, 2, bigEndian);
  for (int i = 0; i < 8 * 3; ++i) text += number(0, 2, bigEndian);
  for (const int edge : {x, y, z}) text += number(edge, 2, bigEndian);
  text += number(0, 2, bigEndian) + number(std::int64_t{x} * y * z, 4, bigEndian);
  return text + data;
}

std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0004\n# a comment\ndimension: 3\n" + fields + "\n" + data;
}

std::string gzipped(const std::string& data) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string result(data.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(result.size() - stream.avail_out);
  deflateEnd(&stream);
  return result;
}

TEST_F(VolumeFile, DenOfEitherByteOrder) {
  for (const bool bigEndian : {false, true}) {
    const Volume volume = readVolume(write("a.den", den(3, 4, 2, bigEndian, bytes(24))));
    EXPECT_EQ(volume.size, Eigen::Vector3i(3, 4, 2));
    EXPECT_EQ(volume.extent, Eigen::Vector3d(0.75, 1, 0.5));
    EXPECT_EQ(volume.voxels[5], static_cast<float>(5 * 37) / 255.0F);
  }
}

// The example volume of Debian's libvolpack1-dev.
TEST_F(VolumeFile, BrainOfVolpack) {
  const std::string path = "/usr/share/doc/libvolpack1-dev/examples/brainsmall.den";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "libvolpack1-dev is not installed";
  const Volume brain = readVolume(path);
  EXPECT_EQ(brain.size, Eigen::Vector3i(128, 128, 84));
  EXPECT_EQ(brain.extent, Eigen::Vector3d(1, 1, 84.0 / 128));
}

TEST_F(VolumeFile, NrrdInEveryEncoding) {
  const std::string data = bytes(24);
  std::string words;
  for (const char byte : data) words += std::to_string(static_cast<unsigned char>(byte)) + " ";
  const std::string fields = "type: unsigned char\nsizes: 3 4 2\nspacings: 1 1 2\nencoding: ";
  const Volume raw = readVolume(write("raw.nrrd", nrrd(fields + "raw\n", data)));
  const Volume text = readVolume(write("text.nrrd", nrrd(fields + "ascii\n", words)));
  const Volume gzip = readVolume(write("gzip.nrrd", nrrd(fields + "gzip\n", gzipped(data))));
  write("beside.bin", data);
  const Volume beside = readVolume(write("a.nhdr", nrrd(fields + "raw\ndata file: beside.bin\n", "")));
  EXPECT_EQ(raw.extent, Eigen::Vector3d(0.75, 1, 1));
  EXPECT_EQ(raw.voxels[7], static_cast<float>(static_cast<unsigned char>(data[7])) / 255.0F);
  EXPECT_EQ(text.voxels, raw.voxels);
  EXPECT_EQ(gzip.voxels, raw.voxels);
  EXPECT_EQ(beside.voxels, raw.voxels);
}

TEST_F(VolumeFile, OtherTypesAreMappedFromTheirRange) {
  for (const bool bigEndian : {false, true}) {
    std::string data;
    for (const int value : {-100, 0, 100, 300}) data += number(value, 2, bigEndian);
    const std::string endian = bigEndian ? "endian: big\n" : "endian: little\n";
    const Volume volume =
        readVolume(write("a.nrrd", nrrd("type: short\nsizes: 2 2 1\nencoding: raw\n" + endian, data)));
    EXPECT_EQ(volume.voxels, (std::vector<float>{0, 0.25F, 0.5F, 1}));
  }
  std::string floats;
  for (const float value : {1.0F, 1.5F, 2.0F, 3.0F})
    floats += number(std::bit_cast<std::int32_t>(value), 4, false);
  const RawLayout layout{{4, 1, 1}, RawLayout::Type::f32};
  EXPECT_EQ(readVolume(write("a.raw", floats), layout).voxels, (std::vector<float>{0, 0.25F, 0.5F, 1}));
  EXPECT_EQ(readVolume(write("b.raw", std::string(16, '\0')), layout).voxels, std::vector<float>(4, 0.0F));
}

TEST_F(VolumeFile, BadFilesAreRefusedWithAReason) {
  const auto expect = [&](const std::string& name, const std::string& text, const std::string& reason,
                          const std::optional<RawLayout>& layout = {}) {
    const std::string said = refusal(name, text, layout);
    EXPECT_NE(said.find(reason), std::string::npos) << name << ": " << said;
  };
  const std::string fields = "type: float\nsizes: 2 2 1\nencoding: raw\n";
  const auto floats = [](float value) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += number(std::bit_cast<std::int32_t>(value), 4, false);
    return text;
  };
  EXPECT_THROW(readVolume("missing.den"), std::runtime_error);
  EXPECT_THROW(readVolume(write("empty.den", "")), std::runtime_error);
  expect("a.den", "", "cut off");
  expect("a.den", std::string(61, '\1'), "cut off");
  expect("a.den", std::string(80, '\7'), "another format");
  expect("a.den", den(3, 4, 2, false, bytes(23)), "cut off");
  expect("a.den", den(3, 4, 2, false, bytes(25)), "does not belong");
  expect("a.den", den(0, 4, 2, false, ""), "edge of 0");
  expect("a.den", den(-3, 4, 2, false, ""), "edge of -3");
  expect("a.den", den(4096, 4096, 4096, false, ""), "2^30");
  expect("a.raw", bytes(24), "--raw-size");
  expect("a.raw", bytes(24), "does not belong", RawLayout{{3, 4, 1}, RawLayout::Type::u8});
  expect("a.raw", bytes(24), "edge of 2000000000", RawLayout{{2000000000, 4, 1}, RawLayout::Type::u8});
  expect("a.nrrd", "P5 2 2", "does not begin with NRRD");
  expect("a.nrrd", "NRRD0004\ntype: float\n", "no end");
  expect("a.nrrd", "NRRD0004\ntype: float\n\n", "no 'sizes'");
  expect("a.nrrd", "NRRD0004\nsizes: 1 1 1\n\n", "no 'type'");
  expect("a.nrrd", nrrd("type: block\nsizes: 1 1 1\n", ""), "type 'block'");
  expect("a.nrrd", nrrd("type: float\nsizes: 1 1\n", ""), "three numbers");
  expect("a.nrrd", nrrd("type: float\nsizes: 1 1 99999999999\n", ""), "three numbers");
  expect("a.nrrd", "NRRD0004\ndimension: 4\n\n", "dimension 4");
  expect("a.nrrd", nrrd("type: float\nsizes: 1 1 1\nencoding: bzip2\n", ""), "bzip2");
  expect("a.nrrd", nrrd(fields + "spacings: 1 nan 1\n", floats(1)), "spacing");
  expect("a.nrrd", nrrd(fields + "spacings: 1 0 1\n", floats(1)), "spacing");
  expect("a.nrrd", nrrd(fields + "spacings: 1 1e9 1\n", floats(1)), "flat");
  expect("a.nrrd", nrrd(fields, floats(NAN)), "NaN");
  expect("a.nrrd", nrrd(fields, floats(INFINITY)), "NaN or infinite");
  expect("a.nrrd", nrrd("type: float\nsizes: 2 2 1\nencoding: gzip\n", gzipped(floats(1)).substr(0, 15)),
         "gzip");
  expect("a.nrrd", nrrd("type: float\nsizes: 2 2 1\nencoding: gzip\n", gzipped(bytes(1 << 20))),
         "does not belong");
  expect("a.nrrd", nrrd("type: float\nsizes: 2 2 1\nencoding: text\n", "1 2 3"), "there are 3");
  expect("a.nrrd", nrrd("type: float\nsizes: 2 2 1\nencoding: text\n", "1 2 x 3"), "'x'");
  expect("a.nrrd", nrrd("type: float\nsizes: 2 2 1\nencoding: text\n", "1 2 nan 3"), "NaN");
  expect("a.nhdr", nrrd(fields + "data file: nowhere.bin\n", ""), "not a file");
  expect("a.nhdr", nrrd(fields + "data file: slice%03d.bin\n", ""), "several files");
}

// Whatever the damage: a refusal with a sentence, or a whole volume of numbers from 0 to 1.
TEST(DamagedVolumeFile, NeverGivesADamagedVolume) {
  const std::string fields = "type: float\nsizes: 2 3 2\nspacings: 1 2 3\nencoding: ";
  const std::vector<std::pair<std::string, std::string>> whole = {
      {"a.den", den(3, 4, 2, false, bytes(24))},
      {"b.nrrd", nrrd(fields + "raw\n", bytes(48))},
      {"c.nrrd", nrrd(fields + "gzip\n", gzipped(bytes(48)))},
      {"d.nrrd", nrrd(fields + "text\n", "1 2 3 4 5 6 7 8 9 10 11 12\n")}};
  std::mt19937 random(20261122);
  int refused = 0, read = 0;
  const auto attempt = [&](const std::string& name, const std::string& text) {
    try {
      const Volume volume = decodeVolume(name, text);
      ASSERT_EQ(volume.voxels.size(), static_cast<std::size_t>(volume.size.prod()));
      ASSERT_TRUE(volume.extent.allFinite() && volume.extent.minCoeff() > 0 && volume.extent.maxCoeff() == 1);
      for (const float voxel : volume.voxels) ASSERT_TRUE(voxel >= 0 && voxel <= 1) << name;
      ++read;
    } catch (const std::runtime_error& error) {
      ASSERT_GT(std::string(error.what()).size(), 20U);
      ++refused;
    }
  };
  for (const auto& [name, text] : whole) {
    for (std::size_t length = 0; length < text.size(); length += 3) attempt(name, text.substr(0, length));
    for (int round = 0; round < 300; ++round) {
      std::string damaged = text;
      for (int i = 0; i <= round % 4; ++i) damaged[random() % damaged.size()] = static_cast<char>(random());
      attempt(name, damaged);
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(read, 50);
}

TEST(SyntheticVolume, MarschnerLobbIsItsFormula) {
  const Volume volume = marschnerLobb(41);
  // rho(0, 0, 0) = (1 + 0.25 (1 + cos(12 pi))) / 2.5
  EXPECT_NEAR(volume.at({0.5, 0.5, 0.5}), (1 + 0.25 * 2) / 2.5, 1e-6);
}

TEST(SyntheticVolume, RampIsItsCoordinate) {
  const Volume volume = ramp(16);
  for (const double z : {1.0 / 32, 0.3, 0.77}) EXPECT_NEAR(volume.at({0.2, 0.9, z}), z, 1e-7);
}

TEST(SyntheticVolume, SphereHasItsRadius) {
  const Volume volume = sphere(64, 0.4);
  EXPECT_EQ(volume.at({0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(volume.at({0.02, 0.5, 0.5}), 0);
  EXPECT_NEAR(volume.at({0.5 + 0.4, 0.5, 0.5}), 0.5, 0.04);
}

}  // namespace
}  // namespace raycaster
