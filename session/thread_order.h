// The order of threads by the numbers of their identities.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
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
  ThreadOrder(Stage stage, std::size_t threads, std::size_t numbers, Word word) : size_(threads) {
    const Lying lying = look(stage, threads, numbers, word);
    if (lying == Lying::distinct) return;
    distinct_ = false;
    entries_.reserve(threads);
    for (std::size_t t = 0; t < threads; ++t)
      entries_.push_back({keyOf(stage, t, numbers, word), static_cast<std::uint32_t>(t)});
    if (lying == Lying::so) return;
    std::sort(entries_.begin(), entries_.end());
    distinct_ = true;
    for (std::size_t i = 1; i < threads && distinct_; ++i) distinct_ = !same(i - 1, i);
  }

  // Do the threads lie in this order already?
  template <class Word>
  static bool liesSo(Stage stage, std::size_t threads, std::size_t numbers, Word word) {
    return look(stage, threads, numbers, word) != Lying::otherwise;
  }

  bool allDistinct() const { return distinct_; }
  std::size_t size() const { return size_; }
  std::size_t operator[](std::size_t place) const {
    return entries_.empty() ? place : entries_[place].thread;
  }
  // Have the threads at these places the same numbers?
  bool same(std::size_t a, std::size_t b) const {
    return !entries_.empty() && entries_[a].key == entries_[b].key;
  }

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;
  enum class Lying { distinct, so, otherwise };  // in order, no two the same; in order; not

  struct Entry {
    Key key;
    std::uint32_t thread = 0;
    bool operator<(const Entry& other) const {
      return key != other.key ? key < other.key : thread < other.thread;
    }
  };

  template <class Word>
  static Key keyOf(Stage stage, std::size_t thread, std::size_t numbers, const Word& word) {
    const bool last_first = stage == Stage::vertex || stage == Stage::compute;
    std::array<std::uint64_t, 4> of{};
    for (std::size_t n = 0; n < numbers; ++n)
      of[last_first ? numbers - 1 - n : n] = static_cast<std::uint32_t>(word(thread, n)) ^ 0x80000000U;
    return {of[0] << 32 | of[1], of[2] << 32 | of[3]};
  }

  template <class Word>
  static Lying look(Stage stage, std::size_t threads, std::size_t numbers, const Word& word) {
    Lying lying = Lying::distinct;
    Key before;
    for (std::size_t t = 0; t < threads; ++t) {
      const Key key = keyOf(stage, t, numbers, word);
      if (t > 0 && key < before) return Lying::otherwise;
      if (t > 0 && key == before) lying = Lying::so;
      before = key;
    }
    return lying;
  }

  std::size_t size_;
  bool distinct_ = true;
  std::vector<Entry> entries_;  // none: all distinct, as they lie
};

}  // namespace shadestep::session
