// A copy of the draw's program in which one stage has another text. Method: Strengert 2010, 7.1.5.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interceptor/calls/tracking.h"
#include "interceptor/capture/feedback.h"
#include "interceptor/capture/shadow.h"
#include "interceptor/guard/context_facts.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/registry/gl_enums.h"
#include "interceptor/registry/gl_types.h"
#include "interceptor/replay/pipeline.h"
#include "interceptor/replay/uniforms.h"
#include "wire/messages_generated.h"

namespace shadestep::replay {

// Compiled shaders of the stages that are not replaced: compiled once a stop.
class ShaderCache {
 public:
  ShaderCache() = default;
  ~ShaderCache();
  ShaderCache(const ShaderCache&) = delete;
  ShaderCache& operator=(const ShaderCache&) = delete;
  // 0 and the log if it does not compile.
  GLuint shader(GLenum type, const std::shared_ptr<const calls::CompiledSource>&, std::string& log);

 private:
  std::map<std::shared_ptr<const calls::CompiledSource>, GLuint> shaders_;
};

// Of a copy that has the stages up to one of them only.
struct Stages {
  wire::Stage last = wire::Stage::Vertex;
  std::vector<std::string> outputs;  // original ones that transform feedback gets
  capture::FeedbackLayout feedback;
};

// Deletes the program when it goes.
struct ProgramCopy {
  ProgramCopy() = default;
  ~ProgramCopy();
  ProgramCopy(const ProgramCopy&) = delete;
  ProgramCopy& operator=(const ProgramCopy&) = delete;

  GLuint program = 0;
  GLuint pipeline = 0;  // to bind, where the original's is a pipeline; 0: make the program current
  bool covering = false;
  std::set<int> output_locations;  // of the program's own outputs
  int colour_outputs = 0;          // with covering: colour buffers that its target needs
  int position_attribute = -1;     // with covering: location of the attribute to feed, -1 = none
  std::vector<capture::CaptureBuffer> captures;  // in the order of Prepare.captures
  bool dual_source = false;                      // an output is the second source of blending
  int storage_binding = -1;                      // -1 = no storage block alive
  std::optional<Stages> stages;                  // with Geometry::Unrasterized
  std::vector<SubroutineChoice> subroutines;
  std::string log;
  std::uint64_t compile_ns = 0;
};

struct Original {
  GLuint program = 0;
  const std::vector<StageProgram>& pipeline;  // empty: the program is current
  std::shared_ptr<const calls::LinkedProgram> linked;
  const capture::DrawTarget& target;
};

// Leaves the copy current: the caller holds a ProgramGuard, made while the original was current.
guard::OrRefusal<std::unique_ptr<ProgramCopy>> copyProgram(const guard::ContextFacts&, const Original&,
                                                           const wire::PrepareT&, ShaderCache&);

// Makes the copy, or its pipeline, current, with these values of its uniforms. The caller holds a
// ProgramGuard.
guard::Refusal useCopy(const ProgramCopy&, const std::vector<std::unique_ptr<wire::UniformValueT>>& uniforms);

}  // namespace shadestep::replay
