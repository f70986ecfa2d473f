// Capture passes of stages other than the fragment stage: their threads come as a list.
#include <algorithm>

#include "instrumenter/streams.h"
#include "session/session_state.h"
#include "session/thread_order.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using instrumenter::AttachmentLayout;
using instrumenter::Carrier;

constexpr std::uint64_t kHeader = 4;  // words of a list before its threads
constexpr int kLeastRoom = 16;        // components that are left to captures at least
const char* const kOnlyPoints =
    "the instrumented shader emits one point per run or vertex (without storage buffers in this stage values "
    "leave "
    "it by transform feedback alone): what it gives to the next stage is not compared";

constexpr std::uint32_t kNoMode = 0xffffffff;  // of a call that does not say what primitives it draws

bool hasWideComponents(const instrumenter::FeedbackOutput& output) {
  return wordsPerComponent(output.type.basic) == 2;
}

// The stage whose outputs a replay leaves: a control stage runs with its evaluation stage.
Stage lastOf(Stage stage) {
  return stage == Stage::tess_control ? Stage::tess_eval : stage;
}

int wordsPerThread(const AttachmentLayout& layout) {
  return layout.attachments() * 4;
}

bool isFeedback(const AttachmentLayout& layout) {
  return layout.words > 0 &&
         (layout.carrier == Carrier::uint_feedback || layout.carrier == Carrier::float_feedback);
}

// `words` of each record, which are `stride` apart in `memory`.
ThreadWords threadsOf(std::span<std::uint32_t> records, int stride, int words,
                      std::shared_ptr<const void> memory) {
  const auto apart = static_cast<std::size_t>(std::max(stride, 1));
  return {static_cast<int>(records.size() / apart), words, records.data(), apart, std::move(memory)};
}

// Threads list themselves as they end; those of instances come one after the other.
void sortByIdentity(ThreadWords& threads, const AttachmentLayout& layout, Stage stage) {
  std::vector<instrumenter::FieldDecoder> decoders;
  for (const instrumenter::Field& field : layout.identity) decoders.emplace_back(layout, field);
  const auto word = [&](std::size_t thread, std::size_t n) {
    std::uint32_t number = 0;
    decoders[n].decode(threads.head(thread), &number);
    return number;
  };
  if (ThreadOrder::liesSo(stage, threads.count(), decoders.size(), word)) return;
  const ThreadOrder order(stage, threads.count(), decoders.size(), word);
  std::vector<std::uint32_t> sorted(threads.count() * static_cast<std::size_t>(threads.words()));
  auto* next = sorted.data();
  for (std::size_t i = 0; i < order.size(); ++i, next += threads.words()) threads.read(order[i], next);
  threads = ThreadWords(threads.width(), 1, threads.words(), std::move(sorted));
}

}  // namespace

// Stream by stream, each to a buffer of its own; of each those of 64 bits first, which transform feedback
// wants at even offsets.
ComparedOutputs comparedOutputs(const frontend::Shader& last, int components) {
  ComparedOutputs compared;
  std::vector<instrumenter::FeedbackOutput> outputs = instrumenter::feedbackOutputs(last);
  std::stable_partition(outputs.begin(), outputs.end(), hasWideComponents);
  const auto stream = [&](const instrumenter::FeedbackOutput& output) {
    return last.stage == Stage::geometry ? instrumenter::streamOf(last, output.name) : 0;
  };
  std::stable_sort(outputs.begin(), outputs.end(),
                   [&](const auto& one, const auto& other) { return stream(one) < stream(other); });
  int current = 0;
  int words_before = 0;  // of the streams before
  bool wide = false;
  const auto fill = [&] {
    if (!wide || (compared.words - words_before) % 2 == 0) return;
    compared.names.emplace_back("gl_SkipComponents1");
    ++compared.words;
  };
  for (const instrumenter::FeedbackOutput& output : outputs) {
    for (; current < stream(output); ++current) {
      fill();
      compared.names.emplace_back("gl_NextBuffer");
      words_before = compared.words;
      wide = false;
    }
    const int words = frontend::wordCount(output.type);
    if (words == 0 || compared.words + words + 1 > components - kLeastRoom) {
      compared.left_out += (compared.left_out.empty() ? "" : ", ") + output.name;
      continue;
    }
    compared.names.push_back(output.name);
    compared.words += words;
    wide = wide || hasWideComponents(output);
  }
  fill();
  return compared;
}

