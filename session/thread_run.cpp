#include "session/thread_run.h"

#include <algorithm>

#include "instrumenter/recording.h"
#include "session/probed_run.h"

namespace shadestep::session {

const char* kindName(Step::Kind kind) {
  switch (kind) {
    case Step::Kind::statement:
      return "statement";
    case Step::Kind::condition:
      return "condition";
    case Step::Kind::call:
      return "call";
    case Step::Kind::enter:
      return "enter";
    case Step::Kind::leave:
      return "leave";
    case Step::Kind::return_:
      return "return";
    case Step::Kind::jump:
      return "jump";
    case Step::Kind::declarator:
      return "declarator";
    case Step::Kind::cut:
      return "cut";
  }
  return "?";
}

std::vector<ThreadRun::Output> outputsAt(const Execution& execution, int x, int y) {
  const std::size_t pixel = (static_cast<std::size_t>(y) * static_cast<std::size_t>(execution.width) +
                             static_cast<std::size_t>(x)) *
                            4;
  std::vector<ThreadRun::Output> outputs;
  for (const ColorOutput& output : execution.outputs) {
    const auto first = output.words.begin() + static_cast<std::ptrdiff_t>(pixel);
    outputs.push_back({output.draw_buffer, {output.type, {first, first + 4}}});
  }
  return outputs;
}

// Which fragment the pixel shows is written to the attachment by the fragment itself.
int visibleThread(const Session::Recorded& recorded, int x, int y) {
  const instrumenter::AttachmentLayout& attachment = recorded.layout.attachment;
  const std::uint32_t* words = recorded.visible.head(recorded.visible.index(x, y));
  if (instrumenter::decodeMark(attachment, words) == 0) return -1;
  const std::uint32_t shown = instrumenter::decode(attachment, attachment.fields.at(0), words).words.at(0);
  const auto& threads = recorded.recording.threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    if (threads[i].invocation == shown) return static_cast<int>(i);
  }
  return -1;
}

PixelHits hitsOn(const Session::Recorded& recorded, int x, int y) {
  PixelHits hits;
  hits.count = static_cast<int>(recorded.recording.threads.size());
  hits.visible = visibleThread(recorded, x, y);
  for (const auto& thread : recorded.recording.threads) hits.discarded.push_back(thread.discarded);
  return hits;
}

int pickHit(const PixelHits& hits, int x, int y, int hit) {
  if (hit >= hits.count) {
    throw Error(Outcome::nothing_matches,
                "no hit " + std::to_string(hit) + " on pixel " + std::to_string(x) + "," + std::to_string(y) +
                    ", which has " + std::to_string(hits.count) + ": 0 to " + std::to_string(hits.count - 1));
  }
  return hit >= 0 ? hit : hits.visible >= 0 ? hits.visible : hits.count - 1;
}

namespace {

void requireInside(Session& session, int x, int y) {
  const DrawFacts& facts = session.facts();
  if (x >= 0 && y >= 0 && x < facts.width && y < facts.height) return;
  throw Error(Outcome::nothing_matches, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                            " is outside the target of " + std::to_string(facts.width) +
                                            " x " + std::to_string(facts.height) + " pixels");
}

bool holdsCutLoop(const frontend::Shader& shader, const Session::Recorded& recorded) {
  for (const instrumenter::ThreadRecording& thread : recorded.recording.threads) {
    for (const Step& step : stepsOf(shader, recorded.layout, thread))
      if (step.kind == Step::Kind::cut) return true;
  }
  return false;
}

// Where the driver ends loops, the copies that other threads run take iterations away from the recorded one:
// then all threads run the same text. Even so the driver may leave a hole where it ends the loop.
Session::Recorded recordUncut(Session& session, const Session::PreparedRecording& prepared, int x, int y) {
  const frontend::Shader& shader = session.shader(Stage::fragment);
  try {
    Session::Recorded recorded = session.record(prepared, x, y, 1, 1);
    if (!holdsCutLoop(shader, recorded)) return recorded;
  } catch (const Error& error) {
    if (error.outcome() != Outcome::failed) throw;
  }
  auto same = instrumenter::instrumentRecording(shader, session.target(), instrumenter::Others::the_same);
  if (const auto* failure = std::get_if<instrumenter::Failure>(&same))
    throw Error(Outcome::cannot_debug, failure->reason);
  auto& text = std::get<instrumenter::RecordingShader>(same);
  Prepared program = session.prepare(text);
  return session.record({std::move(text), std::move(program)}, x, y, 1, 1);
}

Session::Recorded recordPixel(Session& session, const Session::PreparedRecording& prepared, int x, int y) {
  Session::Recorded recorded = recordUncut(session, prepared, x, y);
  if (!recorded.recording.threads.empty()) return recorded;
  const DrawFacts& facts = session.facts();
  throw Error(Outcome::nothing_matches,
              "the draw has no fragment on pixel " + std::to_string(x) + "," + std::to_string(y) +
                  " (viewport " + std::to_string(facts.viewport[0]) + "," +
                  std::to_string(facts.viewport[1]) + " " + std::to_string(facts.viewport[2]) + " x " +
                  std::to_string(facts.viewport[3]) + "); pick one that it covers");
}

}  // namespace

Session::Recorded recordPixel(Session& session, int x, int y) {
  requireInside(session, x, y);
  return recordPixel(session, session.prepareRecording(), x, y);
}

ThreadRun followPixel(Session& session, int x, int y, int hit) {
  requireInside(session, x, y);
  std::optional<Session::PreparedRecording> prepared;
  try {
    prepared.emplace(session.prepareRecording());
  } catch (const Error& error) {
    // No storage buffers in this driver or dialect, or none left: the visible fragment can be followed all
    // the same.
    if (error.outcome() != Outcome::cannot_debug || hit > 0) throw;
  }
  if (!prepared) return followPixelByProbes(session, x, y);
  const Session::Recorded recorded = recordPixel(session, *prepared, x, y);
  const PixelHits hits = hitsOn(recorded, x, y);
  const int chosen = pickHit(hits, x, y, hit);

  const instrumenter::ThreadRecording& thread = recorded.recording.threads[static_cast<std::size_t>(chosen)];
  ThreadRun run;
  run.x = x;
  run.y = y;
  run.hit = chosen;
  run.hits = hits.count;
  run.visible_hit = hits.visible;
  run.visible = chosen == hits.visible;
  run.discarded = thread.discarded;
  run.steps = stepsOf(session.shader(Stage::fragment), recorded.layout, thread);
  run.outputs = outputsAt(recorded.execution, x, y);
  run.check = recorded.execution.check;
  // Redraws see the visible fragment only.
  if (run.visible) {
    run = trusted(std::move(run), [&] {
      ThreadRun redrawn = followPixelByProbes(session, x, y);
      redrawn.hit = redrawn.visible_hit = chosen;
      redrawn.hits = hits.count;
      return redrawn;
    });
  }
  return run;
}

}  // namespace shadestep::session
