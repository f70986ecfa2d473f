#include "session/programs.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "session/call_journal.h"
#include "session/error.h"
#include "session/session.h"
#include "session/timed_out.h"

namespace shadestep::session {
namespace {

constexpr int kGreetingMs = 5000;  // an agent speaks at once; this only bounds a broken one

// What to try where a frame or draw never came; programs that draw only on change reach few frames.
std::string earlierFrames(const LastSeen& last) {
  if (last.total_draws == 0) return "";
  return "; 'shadestep draws --frames 0.." + std::to_string(last.frame) + "' lists the draws until there";
}

wire::Listener makeListener() {
  auto listener = wire::Listener::create();
  if (!listener) throw Error(Outcome::failed, "cannot open a Unix socket to talk to the program under debug");
  return std::move(*listener);
}

// What the user gives the program, and behind it, hence stronger, what loads the interceptor.
std::vector<std::pair<std::string, std::string>> preloadEnvironment(const LaunchOptions& options,
                                                                    const std::string& interceptor,
                                                                    const std::string& socket) {
  const char* const inherited = std::getenv("LD_PRELOAD");
  std::string others = inherited != nullptr ? inherited : "";
  std::vector<std::pair<std::string, std::string>> environment;
  for (const auto& [name, value] : options.environment) {
    if (name == "LD_PRELOAD") {
      others = value;
    } else {
      environment.emplace_back(name, value);
    }
  }
  environment.emplace_back("LD_PRELOAD", others.empty() ? interceptor : interceptor + ":" + others);
  environment.emplace_back(wire::kSocketVariable, socket);
  return environment;
}

pid_t processOf(const wire::Channel& channel) {
  ucred credentials{};
  socklen_t length = sizeof credentials;
  const bool known = getsockopt(channel.descriptor(), SOL_SOCKET, SO_PEERCRED, &credentials, &length) == 0;
  return known ? credentials.pid : -1;
}

void pause(const Peer& peer) {
  peer.status().pause.store(true);
  peer.status().watching.store(true);
}

int remainingMs(const Programs::Deadline& deadline) {
  if (!deadline) return -1;
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(*deadline - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp<long long>(left.count(), 0, 1'000'000'000));
}

}  // namespace

bool sendMessage(wire::Channel& channel, const wire::MessageT& message) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(wire::Message::Pack(builder, &message));
  return channel.send({builder.GetBufferPointer(), builder.GetSize()});
}

Programs::Programs(const LaunchOptions& options, const std::string& interceptor)
    : listener_(makeListener()),
      name_(options.command.front()),
      process_(Process::launch(options.command, preloadEnvironment(options, interceptor, listener_.name()),
                               options.program_output_to_stderr, options.working_directory)),
      interrupts_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  follow_ = options.follow;
  if (options.ptrace) tracer_.emplace();
}

Programs::~Programs() {
  quit();
}

void Programs::resumeStopped() {
  if (stopped_ == nullptr) return;
  wire::MessageT message;
  message.body.Set(wire::ResumeT(policy_));
  stopped_->stopped = false;
  sendMessage(stopped_->channel, message);
  stopped_ = nullptr;
}

// A new process has connected: it says Hello, and is told the policy.
void Programs::greet() {
  auto peer = std::make_unique<Peer>();
  peer->channel = listener_.accept(0);
  wire::Packet packet;
  if (!peer->channel.open() || peer->channel.receive(packet, kGreetingMs) != wire::Received::message) return;
  const wire::Hello* hello = wire::GetMessage(packet.bytes.data())->body_as_Hello();
  if (hello == nullptr) return;
  if (hello->protocol() != wire::kProtocol) {
    throw Error(Outcome::failed, "the interceptor in the program speaks protocol " +
                                     std::to_string(hello->protocol()) + ", this shadestep " +
                                     std::to_string(wire::kProtocol) + "; use the two of one build");
  }
  peer->memory = wire::SharedMemory::map(std::move(packet.bulk));
  if (!peer->memory || peer->memory.size() < sizeof(wire::AgentMemory)) return;
  peer->pid = processOf(peer->channel);                 // the kernel's word, not the message's
  if (!follow_ && peer->pid != process_.pid()) return;  // it runs on without a debugger
  peer->program = hello->program() != nullptr ? hello->program()->str() : "";
  last_.connected = true;
  if (tracer_) tracer_->trace(peer->pid, peer->status().last_call.load());
  if (pausing_) pause(*peer);

  wire::MessageT message;
  message.body.Set(wire::ResumeT(policy_));
  if (sendMessage(peer->channel, message)) peers_.push_back(std::move(peer));
}

void Programs::noteLast(const Peer& peer) {
  const wire::StatusPage& page = peer.status();
  if (page.used_gl.load() == 0) return;
  last_.used_gl = true;
  last_.frame = page.frame.load();
  last_.draws = page.draw();
  last_.frames = last_.frame + (last_.draws > 0 ? 1 : 0);
  last_.total_draws = page.draws();
}

// The calls that a program that is gone has not sent any more.
void Programs::tellRest(const Peer& peer) {
  last_.calls.clear();
  const CallSink none = [](const wire::CallT&, bool) {};
  const CallSink& sink = call_sink_ ? call_sink_ : none;
  for (const auto& batch : unsentBatches(peer.shared().journal, peer.last_batch))
    readCalls(batch, true, sink);
  if (peer.orderly) return;
  for (const auto& call : currentCalls(peer.shared().journal)) {
    readCalls(call, false, [&](const wire::CallT& one, bool returned) {
      last_.calls.push_back(one.name);
      sink(one, returned);
    });
  }
}

void Programs::dropClosed() {
  for (const auto& peer : peers_) {
    if (peer->channel.open()) continue;
    noteLast(*peer);
    tellRest(*peer);
    if (!peer->orderly) last_.died = peer->pid;
  }
  std::erase_if(peers_, [](const auto& peer) { return !peer->channel.open(); });
}

void Programs::interrupt() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t told = write(interrupts_.get(), &one, sizeof one);
}

