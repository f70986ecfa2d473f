#include "volume_file.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "nrrd.h"

namespace raycaster {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kLongestEdge = 4096;
constexpr std::size_t kMostVoxels = std::size_t{1} << 30;

std::string contents(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw std::runtime_error("it is not a file");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw std::runtime_error("it cannot be read, or is empty");
  return std::move(text).str();
}

std::size_t voxelCount(const Vector3i& size) {
  std::size_t count = 1;
  for (const int edge : size) {
    if (edge < 1 || edge > kLongestEdge)
      throw std::runtime_error("it says an edge of " + std::to_string(edge) + " voxels; 1 to " +
                               std::to_string(kLongestEdge) + " can be shown");
    count *= static_cast<std::size_t>(edge);  // at most 4096^3
  }
  if (count > kMostVoxels)
    throw std::runtime_error("it says " + std::to_string(count) + " voxels; 2^30 at most can be shown");
  return count;
}

void expectBytes(std::size_t there, std::size_t wanted) {
  if (there == wanted) return;
  throw std::runtime_error("its size needs " + std::to_string(wanted) + " bytes of data, and there are " +
                           std::to_string(there) + (there < wanted ? "; the file is cut off or" : ";") +
                           " its header or --raw-size does not belong to it");
}

Vector3d extentOf(const Vector3i& size, const Vector3d& spacing) {
  const Vector3d edges = size.cast<double>().cwiseProduct(spacing);
  const Vector3d extent = edges / edges.maxCoeff();
  if (!extent.allFinite() || extent.minCoeff() < 1e-4)
    throw std::runtime_error("its voxel spacing makes a box that is flat to 1 in 10,000");
  return extent;
}

template <class Number>
Number load(const char* bytes, bool bigEndian) {
  std::array<char, sizeof(Number)> copy;
  std::copy_n(bytes, sizeof(Number), copy.begin());
  if (bigEndian != (std::endian::native == std::endian::big)) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

// Least to greatest -> 0..1.
std::vector<float> normalised(const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw std::runtime_error("voxel " + std::to_string(i) +
                               " is NaN or infinite; replace such voxels by numbers");
    least = std::min(least, values[i]);
    greatest = std::max(greatest, values[i]);
  }
  // Halved, so that the range of two huge doubles is finite.
  const double range = greatest / 2 - least / 2;
  std::vector<float> voxels(values.size(), 0.0F);
  if (range > 0)
    for (std::size_t i = 0; i < values.size(); ++i)
      voxels[i] = static_cast<float>(std::clamp((values[i] / 2 - least / 2) / range, 0.0, 1.0));
  return voxels;
}

template <class Number>
std::vector<float> decode(std::string_view data, bool bigEndian) {
  std::vector<double> values(data.size() / sizeof(Number));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(load<Number>(data.data() + i * sizeof(Number), bigEndian));
  return normalised(values);
}

std::vector<float> decodeBytes(std::string_view data) {
  std::vector<float> voxels(data.size());
  std::transform(data.begin(), data.end(), voxels.begin(),
                 [](char byte) { return static_cast<float>(static_cast<unsigned char>(byte)) / 255.0F; });
  return voxels;
}

struct Type {
  std::size_t bytes;
  std::vector<float> (*decode)(std::string_view, bool bigEndian);
};

Type typeNamed(const std::string& name) {
  if (name == "uint8") return {1, [](std::string_view data, bool) { return decodeBytes(data); }};
  if (name == "int8") return {1, decode<std::int8_t>};
  if (name == "int16") return {2, decode<std::int16_t>};
  if (name == "uint16") return {2, decode<std::uint16_t>};
  if (name == "int32") return {4, decode<std::int32_t>};
  if (name == "uint32") return {4, decode<std::uint32_t>};
  if (name == "float") return {4, decode<float>};
  return {8, decode<double>};
}

Volume fromBytes(const Vector3i& size, const Vector3d& spacing, const Type& type, bool bigEndian,
                 std::string_view data) {
  expectBytes(data.size(), voxelCount(size) * type.bytes);
  return {.size = size, .extent = extentOf(size, spacing), .voxels = type.decode(data, bigEndian)};
}

// version, then minimum, maximum and length of three axes for the original, the extracted and this map;
// a count of warps; the number of bytes. All are 16 bit but for the last; VolPack's denfile.c.
Volume readDen(const std::string& file) {
  constexpr std::size_t kHeader = 62;
  constexpr std::size_t kMapLength = 2 * (1 + 8 * 3);
  constexpr std::size_t kBytes = 2 * (1 + 9 * 3 + 1);
  if (file.size() < kHeader)
    throw std::runtime_error("a .den file begins with 62 bytes of header; it is cut off");
  const bool bigEndian = file[0] == 0;
  if (load<std::int16_t>(file.data(), bigEndian) != 1)
    throw std::runtime_error("a .den file begins with the number 1; this is another format");
  Vector3i size;
  for (int axis = 0; axis < 3; ++axis)
    size[axis] = load<std::int16_t>(file.data() + kMapLength + 2 * static_cast<std::size_t>(axis), bigEndian);
  const std::size_t count = voxelCount(size);
  if (load<std::uint32_t>(file.data() + kBytes, bigEndian) != count)
    throw std::runtime_error(
        "its header is inconsistent: the number of voxels is not the product of the sizes");
  return fromBytes(size, Vector3d::Ones(), typeNamed("uint8"), bigEndian,
                   std::string_view(file).substr(kHeader));
}

Volume readText(const NrrdHeader& header, std::string_view data) {
  const std::size_t count = voxelCount(header.size);
  std::istringstream stream{std::string(data)};
  std::vector<double> values;
  values.reserve(std::min(count, data.size()));
  for (std::string word; values.size() <= count && stream >> word;) {
    char* end = nullptr;
    values.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0')
      throw std::runtime_error("'" + word.substr(0, 20) + "' among its voxels is not a number");
  }
  if (values.size() != count)
    throw std::runtime_error("its size needs " + std::to_string(count) + " numbers, and there are " +
                             (values.size() > count ? "more" : std::to_string(values.size())));
  std::vector<float> voxels;
  if (header.type == "uint8") {
    for (const double value : values)
      voxels.push_back(static_cast<float>(std::clamp(value, 0.0, 255.0) / 255));
  } else {
    voxels = normalised(values);
  }
  return {.size = header.size, .extent = extentOf(header.size, header.spacing), .voxels = std::move(voxels)};
}

// Never more than `limit` bytes plus one, whatever the compressed data say.
std::string inflated(std::string_view data, std::size_t limit) {
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  if (inflateInit2(&stream, kGzip) != Z_OK) throw std::runtime_error("zlib cannot start");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(std::min<std::size_t>(data.size(), std::numeric_limits<uInt>::max()));
  std::string result;
  int status = Z_OK;
  while (status == Z_OK && result.size() <= limit) {
    std::array<char, 1 << 16> part;
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = part.size();
    status = inflate(&stream, Z_NO_FLUSH);
    result.append(part.data(), part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END && result.size() <= limit)
    throw std::runtime_error("its gzip data are damaged or cut off");
  return result;
}

Volume readNrrd(const std::string& path, const std::string& file) {
  const NrrdHeader header = parseNrrd(file);
  std::string other;
  if (!header.dataFile.empty()) other = contents(std::filesystem::path(path).parent_path() / header.dataFile);
  const std::string_view data =
      header.dataFile.empty() ? std::string_view(file).substr(header.headerBytes) : std::string_view(other);

  if (header.encoding == NrrdHeader::Encoding::text) return readText(header, data);
  const Type type = typeNamed(header.type);
  if (header.encoding == NrrdHeader::Encoding::raw)
    return fromBytes(header.size, header.spacing, type, header.bigEndian, data);
  return fromBytes(header.size, header.spacing, type, header.bigEndian,
                   inflated(data, voxelCount(header.size) * type.bytes));
}

Volume readRaw(const std::string& file, const std::optional<RawLayout>& layout) {
  if (!layout)
    throw std::runtime_error("a .raw file does not say its size; give --raw-size X,Y,Z and --raw-type");
  const char* const name = layout->type == RawLayout::Type::u8    ? "uint8"
                           : layout->type == RawLayout::Type::u16 ? "uint16"
                                                                  : "float";
  return fromBytes(layout->size, Vector3d::Ones(), typeNamed(name), false, file);
}

std::string cannotRead(const std::string& path) {
  return "cannot read the volume '" + path + "': ";
}

std::string ending(const std::string& path) {
  return std::filesystem::path(path).extension();
}

}  // namespace

bool isVolumeFile(const std::string& path) {
  const std::string name = ending(path);
  return name == ".den" || name == ".nrrd" || name == ".nhdr" || name == ".raw";
}

Volume decodeVolume(const std::string& path, const std::string& file,
                    const std::optional<RawLayout>& layout) {
  try {
    if (ending(path) == ".den") return readDen(file);
    if (ending(path) == ".raw") return readRaw(file, layout);
    return readNrrd(path, file);
  } catch (const std::exception& error) {
    throw std::runtime_error(cannotRead(path) + error.what());
  }
}

Volume readVolume(const std::string& path, const std::optional<RawLayout>& layout) {
  std::string file;
  try {
    file = contents(path);
  } catch (const std::exception& error) {
    throw std::runtime_error(cannotRead(path) + error.what());
  }
  return decodeVolume(path, file, layout);
}

}  // namespace raycaster
