// The storage buffer that a recording shader writes to.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstdint>
#include <vector>

#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"

namespace shadestep::capture {

class StorageBuffer {
 public:
  StorageBuffer() = default;
  ~StorageBuffer();
  StorageBuffer(const StorageBuffer&) = delete;
  StorageBuffer& operator=(const StorageBuffer&) = delete;

  // Gives it `words` 32-bit words: first those of `initial`, the rest zero. Empty text: done.
  // These calls leave the generic storage binding changed: the caller holds a StorageBindingGuard.
  guard::Refusal reset(const std::vector<std::uint32_t>& initial, std::uint64_t words);
  void bind(int index) const;
  void read(void* words) const;
  std::uint64_t words() const { return words_; }
  void release();

 private:
  GLuint buffer_ = 0;
  std::uint64_t words_ = 0;
};

}  // namespace shadestep::capture
