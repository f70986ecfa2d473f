#include "profiler/pictures/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shadestep::profiler {
namespace {

constexpr const char* kThinSpace = "\u2009";

// "-12345.67" -> "-12 345.67" with thin spaces.
std::string separateThousands(const std::string& digits) {
  const std::size_t first = digits.starts_with('-') ? 1 : 0;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point - first <= 4) return digits;  // four digits read well as they are
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > first && i < point && (point - i) % 3 == 0) text += kThinSpace;
    text += digits[i];
  }
  return text;
}

// The largest of 1, 2, 5 times a power of ten that is not above `step`, or the smallest not below it.
double roundStep(double step, bool up) {
  const double power = std::pow(10, std::floor(std::log10(step)));
  double best = up ? 10 * power : power;
  for (const double m : {1.0, 2.0, 5.0, 10.0}) {
    if (up && m * power >= step * (1 - 1e-9)) return m * power;
    if (!up && m * power <= step * (1 + 1e-9)) best = m * power;
  }
  return best;
}

}  // namespace

ScaledUnit scaledUnit(const std::string& unit, double largest) {
  const double size = std::abs(largest);
  if (unit == "ns") {
    if (size >= 2e9) return {"s", 1e-9};
    if (size >= 2e6) return {"ms", 1e-6};
    if (size >= 2e3) return {"µs", 1e-3};
    return {"ns", 1};
  }
  if (unit.empty()) return {"", 1};
  if (size >= 1e8) return {"million " + unit, 1e-6};
  if (size >= 1e5) return {"thousand " + unit, 1e-3};
  return {unit, 1};
}

std::vector<Tick> ticks(double low, double high, int wanted) {
  if (!(low < high) || !std::isfinite(high - low)) return {{low, readable(low)}};
  double step = roundStep((high - low) / std::max(wanted, 1), true);
  const auto count = [&](double s) { return std::floor(high / s + 1e-9) - std::ceil(low / s - 1e-9) + 1; };
  while (count(step) < 2) step = roundStep(step * 0.6, false);
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  const bool exponent = std::max(std::abs(low), std::abs(high)) >= 1e15 || step < 1e-6;
  std::vector<Tick> result;
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  for (double i = first; i <= last; ++i) {
    const double value = i == 0 ? 0 : i * step;
    result.push_back({value, exponent ? fmt::format("{:.3g}", value)
                                      : separateThousands(fmt::format("{:.{}f}", value, decimals))});
  }
  return result;
}

std::string readable(double value, int digits) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value < 0 ? "-∞" : "∞";
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-4 || size >= 1e15)) return fmt::format("{:.{}g}", value, digits);
  const int before_point = size == 0 ? 1 : static_cast<int>(std::floor(std::log10(size))) + 1;
  std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - before_point));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
  }
  return separateThousands(text);
}

}  // namespace shadestep::profiler
