#include "profiler/pictures/files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace shadestep::profiler {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw std::runtime_error("cannot write " + path + ": " + std::strerror(error));
}

bool writeAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// An EXR file in memory, so that it reaches the disk whole.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

bool isFloat(double v) {
  return !std::isfinite(v) || static_cast<double>(static_cast<float>(v)) == v;
}

bool isUint(double v) {
  return v >= 0 && v <= 4294967295.0 && v == std::floor(v);
}

// The channel's samples as the file takes them: rows from the top down, 32 bits each.
struct Plane {
  Imf::PixelType type = Imf::FLOAT;
  std::vector<std::uint32_t> words;
};

Plane makePlane(const std::string& path, int width, int height, const ExrChannel& channel) {
  bool floats = true;
  bool uints = true;
  for (const double v : channel.values) {
    floats = floats && isFloat(v);
    uints = uints && isUint(v);
  }
  if (!floats && !uints)
    throw std::runtime_error("cannot write " + path + ": the values of " + channel.name +
                             " do not fit an EXR channel without rounding; write them as CSV");
  Plane plane{floats ? Imf::FLOAT : Imf::UINT, {}};
  plane.words.reserve(channel.values.size());
  const auto columns = static_cast<std::size_t>(width);
  for (int row = height - 1; row >= 0; --row)
    for (const double v : channel.values.subspan(static_cast<std::size_t>(row) * columns, columns)) {
      std::uint32_t word = 0;
      if (floats) {
        const auto f = static_cast<float>(v);
        std::memcpy(&word, &f, sizeof word);
      } else {
        word = static_cast<std::uint32_t>(v);
      }
      plane.words.push_back(word);
    }
  return plane;
}

template <class T>
std::string shortest(T value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  std::array<char, 64> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::string(text.data(), end) : std::string();
}

}  // namespace

void writeFile(const std::string& path, std::string_view bytes) {
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  std::error_code made;
  if (!directory.empty()) std::filesystem::create_directories(directory, made);
  if (made) fail(path, made.value());

  std::string temporary = path + ".XXXXXX";
  const int fd = ::mkstemp(temporary.data());
  if (fd < 0) fail(path, errno);
  // mkstemp makes the file private; a result file gets the permissions of any new file.
  const mode_t mask = ::umask(0);
  ::umask(mask);
  int error = 0;
  if (!writeAll(fd, bytes) || ::fchmod(fd, 0666 & ~mask) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
}

void writeExr(const std::string& path, int width, int height, const std::vector<ExrChannel>& channels) {
  Imf::Header header(width, height);
  Imf::FrameBuffer frame;
  std::vector<Plane> planes;
  planes.reserve(channels.size());
  for (const ExrChannel& channel : channels) {
    if (channel.values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
      throw std::invalid_argument("EXR channel " + channel.name + " does not have a value per pixel");
    Plane& plane = planes.emplace_back(makePlane(path, width, height, channel));
    header.channels().insert(channel.name, Imf::Channel(plane.type));
    frame.insert(channel.name,
                 Imf::Slice(plane.type, reinterpret_cast<char*>(plane.words.data()), sizeof(std::uint32_t),
                            sizeof(std::uint32_t) * static_cast<std::size_t>(width)));
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }  // its destructor writes the table of lines
  writeFile(path, stream.bytes());
}

ExrImage readExr(const std::string& path) {
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    ExrImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::map<std::string, std::vector<float>> planes;
    Imf::FrameBuffer frame;
    const Imf::ChannelList& channels = file.header().channels();
    for (Imf::ChannelList::ConstIterator channel = channels.begin(); channel != channels.end(); ++channel) {
      std::vector<float>& plane = planes[channel.name()];
      plane.resize(pixels);
      const auto stride = static_cast<std::ptrdiff_t>(sizeof(float));
      char* const origin = reinterpret_cast<char*>(plane.data()) -
                           (window.min.x + static_cast<std::ptrdiff_t>(window.min.y) * image.width) * stride;
      frame.insert(channel.name(), Imf::Slice(Imf::FLOAT, origin, sizeof(float),
                                              sizeof(float) * static_cast<std::size_t>(image.width)));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (const auto& [name, plane] : planes) {
      std::vector<double>& values = image.channels[name];
      values.reserve(pixels);
      for (int row = image.height - 1; row >= 0; --row) {
        const auto first = plane.begin() + static_cast<std::ptrdiff_t>(row) * image.width;
        values.insert(values.end(), first, first + image.width);
      }
    }
    return image;
  } catch (const std::exception& error) {
    throw std::runtime_error("cannot read " + path + " as OpenEXR: " + error.what());
  }
}

std::string exactText(float value) {
  return shortest(value);
}

std::string exactText(double value) {
  return shortest(value);
}

}  // namespace shadestep::profiler
