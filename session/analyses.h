// Analysed shaders, kept from stop to stop: most draws share their shaders with others.
#pragma once

#include <list>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::session {

class Analyses {
 public:
  // What analyseLinked() says, at an address that stays until trim().
  const frontend::Analysis& of(frontend::Stage, const std::vector<frontend::ShaderObject>&,
                               const frontend::PreprocessorFacts&);
  // Drops those that were not asked for the longest, beyond kMostKept.
  void trim();

  static constexpr std::size_t kMostKept = 256;

 private:
  struct Entry {
    frontend::Stage stage;
    std::vector<frontend::ShaderObject> objects;
    frontend::PreprocessorFacts facts;
    frontend::Analysis analysis;
  };
  std::list<Entry> entries_;  // the last asked for first
};

}  // namespace shadestep::session
