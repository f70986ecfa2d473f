// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#include "interceptor/guard/section.h"

#include <algorithm>
#include <cstring>

namespace shadestep::guard {

std::uint64_t differing(const std::byte* a, const std::byte* b, std::size_t bytes, std::size_t word) {
  if (std::memcmp(a, b, bytes) == 0) return 0;
  std::uint64_t count = 0;
  for (std::size_t at = 0; at < bytes; at += word) {
    count += std::memcmp(a + at, b + at, std::min(word, bytes - at)) != 0;
  }
  return count;
}

std::size_t totalBytes(const std::vector<Section>& sections) {
  std::size_t bytes = 0;
  for (const Section& section : sections) bytes += section.bytes;
  return bytes;
}

std::vector<std::uint64_t> differences(const std::vector<Section>& sections, const std::byte* a,
                                       const std::byte* b) {
  std::vector<std::uint64_t> counts;
  for (const Section& section : sections) {
    counts.push_back(differing(a, b, section.bytes, section.word));
    a += section.bytes;
    b += section.bytes;
  }
  return counts;
}

}  // namespace shadestep::guard
