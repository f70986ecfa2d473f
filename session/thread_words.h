// The words that the threads of a capture leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace shadestep::session {

// Of fragments a thread per pixel, rows bottom up. Of other stages the threads lie in one row, in the order
// of their identities or, by transform feedback, as they were issued. Words lie where the draw left them: in
// planes of four words a thread. A copy is about the same words.
class ThreadWords {
 public:
  ThreadWords() = default;
  // A block of `words` after the other, a thread each.
  ThreadWords(int width, int height, int words, std::vector<std::uint32_t> blocks);
  // The first words of all threads, the second four, ...: as many planes as `words` take. They lie in
  // `memory`.
  ThreadWords(int width, int height, int words, std::vector<std::uint32_t*> planes,
              std::shared_ptr<const void> memory);
  // Blocks of `words` in a row, `stride` words from one to the next. They lie in `memory`.
  ThreadWords(int count, int words, std::uint32_t* first, std::size_t stride,
              std::shared_ptr<const void> memory);

  int width() const { return width_; }
  int height() const { return height_; }
  int words() const { return static_cast<int>(words_); }  // a thread's
  std::size_t count() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  // A thread's first words: four of them, if it has as many; of blocks, all.
  const std::uint32_t* head(std::size_t thread) const { return planes_[0] + thread * stride_; }
  std::uint32_t word(std::size_t thread, int word) const {
    const auto w = static_cast<std::size_t>(word);
    return planes_[w / 4][thread * stride_ + w % 4];
  }
  // All words of `count` threads from `first` on: where they lie as blocks, there, else in `scratch`.
  struct Block {
    const std::uint32_t* words = nullptr;
    std::size_t stride = 0;  // words from a thread to the next
    const std::uint32_t* at(std::size_t thread) const { return words + thread * stride; }
  };
  Block block(std::size_t first, std::size_t count, std::vector<std::uint32_t>& scratch) const;
  // All of its words, to and from `words()` of them.
  void read(std::size_t thread, std::uint32_t* into) const;
  void write(std::size_t thread, const std::uint32_t* from);
  std::vector<std::uint32_t> at(int x, int y) const;

 private:
  int width_ = 0, height_ = 0;
  std::size_t words_ = 0;
  std::size_t stride_ = 4;  // from a thread to the next in a plane
  std::vector<std::uint32_t*> planes_;
  std::shared_ptr<const void> memory_;
};

}  // namespace shadestep::session
