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

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "instrumenter/draft.h"

namespace shadestep::instrumenter {

const frontend::Function& functionAt(const frontend::Shader&, frontend::FunctionId);
// The function's name token in one of its prototypes.
frontend::TokenIndex nameInPrototype(const frontend::Shader&, const frontend::Function&,
                                     frontend::TokenRange);

// The functions along call paths, each with the edits to make in its text. Paths that begin alike share the
// copies along their common part.
class CallPaths {
 public:
  using Path = std::vector<frontend::CallId>;

  // Registers the renamed calls. The replacements of draft.edits hold in the copies as well, if they were
  // registered before. Assumes paths that `brokenPath` finds nothing wrong with.
  CallPaths(Draft& draft, const std::vector<Path>& paths);

  // Edits of the function that the calls of a path, or of its first part, lead into.
  Edits& edits(const Path& path) { return path.empty() ? draft_.edits : copies_.at(path).edits; }

  // The paths that lead into the copies of this function.
  std::vector<Path> into(frontend::FunctionId) const;

  // Inserts the copies with their edits; call it when these are complete.
  std::optional<Failure> insertCopies();

 private:
  struct Copy {
    frontend::FunctionId function;
    std::string name;
    Edits edits;
  };
  Draft& draft_;
  std::map<Path, Copy> copies_;  // by the calls that lead into them
};

// What is wrong with a path that shall lead into `function`; empty if nothing is.
std::string brokenPath(const frontend::Shader&, const std::vector<frontend::CallId>& path,
                       frontend::FunctionId function);

}  // namespace shadestep::instrumenter
