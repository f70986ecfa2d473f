// Every step of chosen threads, appended to a storage buffer in one draw.
#include "instrumenter/recording.h"

#include "instrumenter/attachments.h"
#include "instrumenter/constructs/discard.h"
#include "instrumenter/constructs/main.h"
#include "instrumenter/constructs/plain_copy.h"
#include "instrumenter/helpers/helpers.h"
#include "instrumenter/recorder.h"
#include "instrumenter/storage.h"
#include "instrumenter/words.h"

namespace shadestep::instrumenter {

using frontend::Shader;
using frontend::Type;

namespace {

std::string impossible(const Shader& shader, const Target& target) {
  const std::string lacks = noStorage(shader, target);
  if (!lacks.empty()) return "Recording needs " + lacks + "; look at single steps instead.";
  if (!isEs(shader) && shader.version < 330 && !target.bit_encoding)
    return "Recording a shader below GLSL 3.30 needs GL_ARB_shader_bit_encoding, which this driver lacks; "
           "look at single steps instead.";
  return "";
}

// Turn 0 runs the plain copy, turn 1 what follows; a thread has one turn. In a loop, not one behind the
// other: LLVM, which llvmpipe compiles with, takes a time that doubles with each of a chain of loops.
std::string turns(const Draft& draft, const std::string& plain) {
  const std::string turn = draft.name("turn");
  return "  for (" + draft.highp() + "int " + turn + " = " + draft.name("begin()") + " ? 1 : 0; " + turn +
         " < 2; " + turn + " += 2) if (" + turn + " == 0) " + plain + "(); else\n";
}

// What all recordings declare, and the functions that they use.
void declareRecording(Draft& draft) {
  requireStorage(draft);
  prepareWords(draft);
  draft.declare(inStorage(draft, draft.adapt(helpers::k_recording_declarations)));
  draft.append(draft.adapt(helpers::k_recording_functions));
}

bool usesBarriers(const Shader& shader) {
  for (const frontend::Token& token : shader.tokens)
    if (token.text == "barrier") return true;
  return false;
}

// The frame: a thread starts and ends in the new main; where nothing is recorded it runs the plain copy. The
// functions behind subroutine uniforms cannot be told apart that way, and a barrier must be one for all
// threads. A control shader has no new main.
std::string startOfThread(Draft& draft, Others others) {
  const Shader& shader = draft.shader();
  const bool copies = others == Others::plain_copies && !shader.traits.uses_subroutines &&
                      !usesBarriers(shader) && shader.stage != frontend::Stage::tess_control;
  if (!copies) return "  " + draft.name("begin();\n");
  return turns(draft, copyPlain(draft));
}

// The records themselves, and the whole text.
Result<RecordingShader> recordSteps(Draft& draft, const AttachmentLayout& attachment) {
  Recorder recorder(draft);
  recorder.recordFunctions();
  recorder.recordStatements();

  auto text = draft.finish();
  if (auto* failure = std::get_if<Failure>(&text)) return *failure;
  RecordingLayout layout;
  layout.block = draft.name("Record");
  layout.pixel_uniform = draft.name("pixel");
  layout.records = recorder.takeRecords();
  layout.attachment = attachment;
  return RecordingShader{std::move(std::get<std::string>(text)), std::move(layout)};
}

Result<RecordingShader> recordFragments(const Shader& shader, const Target& target, Others others) {
  Draft draft(shader);
  Attachments attachments(draft, target);
  std::string reason = attachments.failure();
  if (reason.empty()) reason = impossible(shader, target);
  if (!reason.empty()) return Failure{reason};

  declareRecording(draft);
  Type invocation;
  invocation.basic = frontend::Basic::uint_;
  attachments.add("invocation", invocation);
  attachments.declare();
  draft.append(draft.adapt(helpers::k_recording_fragment));
  wrapMain(draft, startOfThread(draft, others),
           "  " + draft.name("end(1);\n") + "  " +
               attachments.assign(kLaunched | kReached, {draft.name("invocation")}) + ";\n" +
               attachments.write());
  if (shader.traits.uses_discard) wrapDiscards(draft, "  " + draft.name("end(2);\n"));
  return recordSteps(draft, attachments.layout());
}

std::string asInteger(const Identity& one) {
  return one.basic == frontend::Basic::float_ ? "floatBitsToInt(" + one.expression + ")" : one.expression;
}

// Of another stage: the one thread that the uniform names.
Result<RecordingShader> recordThread(const Shader& shader, const Target& target, Others others) {
  Draft draft(shader);
  const std::vector<Identity> identity = identityOf(shader, target);
  std::string reason = impossible(shader, target);
  if (reason.empty() && identity.empty())
    reason =
        "Recording one thread of this stage needs gl_VertexID, which the shader's dialect lacks; look at "
        "single "
        "steps instead.";
  if (!reason.empty()) return Failure{reason};

  declareRecording(draft);
  std::string numbers;
  for (std::size_t i = 0; i < 3; ++i)
    numbers += (i > 0 ? ", " : "") + (i < identity.size() ? asInteger(identity[i]) : "0");
  for (const Identity& one : identity)
    if (!one.extension.empty()) draft.require(one.extension);
  draft.append("ivec3 " + draft.name("identity") + "() { return ivec3(" + numbers + "); }");
  draft.append(draft.adapt(helpers::k_recording_thread));
  wrapMain(draft, startOfThread(draft, others), "  " + draft.name("end(1);\n"));
  AttachmentLayout none;
  none.words = 0;
  return recordSteps(draft, none);
}

}  // namespace

Result<RecordingShader> instrumentRecording(const Shader& shader, const Target& target) {
  return instrumentRecording(shader, target, Others::plain_copies);
}

Result<RecordingShader> instrumentRecording(const Shader& shader, const Target& target, Others others) {
  return shader.stage == frontend::Stage::fragment ? recordFragments(shader, target, others)
                                                   : recordThread(shader, target, others);
}

}  // namespace shadestep::instrumenter
