// What a Session holds; shared by the files that implement it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "session/analyses.h"
#include "session/programs.h"
#include "session/session.h"
#include "session/undefined_outputs.h"

namespace shadestep::session {

// The agent's refusal as the Error that it is.
[[noreturn]] void raise(const wire::FailedT&);

inline constexpr std::uint64_t kFirstDiscardedRoom = 256;  // threads that end in a discard, at the first try

inline constexpr std::uint64_t kFirstListedRoom = 4096;  // threads of other stages, at the first try
inline constexpr std::uint64_t kMostWords = 1ull << 28;  // of a storage buffer of ours: 1 GiB

// The original outputs of a stage before rasterization that transform feedback captures beside our words.
struct ComparedOutputs {
  std::vector<std::string> names;
  int words = 0;
  std::string left_out;  // names of those that there is no room for
};
ComparedOutputs comparedOutputs(const frontend::Shader& last, int components);

struct Session::State {
  State(const LaunchOptions& options, const std::string& interceptor) : programs(options, interceptor) {
    if (options.timeout.count() > 0) deadline = std::chrono::steady_clock::now() + options.timeout;
  }

  Programs programs;
  Programs::Deadline deadline;
  std::optional<DrawStop> stop;
  std::optional<CallStop> call;
  wire::WatchT watch;  // with `visit_call`: what runUntil tells of
  CallVisitor visit_call;
  std::optional<DrawFacts> facts;
  Analyses analyses;
  std::map<Stage, const frontend::Shader*> shaders;  // of the current stop
  std::map<Stage, std::string> dropped;  // see droppedOf
  std::optional<UndefinedOutputs> undefined;
  FragmentChoice fragments;
  Stage stage = Stage::fragment;                       // that is looked at
  std::uint64_t discarded_room = kFirstDiscardedRoom;  // of the current stop
  std::uint64_t listed_room = kFirstListedRoom;
  // Beside the last answer to Execute: it goes back to the agent where nothing else holds it.
  std::shared_ptr<const wire::SharedMemory> answered;
  std::uint64_t answered_number = 0;

  void leaveStop() {
    stop.reset();
    call.reset();
    facts.reset();
    shaders.clear();
    analyses.trim();
    dropped.clear();
    undefined.reset();
    discarded_room = kFirstDiscardedRoom;
    listed_room = kFirstListedRoom;
    answered.reset();
  }

  // Of which uniforms a stage of the current draw has no values, for each check to say.
  const std::string& droppedOf(Stage);

  // Runs on under the policy until the program stops; null: it has ended.
  std::unique_ptr<wire::MessageT> resume(const wire::ResumeT& policy);
  // The same; throws Interrupted where it stops for that.
  std::unique_ptr<wire::MessageT> run(const wire::ResumeT& policy);
  void requireBeforeCall() const;
  // At a draw.
  DrawStop enter(const wire::StoppedT&);

  template <class Reply, class Request>
  std::pair<Reply, wire::Descriptor> ask(Request&& request_body) {
    if (!stop) throw Error(Outcome::failed, "select a draw first");
    return askAnywhere<Reply>(std::forward<Request>(request_body));
  }

  template <class Reply, class Request>
  std::pair<Reply, wire::Descriptor> askAnywhere(Request&& request_body) {
    wire::MessageT message;
    message.body.Set(std::forward<Request>(request_body));
    wire::Packet packet = programs.request(message, deadline);
    std::unique_ptr<wire::MessageT> reply(wire::UnPackMessage(packet.bytes.data()));
    if (const wire::FailedT* failed = reply->body.AsFailed()) raise(*failed);
    if (reply->body.type != wire::BodyTraits<typename Reply::TableType>::enum_value) {
      throw Error(Outcome::failed, "the agent answered something else than was asked; report this as a bug");
    }
    return {std::move(*static_cast<Reply*>(reply->body.value)), std::move(packet.bulk)};
  }
};

// An interrupt that was asked for during a run does not outlast it.
class RunEnd {
 public:
  explicit RunEnd(Programs& programs) : programs_(programs) {}
  ~RunEnd() { programs_.endPause(); }
  RunEnd(const RunEnd&) = delete;
  RunEnd& operator=(const RunEnd&) = delete;

 private:
  Programs& programs_;
};

}  // namespace shadestep::session
