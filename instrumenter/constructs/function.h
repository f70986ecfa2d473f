// A function cloned for one call of it (thesis 7.1.4, function calls): the call alone runs the instrumented
// copy, every other call runs the function as it is.
//
//   float f(float a);                   float f(float a);  float sd_f0(float a);
//   ... f(x) ... f(y) ...       ->      ... f(x) ... sd_f0(y) ...
//   float f(float a) { ... }            float f(float a) { ... }  float sd_f0(float a) { ...instrumented... }
//
// Prototypes are copied beside the user's, so that the copy is declared wherever the function is. Assumes no
// recursion (GLSL has none).
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

const frontend::Function& functionAt(const frontend::Shader&, frontend::FunctionId);
// The function's name token in one of its prototypes.
frontend::TokenIndex nameInPrototype(const frontend::Shader&, const frontend::Function&,
                                     frontend::TokenRange);

// The functions along a call path, each with the edits to make in its text.
class CallPath {
 public:
  // Registers the renamed calls. The replacements of draft.edits hold in the copies as well, if they were
  // registered before. Assumes a path that `brokenPath` finds nothing wrong with.
  CallPath(Draft& draft, const std::vector<frontend::CallId>& path);

  // Edits of the function in which call number `depth` of the path stands; with depth == size of the path, of
  // the innermost function.
  Edits& edits(std::size_t depth) { return depth == 0 ? draft_.edits : copies_[depth - 1].edits; }

  // Inserts the copies with their edits; call it when these are complete.
  std::optional<Failure> insertCopies();

 private:
  struct Copy {
    frontend::FunctionId function;
    std::string name;
    Edits edits;
  };
  Draft& draft_;
  std::deque<Copy> copies_;
};

// What is wrong with a path that shall lead into `function`; empty if nothing is.
std::string brokenPath(const frontend::Shader&, const std::vector<frontend::CallId>& path,
                       frontend::FunctionId function);

}  // namespace shadestep::instrumenter
