// Files that are whole or not there: everything is written under a temporary name beside the target, then
// renamed.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shadestep::profiler {

// Creates or replaces `path`, and its directory if missing. Throws std::runtime_error with a sentence for the
// user; then `path` is as it was and nothing is left beside it.
void writeFile(const std::string& path, std::string_view bytes);

// One channel of an EXR image, rows from the bottom up.
struct ExrChannel {
  std::string name;  // "R", "Y", "reached", ...
  std::span<const double> values;
};

// An OpenEXR file of full-precision channels: FLOAT where every value of the channel is a float (NaN and
// infinities included), else UINT where every value is a 32-bit unsigned integer. Throws std::runtime_error
// for values that fit neither, rather than rounding them, and when the file cannot be written.
void writeExr(const std::string& path, int width, int height, const std::vector<ExrChannel>&);

// A whole EXR image of FLOAT, HALF or UINT channels. Throws std::runtime_error with a sentence.
struct ExrImage {
  int width = 0, height = 0;
  std::map<std::string, std::vector<double>> channels;  // rows from the bottom up
};
ExrImage readExr(const std::string& path);

// The shortest decimal text that reads back as the same bits; "nan", "inf", "-inf".
std::string exactText(float);
std::string exactText(double);

}  // namespace shadestep::profiler
