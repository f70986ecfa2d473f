#include "profiler/thread_list.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace shadestep::profiler {
namespace {

// Of a dispatch that is filled whole: its width.
int widthOf(const ThreadList& threads) {
  const std::size_t count = threads.numbers.size();
  if (!threads.names.empty() && threads.names.front() == "x") {
    std::int32_t most = 0;
    for (const auto& numbers : threads.numbers) most = std::max(most, numbers.front());
    const auto width = static_cast<std::size_t>(most) + 1;
    if (count % width == 0 && count > width) return static_cast<int>(width);
  }
  return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
}

}  // namespace

ThreadList threadsOf(const session::Captured& captured) {
  ThreadList threads;
  for (const instrumenter::Field& field : captured.layout.identity) threads.names.push_back(field.name);
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
