// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#include "interceptor/guard/section.h"

#include <algorithm>
#include <cstring>

namespace shadestep::guard {
namespace {

std::uint64_t differing(const Section& section, const std::byte* a, const std::byte* b) {
  if (std::memcmp(a, b, section.bytes) == 0) return 0;
  std::uint64_t count = 0;
  for (std::size_t at = 0; at < section.bytes; at += section.word) {
    count += std::memcmp(a + at, b + at, std::min(section.word, section.bytes - at)) != 0;
  }
  return count;
}

}  // namespace

std::size_t totalBytes(const std::vector<Section>& sections) {
  std::size_t bytes = 0;
  for (const Section& section : sections) bytes += section.bytes;
  return bytes;
}

std::vector<std::uint64_t> differences(const std::vector<Section>& sections, const std::byte* a,
                                       const std::byte* b) {
  std::vector<std::uint64_t> counts;
  for (const Section& section : sections) {
    counts.push_back(differing(section, a, b));
    a += section.bytes;
    b += section.bytes;
  }
  return counts;
}

}  // namespace shadestep::guard
