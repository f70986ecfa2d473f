// Runs inside the program under debug: throws nothing, starts no thread.
#include "interceptor/agent/answer_memory.h"

namespace shadestep::agent {
namespace {

// Of one stop at a time.
constinit std::uint64_t last_number = 0;

}  // namespace

void AnswerMemory::begin() {
  free_ = reserved_ = again_ = false;
}

void AnswerMemory::giveBack(std::uint64_t number) {
  free_ = memory_ && number == number_;
  if (!free_) memory_ = {};
}

bool AnswerMemory::reserve(std::size_t bytes) {
  again_ = free_ && bytes <= memory_.size();
  if (!again_) {
    memory_ = {};  // before the new one takes its place
    memory_ = wire::SharedMemory::create("shadestep-values", bytes);
    number_ = ++last_number;
  }
  reserved_ = static_cast<bool>(memory_);
  return reserved_;
}

}  // namespace shadestep::agent
