#include "session/text.h"

#include <array>
#include <cstdio>

#include "session/values.h"

namespace shadestep::session {
namespace {

std::string digits(double value, int count) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", count, value);
  return text;
}

}  // namespace

std::string describe(const Check& check) {
  std::string left_out = check.left_out.empty() ? "" : "\nnote: " + check.left_out;
  if (!check.dropped.empty()) left_out += "\nnote: " + check.dropped;
  if (check.undefined > 0) {
    left_out += "\nnote: the shader leaves " + withThousands(check.undefined) +
                " more components of its outputs unwritten, hence undefined: they are not compared";
  }
  if (!check.compared_at_all) return "outputs not compared: " + check.reason + left_out;
  if (check.identical()) {
    return "outputs identical to the uninstrumented draw (" + withThousands(check.compared) + " components)" +
           left_out;
  }
  return "OUTPUTS DIFFER from the uninstrumented draw in " + withThousands(check.differing) + " of " +
         withThousands(check.compared) + " components" + largestDifference(check) +
         ": do not trust these values" + left_out;
}

std::string largestDifference(const Check& check) {
  if (!check.largest) return "";
  const Check::Largest& largest = *check.largest;
  return ", by at most " + digits(largest.by, 3) + " (" + largest.where + ": " + digits(largest.got, 9) +
         " instead of " + digits(largest.expected, 9) + ")";
}

std::string withThousands(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

std::string primitiveModeName(std::uint32_t mode) {
  static constexpr std::array<const char*, 15> kNames = {"GL_POINTS",
                                                         "GL_LINES",
                                                         "GL_LINE_LOOP",
                                                         "GL_LINE_STRIP",
                                                         "GL_TRIANGLES",
                                                         "GL_TRIANGLE_STRIP",
                                                         "GL_TRIANGLE_FAN",
                                                         "GL_QUADS",
                                                         "GL_QUAD_STRIP",
                                                         "GL_POLYGON",
                                                         "GL_LINES_ADJACENCY",
                                                         "GL_LINE_STRIP_ADJACENCY",
                                                         "GL_TRIANGLES_ADJACENCY",
                                                         "GL_TRIANGLE_STRIP_ADJACENCY",
                                                         "GL_PATCHES"};
  if (mode < kNames.size()) return kNames[mode];
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", mode);
  return text;
}

std::string errorName(std::uint32_t error) {
  static constexpr std::array<const char*, 8> kNames = {"GL_INVALID_ENUM",
                                                        "GL_INVALID_VALUE",
                                                        "GL_INVALID_OPERATION",
                                                        "GL_STACK_OVERFLOW",
                                                        "GL_STACK_UNDERFLOW",
                                                        "GL_OUT_OF_MEMORY",
                                                        "GL_INVALID_FRAMEBUFFER_OPERATION",
                                                        "GL_CONTEXT_LOST"};
  constexpr std::uint32_t kFirst = 0x0500;
  if (error >= kFirst && error - kFirst < kNames.size()) return kNames[error - kFirst];
  char text[16];
  std::snprintf(text, sizeof text, "0x%x", error);
  return text;
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

namespace {

// A cell, and what stands between it and the one before it in its row.
void addCell(std::string& csv, const std::string& text) {
  if (!csv.empty() && csv.back() != '\n') csv += ',';
  csv += csvCell(text);
}

void addCells(std::string& csv, const WatchedValues& watched, std::size_t thread) {
  if (!watched.no_value.empty()) return;
  const std::uint32_t* word = watched.at(thread);
  for (const auto& component : frontend::components(watched.type)) {
    addCell(csv, formatComponent(component.basic, word));
    word += wordsPerComponent(component.basic);
  }
}

}  // namespace

std::string asCsv(const ThreadValues& threads) {
  const bool pixels = threads.identity.empty();
  std::string csv;
  if (pixels) csv += "x,y";
  for (const auto* list : {&threads.identity, &threads.values}) {
    for (const WatchedValues& watched : *list) {
      if (!watched.no_value.empty()) continue;
      for (const auto& component : frontend::components(watched.type))
        addCell(csv, watched.name + component.access);
    }
  }
  csv += '\n';
  const auto width = static_cast<std::size_t>(threads.width);
  for (std::size_t thread = 0; thread < threads.marks.size(); ++thread) {
    if (!threads.reachedAt(thread)) continue;
    if (pixels) {
      addCell(csv, std::to_string(thread % width));
      addCell(csv, std::to_string(thread / width));
    }
    for (const auto* list : {&threads.identity, &threads.values})
      for (const WatchedValues& watched : *list) addCells(csv, watched, thread);
    csv += '\n';
  }
  return csv;
}

std::string describe(const LoggedCall& call) {
  std::string text = call.name + "(";
  for (const auto& [name, value] : call.arguments)
    text += (text.back() == '(' ? "" : ", ") + name + " = " + value;
  text += ")";
  if (!call.result.empty()) text += " = " + call.result;
  if (call.error != 0) text += "  -> " + errorName(call.error);
  if (call.skipped) text += "  -> left out";
  if (!call.returned) text += "  -> did not return";
  return text;
}

}  // namespace shadestep::session
