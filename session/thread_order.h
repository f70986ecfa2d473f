// The order of threads by the numbers of their identities.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "session/session.h"

namespace shadestep::session {

// Threads in the order of their numbers; those with the same numbers stay in the order in which they lie.
class ThreadOrder {
 public:
  // At most four numbers a thread, each a signed 32-bit word: `word(thread, n)`. All invocations on one
  // primitive come together, vertices and invocations of a dispatch by rows: there the last number counts
  // most.
  template <class Word>
  ThreadOrder(Stage stage, std::size_t threads, std::size_t numbers, Word word) {
    const bool last_first = stage == Stage::vertex || stage == Stage::compute;
    entries_.reserve(threads);
    for (std::size_t t = 0; t < threads; ++t) {
      std::array<std::uint64_t, 4> of{};
      for (std::size_t n = 0; n < numbers; ++n)
        of[last_first ? numbers - 1 - n : n] = static_cast<std::uint32_t>(word(t, n)) ^ 0x80000000U;
      entries_.push_back({of[0] << 32 | of[1], of[2] << 32 | of[3], static_cast<std::uint32_t>(t)});
      if (t > 0 && !(entries_[t - 1] < entries_[t])) lies_so_ = false;
    }
    if (!lies_so_) std::sort(entries_.begin(), entries_.end());
    for (std::size_t i = 1; i < threads && distinct_; ++i) distinct_ = !same(i - 1, i);
  }

  bool liesSo() const { return lies_so_; }  // the threads lie in this order already
  bool allDistinct() const { return distinct_; }
  std::size_t size() const { return entries_.size(); }
  std::size_t operator[](std::size_t place) const { return entries_[place].thread; }
  // Have the threads at these places the same numbers?
  bool same(std::size_t a, std::size_t b) const {
    return entries_[a].high == entries_[b].high && entries_[a].low == entries_[b].low;
  }

 private:
  struct Entry {
    std::uint64_t high = 0, low = 0;
    std::uint32_t thread = 0;
    bool operator<(const Entry& other) const {
      if (high != other.high) return high < other.high;
      return low != other.low ? low < other.low : thread < other.thread;
    }
  };
  std::vector<Entry> entries_;
  bool lies_so_ = true, distinct_ = true;
};

}  // namespace shadestep::session
