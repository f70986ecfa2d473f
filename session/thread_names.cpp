// Who the threads of a capture are: what tells them apart, and the one that a name means.
#include <algorithm>
#include <set>

#include "session/thread_order.h"
#include "session/thread_values.h"

namespace shadestep::session {

namespace {

std::optional<std::size_t> onPixel(const ThreadValues& threads, const ThreadName& name) {
  int x = -1, y = -1;
  for (const auto& [part, number] : name) (part == "x" ? x : y) = number;
  if (x < 0 || y < 0 || x >= threads.width || y >= threads.height) return std::nullopt;
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(threads.width) + static_cast<std::size_t>(x);
  return threads.marks[pixel] != 0 ? std::optional(pixel) : std::nullopt;
}

}  // namespace

ThreadName pixelName(int x, int y) {
  return {{"x", x}, {"y", y}};
}

std::optional<std::size_t> ThreadValues::find(const ThreadName& name) const {
  if (identity.empty()) return onPixel(*this, name);
  const auto numbers = [](const WatchedValues& one) { return one.type.basic == frontend::Basic::int_; };
  const bool counted = !std::all_of(identity.begin(), identity.end(), numbers);
  std::int32_t before = 0;
  std::vector<std::pair<const WatchedValues*, std::int32_t>> wanted;
  for (const WatchedValues& one : identity)
    if (numbers(one)) wanted.emplace_back(&one, 0);
  for (const auto& [part, number] : name) {
    const auto known = std::find_if(wanted.begin(), wanted.end(),
                                    [&part = part](const auto& one) { return one.first->name == part; });
    if (known != wanted.end())
      known->second = number;
    else if (counted && part == "vertex")
      before = number;
    else if (number != 0)
      return std::nullopt;  // none has such a number
  }
  for (std::size_t p = 0; p < marks.size(); ++p) {
    const bool same = marks[p] != 0 && std::all_of(wanted.begin(), wanted.end(), [p](const auto& one) {
                        return static_cast<std::int32_t>(*one.first->at(p)) == one.second;
                      });
    if (same && before-- == 0) return p;
  }
  return std::nullopt;
}

namespace {

std::string range(const WatchedValues& numbers) {
  const auto less = [](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b);
  };
  const auto [least, most] = std::minmax_element(numbers.words.begin(), numbers.words.end(), less);
  return numbers.name + " " + std::to_string(static_cast<std::int32_t>(*least)) + " to " +
         std::to_string(static_cast<std::int32_t>(*most));
}

// Coordinates are no numbers to ask for: threads that they tell apart are counted.
[[noreturn]] void noSuchThread(const ThreadValues& threads, const ThreadName& wanted) {
  std::string asked;
  std::string there;
  bool counted = false;
  for (const auto& [part, number] : wanted)
    if (number != 0 || part != "repeat")
      asked += (asked.empty() ? "" : ", ") + part + " " + std::to_string(number);
  for (const WatchedValues& numbers : threads.identity) {
    counted = counted || numbers.type.basic == frontend::Basic::float_;
    if (!counted && !numbers.words.empty()) there += (there.empty() ? "" : ", ") + range(numbers);
  }
  if (counted) there += " with " + std::to_string(threads.launched) + " generated vertices in all";
  throw Error(Outcome::nothing_matches, "the draw runs no thread " + asked + "; " +
                                            (threads.launched == 0 ? "it runs none" : "there are " + there));
}

}  // namespace

std::size_t requireThread(const ThreadValues& threads, const ThreadName& name) {
  const std::optional<std::size_t> number = threads.find(name);
  if (!number) noSuchThread(threads, name);
  return *number;
}

