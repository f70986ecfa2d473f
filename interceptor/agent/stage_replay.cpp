// Runs inside the program under debug: throws nothing, starts no thread, calls GL only through
// dispatch::gl().
#include "interceptor/agent/stage_replay.h"

#include <algorithm>

#include "interceptor/agent/executed.h"
#include "interceptor/guard/errors.h"
#include "interceptor/replay/stages.h"

namespace shadestep::agent {
namespace {

using guard::OrRefusal;
using guard::Refusal;

const std::vector<std::unique_ptr<wire::UniformValueT>> kNoUniforms;

// As transform feedback calls what a draw of this mode is made of.
GLenum basicMode(GLenum mode) {
  switch (mode) {
    case GL_POINTS:
      return GL_POINTS;
    case GL_LINES:
    case GL_LINE_LOOP:
    case GL_LINE_STRIP:
      return GL_LINES;
    default:
      return GL_TRIANGLES;
  }
}

Refusal driverError() {
  return guard::internal("the driver answers the replay of the call with an error");
}

}  // namespace

OrRefusal<wire::ExecutedT> StageReplay::execute(const replay::ProgramCopy& copy,
                                                const guard::ProgramGuard& program,
                                                const wire::ExecuteT& request, AnswerMemory& bulk) {
  std::optional<guard::FeedbackGuard> guard;
  if (copy.stages->last != wire::Stage::Compute) {
    guard.emplace(facts_.context);
    target_.bind();
  }
  auto result = replay(copy, program, request, bulk);
  feedback_.leaveMode(calls::feedbackMode());
  return result;
}

// Every repeat starts from the same memory and a fresh storage buffer.
OrRefusal<wire::ExecutedT> StageReplay::replay(const replay::ProgramCopy& copy,
                                               const guard::ProgramGuard& program,
                                               const wire::ExecuteT& request, AnswerMemory& bulk) {
  const replay::Stages& stages = *copy.stages;
  const std::string name = replay::stageWord(replay::shaderType(stages.last));
  StageTraces traces(facts_.context, feedback_, memory_, name);
  Bare* bare = nullptr;
  if (request.compare) {
    auto found = bareCopy(stages, program);
    if (auto* refusal = std::get_if<Refusal>(&found)) return *refusal;
    bare = std::get<Bare*>(found);
    if (!bare->check.hasReference()) {
      if (Refusal refusal = drawBare(*bare); !refusal.text.empty()) return refusal;
      if (Refusal refusal = bare->check.keepReference(traces); !refusal.text.empty()) return refusal;
    }
  }

  wire::ExecutedT executed;
  capture::Records records;
  if (Refusal refusal = replay::useCopy(copy, request.uniforms); !refusal.text.empty()) return refusal;
  CpuTime cpu;
  const std::size_t sets = std::max<std::size_t>(request.sets.size(), 1);
  for (std::size_t i = 0; i < std::max(request.repeats, 1U) * sets; ++i) {
    if (!request.sets.empty()) {
      const std::string problem = replay::setUniforms(copy.program, request.sets[i % sets]->uniforms);
      if (!problem.empty()) return guard::unsupported(problem);
    }
    if (!counted(copy)) {  // which runs the shader, too
      if (Refusal refusal = resetStorage(storage_, copy, request); !refusal.text.empty()) return refusal;
    }
    if (Refusal refusal = prepare(copy); !refusal.text.empty()) return refusal;
    if (Refusal refusal = resetStorage(storage_, copy, request); !refusal.text.empty()) return refusal;
    timed(executed, cpu, [&] { records = drawOnce(copy); });
  }
  if (guard::clearErrors()) return driverError();

  BulkLayout layout;
  executed.storage = layout.add(storage_.words() * 4);
  const bool whole = request.read_outputs;
  executed.feedback = layout.add((whole ? feedback_.words() : feedback_.captureWords()) * 4);
  executed.feedback_words =
      static_cast<std::uint32_t>(whole ? stages.feedback.words(0) : stages.feedback.capture_words);
  if (!layout.create(bulk)) return noMemory();
  if (executed.storage->bytes > 0) storage_.read(bulk.data() + executed.storage->offset);
  if (executed.feedback->bytes > 0) {
    std::byte* to = bulk.data() + executed.feedback->offset;
    whole ? feedback_.readRecords(to) : feedback_.readCaptures(to);
  }
  if (!request.compare) {
    executed.compare_reason = "not asked for";
  } else if (Refusal refusal = bare->check.compare(
                 traces, [&] { return drawBare(*bare); }, executed);
             !refusal.text.empty()) {
    return refusal;
  } else if (!stages.outputs.empty() && records != bare->records) {
    // Behind the last record of a draw lie those of the one before.
    executed.differing += feedback_.differing(records, bare->records);
  }
  if (guard::clearErrors()) return guard::internal("the driver refused to read the captured values back");
  return executed;
}

void StageReplay::dropReferences() {
  for (auto& [key, bare] : bare_) bare.check.dropReference();
}

OrRefusal<StageReplay::Bare*> StageReplay::bareCopy(const replay::Stages& stages,
                                                    const guard::ProgramGuard& program) {
  std::string key = std::to_string(static_cast<int>(stages.last));
  for (const std::string& output : stages.outputs) key += " " + output;
  const auto known = bare_.find(key);
  if (known != bare_.end()) return &known->second;

  wire::PrepareT request;
  request.stage = stages.last;
  request.geometry = wire::Geometry::Unrasterized;
  request.feedback_outputs = stages.outputs;
  program.makeCurrent();  // its subroutine choice is to be read
  auto result = replay::copyProgram(facts_.context, originalOf(facts_, stages.last), request, shaders_);
  if (auto* refusal = std::get_if<Refusal>(&result)) return *refusal;
  Bare& bare = bare_[key];
  bare.copy = std::get<std::unique_ptr<replay::ProgramCopy>>(std::move(result));
  return &bare;
}

Refusal StageReplay::drawBare(Bare& bare) {
  if (Refusal refusal = replay::useCopy(*bare.copy, kNoUniforms); !refusal.text.empty()) return refusal;
  if (Refusal refusal = prepare(*bare.copy); !refusal.text.empty()) return refusal;
  bare.records = drawOnce(*bare.copy);
  return guard::clearErrors() ? driverError() : Refusal{};
}

bool StageReplay::asPoints(const replay::ProgramCopy& copy) const {
  return copy.stages->last == wire::Stage::Vertex && call_.takes_mode;
}

// Of a vertex stage alone, by what the call draws.
capture::FeedbackLayout StageReplay::layoutOf(const replay::ProgramCopy& copy) const {
  capture::FeedbackLayout layout = copy.stages->feedback;
  if (copy.stages->last == wire::Stage::Vertex)
    layout.mode = asPoints(copy) ? GL_POINTS : basicMode(call_.mode);
  return layout;
}

// A geometry shader that gives captures alone emits what its text says; all other texts of a stage leave as
// many records as the program's own.
bool StageReplay::ownRecords(const replay::ProgramCopy& copy) const {
  return copy.stages->last == wire::Stage::Geometry && copy.stages->outputs.empty();
}

bool StageReplay::counted(const replay::ProgramCopy& copy) const {
  return copy.stages->feedback.empty() || (!ownRecords(copy) && records_.count(copy.stages->last) != 0);
}

// Everything as it was at the stop, and room for as many records as the stage makes, whatever of its texts
// runs.
Refusal StageReplay::prepare(const replay::ProgramCopy& copy) {
  const replay::Stages& stages = *copy.stages;
  capture::Records records;
  if (!counted(copy)) {
    memory_.restore();
    if (Refusal refusal = feedback_.count(
            layoutOf(copy), [&] { call(copy); }, records);
        !refusal.text.empty())
      return refusal;
    if (!ownRecords(copy)) records_[stages.last] = records;
  } else if (!stages.feedback.empty()) {
    records = records_[stages.last];
  }
  memory_.restore();
  return feedback_.reset(layoutOf(copy), std::move(records));
}

void StageReplay::call(const replay::ProgramCopy& copy) const {
  call_.replay(call_.arguments, asPoints(copy) ? GL_POINTS : call_.mode);
}

capture::Records StageReplay::drawOnce(const replay::ProgramCopy& copy) const {
  return feedback_.record([&] { call(copy); });
}

}  // namespace shadestep::agent
