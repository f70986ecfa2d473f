#include "profiler/thread_list.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "session/values.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kRow = 32;  // threads in step stay together in a row

// Of a dispatch that is filled whole: its width.
int widthOf(const ThreadList& threads) {
  const std::size_t count = threads.numbers.size();
  if (!threads.names.empty() && threads.names.front() == "x") {
    std::int32_t most = 0;
    for (const auto& numbers : threads.numbers) most = std::max(most, numbers.front());
    const auto width = static_cast<std::size_t>(most) + 1;
    if (count % width == 0 && count > width) return static_cast<int>(width);
  }
  if (count <= kRow) return static_cast<int>(count);
  const auto rows = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count)) / kRow));
  return static_cast<int>(rows * kRow);
}

}  // namespace

std::string ThreadList::text(std::size_t thread, std::size_t name) const {
  const auto word = static_cast<std::uint32_t>(numbers[thread][name]);
  return session::formatComponent(types[name], &word);
}

ThreadList threadsOf(const session::Captured& captured) {
  ThreadList threads;
  for (const instrumenter::Field& field : captured.layout.identity) {
    threads.names.push_back(field.name);
    threads.types.push_back(field.type.basic);
  }
  for (int i = 0; i < captured.threads.width(); ++i) {
    threads.numbers.emplace_back();
    for (const instrumenter::Field& field : captured.layout.identity)
      threads.numbers.back().push_back(std::bit_cast<std::int32_t>(
          instrumenter::decode(captured.layout, field, captured.threads.at(i, 0).data()).words.at(0)));
  }
  return threads;
}

CostMap foldThreads(const session::Captured& captured, const ThreadList& threads) {
  if (threads.numbers.empty())
    throw session::Error(session::Outcome::nothing_matches, "no thread of this stage runs in this draw");
  const int count = captured.threads.width();
  const int width = widthOf(threads);
  CostMap map(width, (count + width - 1) / width);
  for (int i = 0; i < count; ++i)
    if ((instrumenter::decodeMark(captured.layout, captured.threads.at(i, 0).data()) &
         instrumenter::kLaunched) != 0)
      map.state[static_cast<std::size_t>(i)] = PixelState::measured;
  return map;
}

}  // namespace shadestep::profiler
