// All processes that the launched command became: the command itself and whatever it started that loads the
// interceptor. Waits on all of them at once; hands out what they say.
#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session/process.h"
#include "session/tracer.h"
#include "wire/channel.h"
#include "wire/messages_generated.h"
#include "wire/status_page.h"

namespace shadestep::session {

struct LaunchOptions;

struct Peer {
  wire::Channel channel;
  wire::SharedMemory memory;  // holds a wire::AgentMemory
  pid_t pid = -1;
  std::string program;
  bool stopped = false;
  bool orderly = false;          // it said Exiting
  std::uint64_t last_batch = 0;  // number of the last batch of calls that came

  wire::AgentMemory& shared() const { return *reinterpret_cast<wire::AgentMemory*>(memory.data()); }
  wire::StatusPage& status() const { return shared().status; }
};

// Where the programs were at last: kept when a peer goes.
struct LastSeen {
  bool connected = false;  // some process loaded the interceptor
  bool used_gl = false;
  bool orderly = false;  // it said Exiting
  std::uint64_t frame = 0;
  std::uint64_t draws = 0;   // in that frame
  std::uint64_t frames = 0;  // ended or, without presenting, drawn to
  std::uint64_t total_draws = 0;
  pid_t died = 0;                  // the last process that ended without saying so
  std::vector<std::string> calls;  // in which its threads were, as far as calls were watched
};

class Programs {
 public:
  using Deadline = std::optional<std::chrono::steady_clock::time_point>;
  // Hears of a call, and whether it has returned.
  using CallSink = std::function<void(const wire::CallT&, bool returned)>;

  Programs(const LaunchOptions&, const std::string& interceptor);
  ~Programs();

  // What newly connected processes are told, and what `resumeAll` tells the stopped ones.
  void setPolicy(const wire::ResumeT& policy) { policy_ = policy; }
  void resumeStopped();

  // Who hears of the calls that the policy's `watch` asks for.
  void setCallSink(CallSink sink) { call_sink_ = std::move(sink); }

  // Waits until a process stops (Stopped, CallStopped, FrameEnded), and returns its message; null when all
  // have ended. Throws Error{ended} at the deadline.
  std::unique_ptr<wire::MessageT> waitForStop(const Deadline&);

  // Thread safe: the programs stop at their next calls, until endPause().
  void interrupt() noexcept;
  void endPause();
  // Thread safe: ends the process that was launched.
  void kill() noexcept { process_.kill(SIGKILL); }

  // Sends a request to the stopped process and waits for its reply. Throws Error{failed} if it died.
  wire::Packet request(wire::MessageT& message, const Deadline&);

  // Ends all processes.
  void quit();

  bool isStopped() const { return stopped_ != nullptr; }
  pid_t processId() const { return process_.pid(); }
  const LastSeen& lastSeen() const { return last_; }
  const std::optional<ExitStatus>& exitStatus() { return process_.wait(0); }
  // Where things stood when all ended, for the user; `before` is what was waited for ("" = nothing).
  std::string describeEnd(const std::string& before = "");

 private:
  void greet();
  std::unique_ptr<wire::MessageT> hear(Peer&);
  void pauseAll();
  void noteLast(const Peer&);
  void tellRest(const Peer&);
  void dropClosed();

  wire::Listener listener_;
  std::string name_;
  Process process_;
  bool follow_ = true;  // processes that the program starts
  std::vector<std::unique_ptr<Peer>> peers_;
  Peer* stopped_ = nullptr;
  wire::ResumeT policy_;
  CallSink call_sink_;
  wire::Descriptor interrupts_;  // an eventfd
  std::optional<Tracer> tracer_;
  bool pausing_ = false;
  LastSeen last_;
};

// Serializes and sends; false if the other side is gone.
bool sendMessage(wire::Channel&, const wire::MessageT&);

}  // namespace shadestep::session
