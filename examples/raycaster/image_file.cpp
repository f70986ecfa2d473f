#include "image_file.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace raycaster {
namespace {

constexpr float kBackground[3] = {0.035F, 0.04F, 0.06F};

std::size_t row(const Image& image, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size) * 4;
}

// Rows from the top down, as image files have them.
std::vector<float> topDown(const Image& image) {
  std::vector<float> pixels;
  pixels.reserve(image.pixels.size());
  for (int y = image.size - 1; y >= 0; --y) {
    const auto first = image.pixels.begin() + static_cast<std::ptrdiff_t>(row(image, y));
    pixels.insert(pixels.end(), first, first + 4 * static_cast<std::ptrdiff_t>(image.size));
  }
  return pixels;
}

void writePng(const Image& image, const std::string& path) {
  const std::vector<float> pixels = topDown(image);
  std::vector<png_byte> bytes;
  bytes.reserve(pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < pixels.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = pixels[i + c] + (1 - pixels[i + 3]) * kBackground[c];
      bytes.push_back(static_cast<png_byte>(std::lround(255 * std::clamp(value, 0.0F, 1.0F))));
    }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png.height = static_cast<png_uint_32>(image.size);
  png.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&png, path.c_str(), 0, bytes.data(), 0, nullptr))
    throw std::runtime_error(png.message);
}

void writeExr(const Image& image, const std::string& path) {
  std::vector<float> pixels = topDown(image);
  Imf::Header header(image.size, image.size);
  Imf::FrameBuffer frame;
  const char* const names[] = {"R", "G", "B", "A"};
  for (std::size_t c = 0; c < 4; ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    frame.insert(names[c],
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() + c), 4 * sizeof(float),
                            4 * sizeof(float) * static_cast<std::size_t>(image.size)));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(image.size);
}

void writeRaw(const Image& image, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(image.pixels.data()),
             static_cast<std::streamsize>(image.pixels.size() * sizeof(float)));
  file.close();
  if (!file) throw std::runtime_error("the disk may be full");
}

using Writer = void (*)(const Image&, const std::string&);
Writer writerFor(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension();
  if (ending == ".png") return writePng;
  if (ending == ".exr") return writeExr;
  if (ending == ".raw") return writeRaw;
  return nullptr;
}

}  // namespace

bool canWrite(const std::string& path) {
  return writerFor(path) != nullptr;
}

void write(const Image& image, const std::string& path) {
  // Into a neighbour first: what bears the name is always whole.
  const std::string part = path + ".part";
  try {
    writerFor(path)(image, part);
    std::filesystem::rename(part, path);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw std::runtime_error("cannot write '" + path + "' (" + error.what() +
                             "); choose a folder that exists and can be written");
  }
}

}  // namespace raycaster
