// Replays of the stages before rasterization, and of dispatches: what threads capture leaves by transform
// feedback or by a storage buffer, and the check compares the original outputs of the last stage, and memory.
// Method: Strengert 2010, 7.1.3. Runs inside the program under debug: throws nothing, starts no thread, calls
// GL only through dispatch::gl().
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "interceptor/agent/answer_memory.h"
#include "interceptor/agent/check.h"
#include "interceptor/agent/describe.h"
#include "interceptor/capture/feedback.h"
#include "interceptor/capture/plain_target.h"
#include "interceptor/capture/storage.h"
#include "interceptor/guard/guards.h"
#include "interceptor/guard/memory.h"
#include "interceptor/replay/program_copy.h"
#include "wire/messages_generated.h"

namespace shadestep::agent {

class StageReplay {
 public:
  // Keeps references to all of them.
  StageReplay(const calls::DrawCall& call, const DrawFacts& facts, const guard::WritableMemory& memory,
              capture::StorageBuffer& storage, replay::ShaderCache& shaders)
      : call_(call),
        facts_(facts),
        memory_(memory),
        storage_(storage),
        shaders_(shaders),
        feedback_(facts.context) {}

  // The caller holds a MemoryGuard and a FramebufferGuard, and has saved what `copy` can write to.
  guard::OrRefusal<wire::ExecutedT> execute(const replay::ProgramCopy& copy, const guard::ProgramGuard&,
                                            const wire::ExecuteT&, AnswerMemory& bulk);
  // There is more memory to compare than before.
  void dropReferences();

 private:
  // The program's own shaders, in a copy with the same stages.
  struct Bare {
    std::unique_ptr<replay::ProgramCopy> copy;
    Check check;
    capture::Records records;  // that its last draw made
  };
  guard::OrRefusal<wire::ExecutedT> replay(const replay::ProgramCopy& copy, const guard::ProgramGuard&,
                                           const wire::ExecuteT&, AnswerMemory& bulk);
  guard::OrRefusal<Bare*> bareCopy(const replay::Stages&, const guard::ProgramGuard&);
  guard::Refusal drawBare(Bare&);
  bool asPoints(const replay::ProgramCopy&) const;
  capture::FeedbackLayout layoutOf(const replay::ProgramCopy&) const;
  bool ownRecords(const replay::ProgramCopy&) const;
  bool counted(const replay::ProgramCopy&) const;
  guard::Refusal prepare(const replay::ProgramCopy&);
  void call(const replay::ProgramCopy&) const;
  capture::Records drawOnce(const replay::ProgramCopy&) const;

  const calls::DrawCall& call_;
  const DrawFacts& facts_;
  const guard::WritableMemory& memory_;
  capture::StorageBuffer& storage_;
  replay::ShaderCache& shaders_;
  capture::Feedback feedback_;
  capture::PlainTarget target_;
  std::map<std::string, Bare> bare_;  // by stage and names of outputs
  std::map<wire::Stage, capture::Records> records_;
};

}  // namespace shadestep::agent
