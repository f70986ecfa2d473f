#include "session/verify_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
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

constexpr std::uint32_t kRandomSeed = 7;  // for the choice of threads: the same in every run
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

bool isNumber(const WatchedValues& part) {
  return part.type.basic == frontend::Basic::int_;
}

// Whether the numbers of the thread are no others'.
std::vector<std::size_t> aloneAmong(const ThreadValues& threads, const std::vector<std::size_t>& all) {
  const auto numbers = [&](std::size_t p) {
    std::vector<std::uint32_t> words;
    for (const WatchedValues& part : threads.identity)
      if (part.name != "repeat") words.push_back(*part.at(p));
    return words;
  };
  std::map<std::vector<std::uint32_t>, int> count;
  for (const std::size_t p : all) ++count[numbers(p)];
  std::vector<std::size_t> alone;
  std::copy_if(all.begin(), all.end(), std::back_inserter(alone),
               [&](std::size_t p) { return count[numbers(p)] == 1; });
  return alone;
}

}  // namespace

// Those that coordinates tell apart are counted among those with the same numbers.
ThreadName nameOf(const ThreadValues& threads, std::size_t thread) {
  if (threads.identity.empty()) {
    const auto width = static_cast<std::size_t>(threads.width);
    return pixelName(static_cast<int>(thread % width), static_cast<int>(thread / width));
  }
  ThreadName name;
  bool counted = false;
  for (const WatchedValues& part : threads.identity) {
    if (isNumber(part))
      name.emplace_back(part.name, static_cast<std::int32_t>(*part.at(thread)));
    else
      counted = true;
  }
  if (!counted) return name;
  std::int32_t before = 0;
  for (std::size_t p = 0; p < thread; ++p) {
    const bool same = std::all_of(threads.identity.begin(), threads.identity.end(), [&](const auto& part) {
      return !isNumber(part) || *part.at(p) == *part.at(thread);
    });
    before += threads.marks[p] != 0 && same ? 1 : 0;
  }
  name.emplace_back("vertex", before);
  return name;
}

std::string where(const ThreadName& name) {
  if (name.size() == 2 && name.front().first == "x")
    return "pixel " + std::to_string(name[0].second) + "," + std::to_string(name[1].second);
  std::string text;
  for (const auto& [part, number] : name)
    text += (text.empty() ? "" : ", ") + part + " " + std::to_string(number);
  return text;
}

std::vector<ChosenThread> chooseThreads(const ThreadValues& all, int most) {
  std::vector<std::size_t> there;
  for (std::size_t p = 0; p < all.marks.size(); ++p)
    if (all.marks[p] != 0) there.push_back(p);
  if (!all.identity.empty()) {
    if (auto alone = aloneAmong(all, there); !alone.empty()) there = std::move(alone);
  }
  if (there.empty()) return {};
  const auto width = static_cast<std::size_t>(all.width);
  double x = 0;
  double y = 0;
  for (const std::size_t p : there) {
    x += static_cast<double>(p % width);
    y += static_cast<double>(p / width);
  }
  x /= static_cast<double>(there.size());
  y /= static_cast<double>(there.size());
  const auto distance = [&](std::size_t p) {
    const double dx = static_cast<double>(p % width) - x;
    const double dy = static_cast<double>(p / width) - y;
    return dx * dx + dy * dy;
  };
  std::set<std::size_t> chosen = {there.front(), there.back()};
  chosen.insert(*std::min_element(there.begin(), there.end(),
                                  [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); }));
  std::mt19937 random(kRandomSeed);
  const std::size_t wanted = std::min(there.size(), static_cast<std::size_t>(std::max(most, 1)));
  while (chosen.size() < wanted) chosen.insert(there[random() % there.size()]);

  std::vector<ChosenThread> threads;
  for (const std::size_t p : chosen) {
    if (threads.size() == wanted) break;
    threads.push_back({nameOf(all, p), (all.marks[p] & instrumenter::kDiscarded) != 0});
  }
  return threads;
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

static bool agreeReduced(std::uint32_t one, std::uint32_t other) {
  constexpr float kUnit = 0x1p-10F;      // of mediump's least precision, relative
  constexpr float kSmallest = 0x1p-14F;  // below, units no longer shrink
  constexpr float kLargest = 65504;      // above, there is nothing but infinity
  const float a = std::bit_cast<float>(one);
  const float b = std::bit_cast<float>(other);
  if (one == other || (std::isnan(a) && std::isnan(b))) return true;
  if (std::isinf(a) || std::isinf(b))
    return std::signbit(a) == std::signbit(b) && std::min(std::abs(a), std::abs(b)) > kLargest;
  return std::abs(a - b) <= 2 * kUnit * std::max({std::abs(a), std::abs(b), kSmallest});
}

bool agree(const Shader& shader, const Part& part, const std::uint32_t* one, const std::uint32_t* other) {
  const bool es = shader.profile == "es" || shader.version == 100;
  const bool reduced = es && shader.variables[static_cast<std::size_t>(part.variable)].reduced_precision;
  for (const frontend::Component& component : frontend::components(part.type)) {
    frontend::Type scalar;
    scalar.basic = component.basic;
    const int words = frontend::wordCount(scalar);
    const bool same = reduced && component.basic == frontend::Basic::float_
                          ? agreeReduced(*one, *other)
                          : std::equal(one, one + words, other);
    if (!same) return false;
    one += words;
    other += words;
  }
  return true;
}

bool isForInit(const Shader& shader, const Statement& at) {
  if (at.parent == kNone) return false;
  const Statement& parent = shader.statements[static_cast<std::size_t>(at.parent)];
  return parent.kind == StatementKind::for_ && parent.init != kNone &&
         &shader.statements[static_cast<std::size_t>(parent.init)] == &at;
}

}  // namespace shadestep::session
