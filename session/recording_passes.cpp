// Passes that record all that single threads do.
#include <algorithm>

#include "session/session_state.h"

namespace shadestep::session {
namespace {

constexpr std::uint32_t kFirstRoomPerThread = 1 << 16;  // words a recorded thread may write at the first try
constexpr std::uint32_t kLeastRoomPerThread = 1 << 10;
constexpr std::uint64_t kMostWordsAtFirst = 1 << 22;  // every driver has as much (OpenGL 4.3, table 23.64)
constexpr std::uint32_t kThreadsPerPixel = 16;        // fragments expected at most on one pixel, first try
constexpr std::uint32_t kThreadsPerIdentity = 4;      // a vertex may be shaded several times

}  // namespace

Session::PreparedRecording Session::prepareRecording() {
  auto instrumented = instrumenter::instrumentRecording(shader(), target());
  if (const auto* failure = std::get_if<instrumenter::Failure>(&instrumented)) {
    throw Error(Outcome::cannot_debug, failure->reason);
  }
  auto& recording_shader = std::get<instrumenter::RecordingShader>(instrumented);
  Prepared prepared = prepare(recording_shader);
  return {std::move(recording_shader), std::move(prepared)};
}

Session::Recorded Session::record(int x, int y, int width, int height) {
  return record(prepareRecording(), x, y, width, height);
}

Session::Recorded Session::record(const PreparedRecording& prepared, int x, int y, int width, int height) {
  // The shader compares with gl_FragCoord, which may count rows from the top.
  const bool from_top = countsRowsFromTop(shader());
  const int first_row = from_top ? facts().height - y - height : y;
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const std::uint64_t room = pixels == 1 ? kFirstRoomPerThread : 4096;
  Recorded recorded = recordWith(prepared,
                                 {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(first_row),
                                  static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
                                 pixels * kThreadsPerPixel, room);
  if (from_top) {
    for (auto& thread : recorded.recording.threads) thread.y = facts().height - 1 - thread.y;
  }
  recorded.visible = threadWords(recorded.execution, recorded.layout.attachment.words);
  return recorded;
}

Session::Recorded Session::record(const PreparedRecording& prepared,
                                  const std::vector<std::int32_t>& identity) {
  std::vector<std::uint32_t> thread(4);
  for (std::size_t i = 0; i < identity.size() && i < thread.size(); ++i)
    thread[i] = static_cast<std::uint32_t>(identity[i]);
  return recordWith(prepared, thread, kThreadsPerIdentity, kFirstRoomPerThread);
}

// With as much room as is needed: `threads` and `room` (words each) are the first try, which tells how many
// threads there are and what they write, however little of that had room.
Session::Recorded Session::recordWith(const PreparedRecording& prepared,
                                      const std::vector<std::uint32_t>& which, std::uint64_t threads,
                                      std::uint64_t room) {
  const instrumenter::RecordingLayout& layout = prepared.shader.layout;
  threads = std::min(threads, kMostWordsAtFirst / room);
  while (true) {
    const std::uint64_t words = instrumenter::kRecordingHeader + threads * room;
    if (words > kMostWords) {
      throw Error(Outcome::cannot_debug, "the recording of these threads would take " +
                                             std::to_string(words * 4 >> 20) +
                                             " MiB; record fewer of them at once");
    }
    ExecuteOptions options;
    options.uniforms.push_back({layout.pixel_uniform, 0x8B55, which});
    options.storage = {0, static_cast<std::uint32_t>(room), static_cast<std::uint32_t>(threads), 0};
    options.storage_words = words;
    options.read_outputs = true;
    Recorded recorded;
    recorded.execution = execute(prepared.program, options);
    recorded.layout = layout;
    recorded.recording = instrumenter::decodeRecording(layout, recorded.execution.storage);
    if (!recorded.recording.error.empty()) throw Error(Outcome::failed, recorded.recording.error);

    std::uint64_t longest = 0;
    bool complete = recorded.recording.started <= threads;
    for (const auto& thread : recorded.recording.threads) {
      longest = std::max<std::uint64_t>(longest, thread.wanted);
      complete = complete && thread.complete;
    }
    if (complete) return recorded;
    // As many as there are may be too many for as much room each as was tried first.
    const std::uint64_t all = std::max<std::uint64_t>(recorded.recording.started, threads);
    const std::uint64_t least =
        all > threads ? std::min<std::uint64_t>(kLeastRoomPerThread, kMostWordsAtFirst / all) : room;
    const std::uint64_t wanted = std::max<std::uint64_t>(least, longest + instrumenter::kThreadHeader);
    if (recorded.recording.started <= threads && wanted == room) return recorded;  // some have no end
    threads = all;
    room = wanted;
  }
}

}  // namespace shadestep::session
