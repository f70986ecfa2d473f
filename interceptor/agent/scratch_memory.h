// Memory for what a draw leaves behind. It goes back to a store that outlives the stops, because new pages
// cost more than reading into them: a program with thousands of draws may be stopped at each. Runs inside the
// program under debug: throws nothing, starts no thread. The store belongs to whoever is at a stop; there is
// one stop at a time. Private pages: a forked child writes to its own.
#pragma once

#include <cstddef>

namespace shadestep::agent {

class ScratchMemory {
 public:
  ScratchMemory() = default;
  ~ScratchMemory() { release(); }
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  // Room for so many bytes, at least one, of any contents; null if there is no memory.
  std::byte* reserve(std::size_t bytes);
  void release();

  std::byte* data() const { return pages_.data; }
  std::size_t size() const { return size_; }  // as reserved
  explicit operator bool() const { return size_ > 0; }

  struct Pages {
    std::byte* data = nullptr;
    std::size_t size = 0;
  };

 private:
  Pages pages_;  // at least size_
  std::size_t size_ = 0;
};

}  // namespace shadestep::agent
