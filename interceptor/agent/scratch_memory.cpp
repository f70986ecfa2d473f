// Runs inside the program under debug: throws nothing, starts no thread.
#include "interceptor/agent/scratch_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <utility>

namespace shadestep::agent {
namespace {

using Pages = ScratchMemory::Pages;

// What is larger is given back at once: what a target of 16k x 16k needs must not stay in the program.
constexpr std::size_t kLargestKept = std::size_t{32} << 20;

constinit std::array<Pages, 3> store;

Pages newPages(std::size_t bytes) {
  void* data =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  return data == MAP_FAILED ? Pages{} : Pages{static_cast<std::byte*>(data), bytes};
}

// The smallest that is large enough; none: empty.
Pages taken(std::size_t bytes) {
  Pages* best = nullptr;
  for (Pages& kept : store) {
    if (kept.size >= bytes && (best == nullptr || kept.size < best->size)) best = &kept;
  }
  return best != nullptr ? std::exchange(*best, {}) : Pages{};
}

// The store keeps the larger ones.
void giveBack(Pages pages) {
  if (pages.size <= kLargestKept) {
    Pages& smallest = *std::min_element(store.begin(), store.end(),
                                        [](const Pages& a, const Pages& b) { return a.size < b.size; });
    if (smallest.size < pages.size) std::swap(smallest, pages);
  }
  if (pages.data != nullptr) munmap(pages.data, pages.size);
}

}  // namespace

std::byte* ScratchMemory::reserve(std::size_t bytes) {
  if (pages_.size < bytes) {
    release();
    pages_ = taken(bytes);
    if (pages_.data == nullptr) pages_ = newPages(bytes);
  }
  size_ = pages_.data != nullptr ? bytes : 0;
  return pages_.data;
}

void ScratchMemory::release() {
  size_ = 0;
  giveBack(std::exchange(pages_, {}));
}

}  // namespace shadestep::agent
