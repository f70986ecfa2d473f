// One stop at a draw call: carries out the session's requests on the stopped thread. Between two requests the
// program's GL state is as the program left it; only objects of the agent's own live until the stop ends.
// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "interceptor/agent/answer_memory.h"
#include "interceptor/agent/check.h"
#include "interceptor/agent/describe.h"
#include "interceptor/agent/reply.h"
#include "interceptor/agent/stage_replay.h"
#include "interceptor/capture/covering.h"
#include "interceptor/capture/shadow.h"
#include "interceptor/capture/storage.h"
#include "interceptor/guard/errors.h"
#include "interceptor/guard/fragment_guards.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/memory.h"
#include "interceptor/guard/refusal.h"
#include "interceptor/replay/program_copy.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

class Stop {
 public:
  explicit Stop(const calls::DrawCall&);

  wire::StoppedT announcement(std::uint64_t frame, std::uint64_t draw) const;
  // Answers Describe, DescribeState, DescribeTextures, DescribeBuffers, ReadBuffer, Prepare, Execute,
  // TimeBoxes and Release; Failed to anything else.
  Reply answer(const wire::MessageT& request);

 private:
  guard::OrRefusal<wire::StateT> describeState();
  guard::OrRefusal<wire::PreparedT> prepare(const wire::PrepareT&);
  guard::OrRefusal<wire::ExecutedT> execute(const wire::ExecuteT&, AnswerMemory& bulk);
  guard::OrRefusal<wire::ExecutedT> replay(const replay::ProgramCopy&, const guard::ProgramGuard&,
                                           const guard::FramebufferGuard&, const wire::ExecuteT&,
                                           AnswerMemory& bulk);
  guard::OrRefusal<wire::ExecutedT> cover(const replay::ProgramCopy&, const wire::ExecuteT&,
                                          AnswerMemory& bulk);
  guard::OrRefusal<wire::BoxTimesT> timeBoxes(const wire::TimeBoxesT&);
  guard::Refusal checkPlane(const wire::ExecuteT&);
  void setRaster(const wire::RasterT*);
  guard::Refusal prepareReplay(const replay::ProgramCopy&, const guard::FramebufferGuard&,
                               const wire::ExecuteT&, const std::vector<capture::CaptureBuffer>&);
  capture::Shadow::Start start() const;
  void readOutputs(const wire::ExecuteT&, const wire::ExecutedT&, AnswerMemory& bulk);
  void readCaptured(const replay::ProgramCopy&, const wire::ExecuteT&, const wire::ExecutedT&,
                    AnswerMemory& bulk);
  guard::Refusal saveOwnMemory();
  guard::Refusal saveMemory(const replay::ProgramCopy&);
  guard::Refusal drawOriginal(const guard::FramebufferGuard&);
  const DrawFacts& facts();

  const calls::DrawCall& call_;
  guard::ErrorGuard errors_;
  std::optional<DrawFacts> facts_;
  std::unique_ptr<capture::Shadow> shadow_;
  std::optional<guard::WritableMemory> memory_;
  Check check_;
  wire::RasterT raster_;  // under which the reference was drawn
  capture::Covering covering_;
  capture::StorageBuffer storage_;
  replay::ShaderCache shaders_;
  std::optional<StageReplay> stages_;
  std::map<std::uint32_t, std::unique_ptr<replay::ProgramCopy>> prepared_;
  std::uint32_t next_handle_ = 1;
  AnswerMemory beside_;  // the last answer
};

}  // namespace shadestep::agent