void Programs::pauseAll() {
  pausing_ = true;
  for (const auto& peer : peers_) pause(*peer);
}

void Programs::endPause() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t drained = read(interrupts_.get(), &count, sizeof count);
  pausing_ = false;
  for (const auto& peer : peers_) peer->status().pause.store(false);
}

std::unique_ptr<wire::MessageT> Programs::waitForStop(const Deadline& deadline) {
  while (true) {
    dropClosed();  // also where a message could not be sent: such a channel would never become readable
    std::vector<pollfd> entries;
    entries.push_back({listener_.descriptor(), POLLIN, 0});
    entries.push_back({interrupts_.get(), static_cast<short>(pausing_ ? 0 : POLLIN), 0});
    const bool running = !process_.wait(0);
    if (running) entries.push_back({process_.descriptor(), POLLIN, 0});
    const std::size_t first_peer = entries.size();
    for (const auto& peer : peers_) entries.push_back({peer->channel.descriptor(), POLLIN, 0});
    if (!running && peers_.empty()) {
      // A process may have connected just before the command ended.
      if (poll(entries.data(), 1, 0) <= 0) return nullptr;
    } else if (poll(entries.data(), entries.size(), remainingMs(deadline)) == 0) {
      for (const auto& peer : peers_) noteLast(*peer);
      throw TimedOut(Outcome::ended, "the time limit ran out while the program was in frame " +
                                         std::to_string(last_.frame) + ", after " +
                                         std::to_string(last_.draws) +
                                         " draws of it; give more with --timeout" + earlierFrames(last_));
    }

    if ((entries[1].revents & POLLIN) != 0) pauseAll();
    for (std::size_t i = 0; i < peers_.size() && first_peer + i < entries.size(); ++i) {
      if (entries[first_peer + i].revents == 0) continue;
      if (auto stopped = hear(*peers_[i])) return stopped;
    }
    if ((entries[0].revents & POLLIN) != 0) greet();
  }
}

