// What is prepared and captured at the draw at which the program stands.
#include <algorithm>

#include "session/discarded_threads.h"
#include "session/session_state.h"

namespace shadestep::session {

void raise(const wire::FailedT& failed) {
  switch (failed.kind) {
    case wire::ErrorKind::Compile:
      throw DriverRefusal("the driver refused the instrumented shader: ", failed.text);
    case wire::ErrorKind::Link:
      throw DriverRefusal("the driver could not link the instrumented program: ", failed.text);
    default:
      throw Error(Outcome::cannot_debug, failed.text);
  }
}

// layout(origin_upper_left) in vec4 gl_FragCoord;
bool countsRowsFromTop(const frontend::Shader& shader) {
  return std::any_of(shader.tokens.begin(), shader.tokens.end(),
                     [](const frontend::Token& token) { return token.text == "origin_upper_left"; });
}

namespace {

std::vector<std::string> outputNames(const frontend::Shader& shader) {
  std::vector<std::string> names;
  for (const frontend::VariableId id : shader.outputs) {
    names.push_back(shader.variables[static_cast<std::size_t>(id)].name);
  }
  return names;
}

wire::PrepareT preparation(const frontend::Shader& shader, const std::string& text) {
  wire::PrepareT prepare;
  prepare.stage = static_cast<wire::Stage>(shader.stage);
  prepare.text = text;
  prepare.user_outputs = outputNames(shader);
  return prepare;
}

wire::PrepareT preparation(const frontend::Shader& shader, const std::string& text,
                           const instrumenter::AttachmentLayout& layout) {
  wire::PrepareT prepare = preparation(shader, text);
  const bool as_floats = layout.carrier == instrumenter::Carrier::float_attachments;
  prepare.first_frag_data = layout.outputs.empty() ? layout.first_frag_data : -1;
  for (int i = 0; i < layout.attachments(); ++i) {
    auto capture = std::make_unique<wire::CaptureOutputT>();
    if (!layout.outputs.empty()) capture->name = layout.outputs[static_cast<std::size_t>(i)];
    capture->format = as_floats ? wire::CaptureFormat::Float4 : wire::CaptureFormat::Uint4;
    prepare.captures.push_back(std::move(capture));
  }
  return prepare;
}

}  // namespace

void Session::choose(const FragmentChoice& choice) {
  const DrawFacts& draw = facts();
  const auto among = [](int chosen, int there, const std::string& what) {
    if (chosen >= 0 && chosen < std::max(there, 1)) return;
    throw Error(Outcome::nothing_matches,
                there == 0 ? "the draw's target has no " + what + "s to choose from"
                           : "no " + what + " " + std::to_string(chosen) + "; the draw's target has " +
                                 std::to_string(there) + ": 0 to " + std::to_string(there - 1));
  };
  among(choice.layer, draw.layers, "layer");
  among(choice.sample, draw.samples, "sample");
  if (choice.alpha_test == FragmentChoice::Switch::on && (draw.core || draw.es)) {
    throw Error(Outcome::cannot_debug, "there is no alpha test in " +
                                           std::string(draw.es ? "OpenGL ES" : "a core profile") +
                                           ", which the program uses");
  }
  state_->fragments = choice;
  state_->undefined.reset();
}

Prepared Session::send(wire::PrepareT&& prepare) {
  const auto [reply, bulk] = state_->ask<wire::PreparedT>(std::move(prepare));
  Prepared prepared(this, reply.handle);
  prepared.compile_time = std::chrono::nanoseconds(reply.compile_ns);
  prepared.output_locations = reply.output_locations;
  return prepared;
}

Prepared Session::prepare(const instrumenter::AttachmentShader& instrumented) {
  requireCapturable();
  if (stage() != Stage::fragment) return prepareStages(instrumented.text, instrumented.layout);
  return sendFragments(instrumented, nullptr);
}

Prepared Session::prepare(const instrumenter::AttachmentShader& instrumented, Stage beside,
                          const std::string& text) {
  requireCapturable();
  auto other = std::make_unique<wire::StageTextT>();
  other->stage = static_cast<wire::Stage>(beside);
  other->text = text;
  return sendFragments(instrumented, std::move(other));
}

Prepared Session::sendFragments(const instrumenter::AttachmentShader& instrumented,
                                std::unique_ptr<wire::StageTextT> beside) {
  auto prepare = preparation(shader(), instrumented.text, instrumented.layout);
  prepare.storage_block = instrumented.layout.discarded_block;
  prepare.beside = std::move(beside);
  Prepared prepared = send(std::move(prepare));
  prepared.storage = !instrumented.layout.discarded_block.empty();
  return prepared;
}

Prepared Session::prepare(const instrumenter::RecordingShader& instrumented) {
  requireCapturable();
  if (stage() != Stage::fragment) return prepareStorage(instrumented.text, instrumented.layout.block);
  auto prepare = preparation(shader(), instrumented.text, instrumented.layout.attachment);
  prepare.storage_block = instrumented.layout.block;
  return send(std::move(prepare));
}

Prepared Session::prepareOriginal() {
  return prepareText("");
}

Prepared Session::prepareText(const std::string& text) {
  requireCapturable();
  if (stage() == Stage::fragment) return send(preparation(shader(), text));
  instrumenter::AttachmentLayout none;
  none.words = 0;
  return prepareStages(text, none);
}

Prepared Session::prepareStorage(const std::string& text, const std::string& block) {
  requireCapturable();
  if (stage() != Stage::fragment) {
    instrumenter::AttachmentLayout layout;
    layout.words = 0;
    layout.list_block = block;
    return prepareStages(text, layout);
  }
  wire::PrepareT prepare = preparation(shader(), text);
  prepare.storage_block = block;
  return send(std::move(prepare));
}

Prepared Session::prepareCovering(const std::string& fragment_text, const std::string& vertex_text) {
  requireCapturable();
  wire::PrepareT prepare = preparation(shader(), fragment_text);
  prepare.geometry = wire::Geometry::Covering;
  prepare.vertex_text = vertex_text;
  return send(std::move(prepare));
}

Captured Session::capture(const instrumenter::AttachmentShader& instrumented, const ExecuteOptions& options) {
  return capture(prepare(instrumented), instrumented.layout, options);
}

Captured Session::capture(const Prepared& prepared, const instrumenter::AttachmentLayout& layout,
                          const ExecuteOptions& options) {
  if (stage() != Stage::fragment) return captureThreads(prepared, layout, options);
  Captured captured;
  captured.layout = layout;
  if (layout.discarded_block.empty()) {
    captured.execution = execute(prepared, options);
    captured.threads = threadWords(captured.execution, layout.words);
    if (shader().traits.uses_discard) {
      captured.execution.check.left_out =
          "threads that end in a discard write nothing and are left out (this driver or dialect has no "
          "storage "
          "buffers for them); 'debug --pixel' follows them";
    }
  } else {
    const instrumenter::DiscardedThreads discarded = captureListed(prepared, options, captured);
    captured.threads = threadWords(captured.execution, layout.words);
    captured.execution.check.left_out =
        severalPlanes(facts()) && discarded.ended > 0
            ? kDiscardedPlanes
            : addDiscarded(captured.threads, layout, discarded, countsRowsFromTop(shader()));
    captured.execution.storage = {};
  }
  return captured;
}

// Once more if there are more of them than before.
instrumenter::DiscardedThreads Session::captureListed(const Prepared& prepared, ExecuteOptions options,
                                                      Captured& captured) {
  const auto words = static_cast<std::uint64_t>(captured.layout.discarded_words);
  const std::uint64_t most = (kMostWords - instrumenter::kDiscardedHeader) / words;
  while (true) {
    const std::uint64_t room = std::min(state_->discarded_room, most);
    options.storage = {0, static_cast<std::uint32_t>(room), 0, 0};
    options.storage_words = instrumenter::kDiscardedHeader + room * words;
    captured.execution = execute(prepared, options);
    const auto discarded = instrumenter::decodeDiscarded(captured.layout, captured.execution.storage);
    if (discarded.ended <= room || room == most) return discarded;
    state_->discarded_room = discarded.ended;
  }
}

void Session::release(std::uint32_t handle) noexcept {
  if (!state_->stop || !state_->programs.isStopped()) return;
  try {
    wire::ReleaseT release;
    release.handle = handle;
    state_->ask<wire::DoneT>(std::move(release));
  } catch (const Error&) {
    // The program is gone or will be: nothing is left to release.
  }
}

}  // namespace shadestep::session
