// Runs inside the program under debug: throws nothing, starts no thread, calls no GL.
#include "interceptor/guard/section.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace shadestep::guard {
namespace {

template <class T>
T valueAt(const std::byte* memory) {
  T value{};
  std::memcpy(&value, memory, sizeof value);
  return value;
}

double valueOf(Number number, const std::byte* memory) {
  switch (number) {
    case Number::real:
      return static_cast<double>(valueAt<float>(memory));
    case Number::double_real:
      return valueAt<double>(memory);
    case Number::fraction:
      return valueAt<std::uint32_t>(memory) / 4294967295.0;
    case Number::signed_integer:
      return valueAt<std::int32_t>(memory);
    default:
      return valueAt<std::uint32_t>(memory);
  }
}

}  // namespace

void Difference::note(Number number, const std::byte* before_word, const std::byte* now_word) {
  ++components;
  if (number == Number::unknown) {
    told = false;
    return;
  }
  if (number == Number::second_word) {
    number = Number::double_real;
    before_word -= 4;
    now_word -= 4;
  }
  const double a = valueOf(number, before_word);
  const double b = valueOf(number, now_word);
  // The same infinity twice is the same word; two NaNs are as good as each other.
  double apart = std::isnan(a) && std::isnan(b) ? 0.0 : std::abs(a - b);
  if (std::isnan(apart)) apart = std::numeric_limits<double>::infinity();
  if (apart <= by) return;
  by = apart;
  before = a;
  now = b;
}

void Difference::add(const Difference& other) {
  components += other.components;
  told = told && other.told;
  if (other.by <= by) return;
  by = other.by;
  before = other.before;
  now = other.now;
}

Difference difference(const std::vector<Number>& numbers, const std::byte* before, const std::byte* now,
                      std::size_t bytes, std::size_t word) {
  Difference result;
  if (std::memcmp(before, now, bytes) == 0) return result;
  for (std::size_t at = 0; at < bytes; at += word) {
    if (std::memcmp(before + at, now + at, std::min(word, bytes - at)) == 0) continue;
    const Number number = numbers.empty() ? Number::unknown : numbers[at / word % numbers.size()];
    result.note(number, before + at, now + at);
  }
  return result;
}

std::size_t totalBytes(const std::vector<Section>& sections) {
  std::size_t bytes = 0;
  for (const Section& section : sections) bytes += section.bytes;
  return bytes;
}

std::vector<Difference> differences(const std::vector<Section>& sections, const std::byte* before,
                                    const std::byte* now) {
  std::vector<Difference> result;
  for (const Section& section : sections) {
    result.push_back(difference(section.numbers, before, now, section.bytes, section.word));
    before += section.bytes;
    now += section.bytes;
  }
  return result;
}

}  // namespace shadestep::guard
