#include "session/verify_samples.h"

#include <algorithm>
#include <random>
#include <set>

namespace shadestep::session {
namespace {

using frontend::kNone;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementKind;
using frontend::Storage;
using frontend::VariableId;
using instrumenter::Probe;

constexpr std::uint32_t kRandomSeed = 7;  // for the choice of pixels: the same in every run
constexpr int kPartWords = 16;            // wider values are looked at in parts

// The value in parts of at most kPartWords, in canonical order.
void addParts(const Part& whole, std::vector<Part>& parts) {
  const int words = frontend::wordCount(whole.type);
  if (words == 0) return;
  const bool composed =
      whole.type.isArray() || whole.type.isMatrix() || whole.type.basic == frontend::Basic::struct_;
  if (words <= kPartWords || !composed) {
    parts.push_back(whole);
    return;
  }
  std::size_t first = whole.first_word;
  const auto add = [&](const std::string& access, const frontend::Type& type) {
    addParts({whole.variable, whole.expression + access, type, first}, parts);
    first += static_cast<std::size_t>(frontend::wordCount(type));
  };
  if (whole.type.isArray()) {
    for (int i = 0; i < whole.type.array.front(); ++i)
      add("[" + std::to_string(i) + "]", whole.type.element());
  } else if (whole.type.isMatrix()) {
    frontend::Type column = whole.type;
    column.columns = 1;
    for (int i = 0; i < whole.type.columns; ++i) add("[" + std::to_string(i) + "]", column);
  } else {
    for (const frontend::Member& member : whole.type.members->members) add("." + member.name, member.type);
  }
}

std::vector<VariableId> inScope(const Shader& shader, const Probe& probe) {
  const Statement& at = shader.statements[static_cast<std::size_t>(probe.statement)];
  std::vector<VariableId> declared;
  const auto declares = [&](const Statement& statement) {
    for (const frontend::Declarator& one : statement.declarators)
      if (one.variable != kNone) declared.push_back(one.variable);
  };
  declares(at);
  if (at.init != kNone) declares(shader.statements[static_cast<std::size_t>(at.init)]);
  std::vector<VariableId> names = at.scope;
  // An inner variable hides an outer one of its name; memory shared between threads has no value of its
  // own.
  std::set<std::string> taken;
  if (probe.inside != kNone) {
    // Inside of the statement, a name that it declares may mean the outer variable or already the inner one.
    for (const VariableId id : declared) taken.insert(shader.variables[static_cast<std::size_t>(id)].name);
  } else if (probe.when == Probe::When::after) {
    names.insert(names.end(), declared.begin(), declared.end());
  }
  std::vector<VariableId> result;
  for (auto id = names.rbegin(); id != names.rend(); ++id) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(*id)];
    const bool shared = variable.storage == Storage::buffer || variable.storage == Storage::shared;
    if (taken.insert(variable.name).second && !shared) result.push_back(*id);
  }
  return result;
}

}  // namespace

std::string where(const Pixel& pixel) {
  return "pixel " + std::to_string(pixel.x) + "," + std::to_string(pixel.y);
}

std::vector<Pixel> choosePixels(const ThreadValues& cover, int most) {
  std::vector<std::size_t> covered;
  double x = 0;
  double y = 0;
  const auto width = static_cast<std::size_t>(cover.width);
  for (std::size_t p = 0; p < cover.marks.size(); ++p) {
    if (cover.marks[p] == 0) continue;
    covered.push_back(p);
    x += static_cast<double>(p % width);
    y += static_cast<double>(p / width);
  }
  if (covered.empty()) return {};
  x /= static_cast<double>(covered.size());
  y /= static_cast<double>(covered.size());
  const auto distance = [&](std::size_t p) {
    const double dx = static_cast<double>(p % width) - x;
    const double dy = static_cast<double>(p / width) - y;
    return dx * dx + dy * dy;
  };
  std::set<std::size_t> chosen = {covered.front(), covered.back()};
  chosen.insert(*std::min_element(covered.begin(), covered.end(),
                                  [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); }));
  std::mt19937 random(kRandomSeed);
  const std::size_t wanted = std::min(covered.size(), static_cast<std::size_t>(std::max(most, 1)));
  while (chosen.size() < wanted) chosen.insert(covered[random() % covered.size()]);

  std::vector<Pixel> pixels;
  for (const std::size_t p : chosen) {
    if (pixels.size() < wanted)
      pixels.push_back({static_cast<int>(p % width), static_cast<int>(p / width),
                        (cover.marks[p] & instrumenter::kDiscarded) != 0});
  }
  return pixels;
}

std::vector<Part> partsInScope(const Shader& shader, const Probe& probe) {
  std::vector<Part> parts;
  for (const VariableId id : inScope(shader, probe)) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    addParts({id, variable.name, variable.type, 0}, parts);
  }
  return parts;
}

bool mayBeUndefined(const Shader& shader, VariableId id) {
  const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
  if (variable.storage == Storage::out || variable.storage == Storage::builtin) return true;
  if (variable.parameter_out) return true;
  for (const Statement& statement : shader.statements) {
    for (const frontend::Declarator& declarator : statement.declarators) {
      if (declarator.variable == id && declarator.initializer.empty()) return true;
    }
  }
  // A global's initializer is part of no statement.
  return variable.storage == Storage::global && !frontend::hasInitializer(shader, id);
}

bool isForInit(const Shader& shader, const Statement& at) {
  if (at.parent == kNone) return false;
  const Statement& parent = shader.statements[static_cast<std::size_t>(at.parent)];
  return parent.kind == StatementKind::for_ && parent.init != kNone &&
         &shader.statements[static_cast<std::size_t>(parent.init)] == &at;
}

}  // namespace shadestep::session
