#include "session/thread_words.h"

#include <algorithm>
#include <utility>

namespace shadestep::session {

ThreadWords::ThreadWords(int width, int height, int words, std::vector<std::uint32_t> blocks)
    : width_(width),
      height_(height),
      words_(static_cast<std::size_t>(words)),
      stride_(static_cast<std::size_t>(words)) {
  auto owned = std::make_shared<std::vector<std::uint32_t>>(std::move(blocks));
  for (std::size_t first = 0; first < words_; first += 4) planes_.push_back(owned->data() + first);
  memory_ = std::move(owned);
}

ThreadWords::ThreadWords(int width, int height, int words, std::vector<std::uint32_t*> planes,
                         std::shared_ptr<const void> memory)
    : width_(width),
      height_(height),
      words_(static_cast<std::size_t>(words)),
      planes_(std::move(planes)),
      memory_(std::move(memory)) {}

ThreadWords::ThreadWords(int count, int words, std::uint32_t* first, std::size_t stride,
                         std::shared_ptr<const void> memory)
    : width_(count),
      height_(1),
      words_(static_cast<std::size_t>(words)),
      stride_(stride),
      memory_(std::move(memory)) {
  for (std::size_t plane = 0; plane < words_; plane += 4) planes_.push_back(first + plane);
}

ThreadWords::Block ThreadWords::block(std::size_t first, std::size_t count,
                                      std::vector<std::uint32_t>& scratch) const {
  const bool together = planes_.size() == 1 || (stride_ >= words_ && planes_[1] == planes_[0] + 4);
  if (together) return {head(first), stride_};
  scratch.resize(count * words_);
  for (std::size_t w = 0; w < words_; w += 4) {
    const std::uint32_t* from = planes_[w / 4] + first * stride_;
    std::uint32_t* to = scratch.data() + w;
    const std::size_t each = std::min<std::size_t>(words_ - w, 4);
    for (std::size_t i = 0; i < count; ++i, from += stride_, to += words_) std::copy_n(from, each, to);
  }
  return {scratch.data(), words_};
}

void ThreadWords::read(std::size_t thread, std::uint32_t* into) const {
  const std::size_t at = thread * stride_;
  std::size_t first = 0;
  for (; first + 4 <= words_; first += 4) std::copy_n(planes_[first / 4] + at, 4, into + first);
  for (; first < words_; ++first) into[first] = planes_[first / 4][at + first % 4];
}

std::vector<std::uint32_t> ThreadWords::at(int x, int y) const {
  std::vector<std::uint32_t> words(words_);
  read(index(x, y), words.data());
  return words;
}

void ThreadWords::write(std::size_t thread, const std::uint32_t* from) {
  for (std::size_t w = 0; w < words_; ++w) planes_[w / 4][thread * stride_ + w % 4] = from[w];
}

}  // namespace shadestep::session