// Takes what a program says; returns its message if it has stopped.
std::unique_ptr<wire::MessageT> Programs::hear(Peer& peer) {
  wire::Packet packet;
  if (peer.channel.receive(packet, 0) != wire::Received::message) return nullptr;  // closed: dropped soon
  std::unique_ptr<wire::MessageT> message(wire::UnPackMessage(packet.bytes.data()));
  if (const wire::CallsT* calls = message->body.AsCalls()) {
    peer.last_batch = calls->number;
    if (call_sink_) readCalls(calls->batch, true, call_sink_);
    return nullptr;
  }
  if (const wire::ExitingT* exiting = message->body.AsExiting()) {
    noteLast(peer);
    peer.orderly = last_.orderly = true;
    last_.frame = exiting->frames;
    last_.draws = exiting->draws;
    return nullptr;
  }
  const wire::CallStoppedT* call = message->body.AsCallStopped();
  if (call == nullptr && message->body.AsStopped() == nullptr && message->body.AsFrameEnded() == nullptr) {
    peer.channel.close();  // says something out of turn: not our agent
    return nullptr;
  }
  stopped_ = &peer;
  peer.stopped = true;
  noteLast(peer);
  if (call != nullptr && (call->call == nullptr || (call->reason == wire::CallReason::Paused && !pausing_))) {
    resumeStopped();  // paused together with another one, at which the run has stopped before
    return nullptr;
  }
  return message;
}

wire::Packet Programs::request(wire::MessageT& message, const Deadline& deadline) {
  if (stopped_ == nullptr) throw Error(Outcome::failed, "the program under debug is not stopped at a draw");
  wire::Packet reply;
  wire::Received received = wire::Received::closed;
  if (sendMessage(stopped_->channel, message))
    received = stopped_->channel.receive(reply, remainingMs(deadline));
  if (received == wire::Received::message) return reply;
  if (received == wire::Received::timeout) {
    throw TimedOut(Outcome::failed, "the time limit ran out during a replay; give more with --timeout");
  }
  stopped_->channel.close();
  stopped_ = nullptr;
  dropClosed();
  const auto& status = process_.wait(2000);
  throw Error(Outcome::failed, "the program under debug died while its draw was replayed" +
                                   (status ? ": it " + status->describe() : std::string()));
}

void Programs::quit() {
  if (stopped_ != nullptr) {
    wire::MessageT message;
    message.body.Set(wire::QuitT{});
    sendMessage(stopped_->channel, message);
    stopped_ = nullptr;
  }
  if (!process_.wait(0)) {
    process_.kill(SIGTERM);
    process_.kill(SIGCONT);
    if (!process_.wait(500)) process_.kill(SIGKILL);
    process_.wait(-1);
  }
  // Processes that the command started and left behind.
  for (const auto& peer : peers_) {
    if (peer->channel.open() && peer->pid > 1 && peer->pid != process_.pid()) ::kill(peer->pid, SIGKILL);
  }
  peers_.clear();
}

std::string Programs::describeEnd(const std::string& before) {
  const auto& status = process_.wait(0);
  const std::string ended = "'" + name_ + "' " + (status ? status->describe() : std::string("ended"));
  if (!last_.connected) {
    return ended + " without loading the interceptor; 'shadestep doctor -- " + name_ + "' says why";
  }
  if (!last_.used_gl)
    return ended + " without using OpenGL; 'shadestep doctor -- " + name_ + "' says what it loads";
  std::string where = " in frame " + std::to_string(last_.frame) + " after " + std::to_string(last_.draws) +
                      (last_.draws == 1 ? " draw of it" : " draws of it");
  for (const std::string& call : last_.calls) where += ", in " + call;
  const auto crash = tracer_ && last_.died != 0 ? tracer_->crash(last_.died) : std::nullopt;
  if (crash) where += ": " + describe(*crash);
  if (!before.empty()) where += ", before " + before + (last_.orderly ? earlierFrames(last_) : "");
  return ended + where;
}

}  // namespace shadestep::session