namespace {

WatchedValues numbers(const std::string& name, std::size_t count) {
  WatchedValues values{name, {}, 1, std::vector<std::uint32_t>(count)};
  values.type.basic = frontend::Basic::int_;
  return values;
}

// All words that belong to a thread.
std::vector<std::uint32_t> wordsAt(const ThreadValues& threads, std::size_t thread) {
  std::vector<std::uint32_t> words = {threads.marks[thread]};
  for (const auto* list : {&threads.identity, &threads.values})
    for (const WatchedValues& values : *list)
      words.insert(words.end(), values.at(thread), values.at(thread) + values.stride);
  return words;
}

// The same without copying them.
bool sameWords(const ThreadValues& threads, std::size_t a, std::size_t b) {
  const auto same = [&](const WatchedValues& values) {
    return std::equal(values.at(a), values.at(a) + values.stride, values.at(b));
  };
  return threads.marks[a] == threads.marks[b] &&
         std::all_of(threads.identity.begin(), threads.identity.end(), same) &&
         std::all_of(threads.values.begin(), threads.values.end(), same);
}

void keep(WatchedValues& values, const std::vector<std::size_t>& kept) {
  std::vector<std::uint32_t> words;
  words.reserve(kept.size() * values.stride);
  for (const std::size_t thread : kept)
    words.insert(words.end(), values.at(thread), values.at(thread) + values.stride);
  values.words = std::move(words);
}

ThreadOrder byIdentity(const ThreadValues& threads, Stage stage) {
  return {stage, threads.marks.size(), threads.identity.size(),
          [&](std::size_t thread, std::size_t n) { return *threads.identity[n].at(thread); }};
}

// Of threads that agree in all that is known of them, one stays.
void keepOneOfEach(ThreadValues& threads, const ThreadOrder& order) {
  const std::size_t count = threads.marks.size();
  std::vector<std::size_t> kept;
  std::set<std::vector<std::uint32_t>> others;  // of one identity, that differ from its first thread
  for (std::size_t i = 0, first = 0; i < count; ++i) {
    if (i == 0 || !order.same(i - 1, i)) {
      others.clear();
      first = i;
      kept.push_back(order[i]);
    } else if (!sameWords(threads, order[first], order[i]) &&
               others.insert(wordsAt(threads, order[i])).second) {
      kept.push_back(order[i]);
    }
  }
  std::sort(kept.begin(), kept.end());
  if (kept.size() == count) return;

  for (auto* list : {&threads.identity, &threads.values})
    for (WatchedValues& values : *list) keep(values, kept);
  std::vector<std::uint8_t> marks;
  threads.launched = threads.reached = 0;
  for (const std::size_t p : kept) {
    marks.push_back(threads.marks[p]);
    threads.launched += marks.back() != 0 ? 1 : 0;
    threads.reached += (marks.back() & instrumenter::kReached) != 0 ? 1 : 0;
  }
  threads.marks = std::move(marks);
  threads.width = static_cast<int>(kept.size());
}

void numberRepeats(ThreadValues& threads, const ThreadOrder& order) {
  WatchedValues repeat = numbers("repeat", order.size());
  for (std::size_t i = 1; i < order.size(); ++i)
    if (order.same(i - 1, i)) repeat.words[order[i]] = repeat.words[order[i - 1]] + 1;
  threads.identity.push_back(std::move(repeat));
}

}  // namespace

void nameThreads(ThreadValues& threads, Stage stage, const DrawStop& stop) {
  const std::size_t count = threads.marks.size();
  if (threads.identity.empty()) {
    threads.identity = {numbers("vertex", count), numbers("instance", count)};
    const std::size_t each =
        std::max<std::size_t>(count / static_cast<std::size_t>(std::max<std::int64_t>(stop.instances, 1)), 1);
    for (std::size_t p = 0; p < count; ++p) {
      threads.identity[0].words[p] = static_cast<std::uint32_t>(p % each);
      threads.identity[1].words[p] = static_cast<std::uint32_t>(p / each);
    }
    return;
  }
  const ThreadOrder order = byIdentity(threads, stage);
  if (order.allDistinct()) return;
  if (stage == Stage::vertex || (stage == Stage::tess_eval && drawsOnce(stop))) keepOneOfEach(threads, order);
  if (stage == Stage::vertex || stage == Stage::compute) return;
  const ThreadOrder left = byIdentity(threads, stage);
  if (!left.allDistinct()) numberRepeats(threads, left);
}

}  // namespace shadestep::session
