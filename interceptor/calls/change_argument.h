// Arguments given as text, as call_text.h shows them. Runs inside the program under debug: throws nothing,
// starts no thread, calls no GL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "interceptor/calls/call_text.h"

namespace shadestep::calls {

// What changed arguments point to; must live until the call has returned. The program's own memory is never
// written.
class ArgumentMemory {
 public:
  std::byte* add(std::vector<std::byte> bytes) { return blocks_.emplace_back(std::move(bytes)).data(); }

 private:
  std::deque<std::vector<std::byte>> blocks_;
};

// Puts the value that `text` spells into the word of the argument `name`: a number, a constant's name, names
// joined by |, "text", {a, b, ...} with as many elements as the array has, or NULL. Returns why it cannot, ""
// if it could; the words are then changed, else not.
std::string changeArgument(const CallDescription&, std::uint64_t* words, const std::string& name,
                           const std::string& text, ArgumentMemory&);

}  // namespace shadestep::calls
