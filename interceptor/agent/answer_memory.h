// The memory beside the answers of a stop. What the session has given back is written to again: new pages
// cost more than what is written to them. Runs inside the program under debug: throws nothing, starts no
// thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "wire/channel.h"

namespace shadestep::agent {

class AnswerMemory {
 public:
  // For the next answer, which has none yet.
  void begin();
  // The number of what the session reads no longer; 0 = none. What it does not give back stays its own.
  void giveBack(std::uint64_t number);
  // Room for so many bytes, of any contents. False: there is no memory for it.
  bool reserve(std::size_t bytes);

  std::byte* data() const { return memory_.data(); }
  // Of what lies beside this answer: 0 = nothing. No two stops have the same ones.
  std::uint64_t number() const { return reserved_ ? number_ : 0; }
  // To be sent along; -1 = nothing, or the session has it already.
  int descriptor() const { return reserved_ && !again_ ? memory_.descriptor() : -1; }

 private:
  wire::SharedMemory memory_;
  std::uint64_t number_ = 0;
  bool free_ = false;      // the session has given it back
  bool reserved_ = false;  // by this answer
  bool again_ = false;     // which the session knows
};

}  // namespace shadestep::agent