// A copy with the stages up to the selected one. Outputs that the driver does not take are not compared.
Prepared Session::prepareStages(const std::string& text, const AttachmentLayout& layout) {
  wire::PrepareT prepare;
  prepare.stage = static_cast<wire::Stage>(stage());
  prepare.text = text;
  prepare.geometry = wire::Geometry::Unrasterized;
  prepare.storage_block = layout.list_block;
  if (isFeedback(layout)) prepare.feedback_captures = layout.outputs;
  std::string uncompared;
  if (stage() == Stage::geometry && isFeedback(layout)) {
    uncompared = kOnlyPoints;
  } else if (stage() != Stage::compute && facts().feedback_components == 0) {
    uncompared = (stop().mode == kNoMode ? "nobody knows what kind of primitives " + stop().call +
                                               " draws, which transform feedback has to be told"
                                         : "this driver has no transform feedback (OpenGL 3.0)") +
                 ": what the stage gives to the next one is not compared";
  } else if (stage() != Stage::compute) {
    ComparedOutputs outputs = comparedOutputs(shader(lastOf(stage())), facts().feedback_components);
    prepare.feedback_outputs = std::move(outputs.names);
    if (!outputs.left_out.empty())
      uncompared =
          "these outputs are not compared, for which transform feedback has no room or whose size is not "
          "known: " +
          outputs.left_out;
  }
  const bool with_outputs = !prepare.feedback_outputs.empty();
  Prepared prepared;
  try {
    prepared = send(wire::PrepareT(prepare));
  } catch (const DriverRefusal&) {
    if (!with_outputs) throw;
    prepare.feedback_outputs.clear();
    prepared = send(std::move(prepare));
    uncompared = "the driver refuses the stage's outputs in transform feedback: they are not compared";
  }
  prepared.uncompared = std::move(uncompared);
  prepared.storage = !layout.list_block.empty();
  return prepared;
}

Captured Session::captureThreads(const Prepared& prepared, const AttachmentLayout& layout,
                                 const ExecuteOptions& options) {
  Captured captured;
  captured.layout = layout;
  if (layout.carrier != Carrier::list) {
    if (stage() == Stage::tess_eval && !drawsOnce(stop()))
      throw Error(
          Outcome::cannot_debug,
          "which generated vertices of several instances or draws are the same is told by storage buffers in "
          "the evaluation stage (OpenGL 4.3), which this driver lacks");
    captured.execution = execute(prepared, options);
    captured.threads = threadsOf(captured.execution.feedback, captured.execution.feedback_words, layout.words,
                                 captured.execution.memory);
    if (stage() != Stage::vertex) sortByIdentity(captured.threads, layout, stage());
    return captured;
  }
  const auto words = static_cast<std::uint64_t>(wordsPerThread(layout));
  const std::uint64_t most = (kMostWords - kHeader) / words;
  ExecuteOptions listing = options;
  std::uint64_t ended = 0;
  while (true) {
    const std::uint64_t room = std::min(state_->listed_room, most);
    listing.storage = {0, static_cast<std::uint32_t>(room), 0, 0};
    listing.storage_words = kHeader + room * words;
    captured.execution = execute(prepared, listing);
    if (captured.execution.storage.size() < listing.storage_words)
      throw Error(Outcome::failed, "the agent's answer lacks captured values; report this as a bug");
    ended = captured.execution.storage[0];
    if (ended <= room) break;
    if (room == most) {
      throw Error(Outcome::cannot_debug, "the values of " + std::to_string(ended) +
                                             " threads take more than 1 GiB; print fewer values at once");
    }
    state_->listed_room = ended;
  }
  captured.threads = threadsOf(captured.execution.storage.subspan(kHeader, ended * words),
                               static_cast<int>(words), layout.words, captured.execution.memory);
  sortByIdentity(captured.threads, layout, stage());
  return captured;
}

}  // namespace shadestep::session
