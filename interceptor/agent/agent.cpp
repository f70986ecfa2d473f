// The debugger's end inside the program under debug: counts frames and draws, stops where the session wants
// to look, and serves it there on the stopped thread. Throws nothing, starts no thread; while the session has
// asked for nothing, a draw costs two counters and a comparison. Whatever happens to the connection, the
// program runs on.
#include <pthread.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>

#include "interceptor/agent/call_journal.h"
#include "interceptor/agent/stop.h"
#include "interceptor/agent/watched_calls.h"
#include "interceptor/calls/display_lists.h"
#include "interceptor/calls/hooks.h"
#include "interceptor/calls/queries.h"
#include "interceptor/calls/watch.h"
#include "interceptor/dispatch/dispatch.h"
#include "interceptor/guard/errors.h"
#include "wire/channel.h"
#include "wire/status_page.h"

namespace shadestep::agent {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

// Counts also without a session.
using calls::status;

constinit std::atomic<bool> connected{false};

// Where the session wants the program to stop; read without a lock on every draw.
constinit std::atomic<bool> armed{false};
constinit std::atomic<bool> report_frames{false};
constinit std::atomic<std::uint64_t> stop_frame{0};
constinit std::atomic<std::uint64_t> stop_draw{0};

// The connection; one thread speaks at a time, from a stop to the Resume. Never destroyed: exit handlers of
// the program may still draw.
struct Connection {
  std::mutex mutex;
  wire::Channel channel;
  wire::SharedMemory memory;
};
Connection& connection() {
  static auto* one = new Connection;
  return *one;
}

// While the session waits for a draw, threads that draw at once get their numbers and stop in one order: a
// draw that has its number must not be overtaken on its way to the stop. Taken before any other lock.
std::mutex& numbering() {
  static auto* one = new std::mutex;
  return *one;
}

// Who counts this thread's draws: the thread that drew first has a counter of its own.
enum class Drawer : char { unknown, first, other };
constinit thread_local Drawer drawer [[gnu::tls_model("initial-exec")]] = Drawer::unknown;

void countDraw() {
  static constinit std::atomic<bool> drawn{false};
  if (drawer == Drawer::unknown) [[unlikely]]
    drawer = drawn.exchange(true) ? Drawer::other : Drawer::first;
  if (drawer == Drawer::first) {
    status.first_draws.store(status.first_draws.load(kRelaxed) + 1, kRelaxed);
  } else {
    status.other_draws.fetch_add(1, kRelaxed);
  }
}

// A draw's number.
struct Number {
  std::uint64_t frame = 0;
  std::uint64_t draw = 0;
};

// This thread's, from calls::beginDraw to calls::stopAtBegun; and whether the session waits for one such draw
// of any thread: then it wants no other, nor the end of the frame.
constinit thread_local Number begun;
constinit std::atomic<bool> waits_for_begun{false};

// Under the lock of `numbering`.
Number number() {
  const Number now{status.frame.load(kRelaxed), status.draw()};
  countDraw();
  return now;
}

bool reached(const Number& number) {
  const std::uint64_t wanted = stop_frame.load(kRelaxed);
  return number.frame > wanted || (number.frame == wanted && number.draw >= stop_draw.load(kRelaxed));
}

// Under the lock of `numbering`.
bool waitsFor(const Number& number) {
  return !waits_for_begun.load(kRelaxed) && reached(number);
}

// The frame that ends, and how many draws it had. While the session waits, no draw may get its number between
// the two.
Number endFrame() {
  std::unique_lock lock(numbering(), std::defer_lock);
  if (armed.load(kRelaxed)) lock.lock();
  std::uint64_t earlier = status.earlier_draws.load(), draws = 0;
  do {
    draws = status.draws();  // after `earlier`: no other thread's frame may end between the two
  } while (!status.earlier_draws.compare_exchange_weak(earlier, draws));
  return {status.frame.fetch_add(1, kRelaxed), draws - earlier};
}

// Whether a call makes no draw now: it is part of one, or is only compiled into a display list.
bool drawsNothing() {
  return calls::betweenBeginAndEnd || (calls::compilesLists && calls::compilesOnly());
}

bool send(wire::Channel& channel, const wire::MessageT& message, int bulk = -1) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(wire::Message::Pack(builder, &message));
  return channel.send({builder.GetBufferPointer(), builder.GetSize()}, bulk);
}

template <class Body>
bool sendBody(wire::Channel& channel, Body&& body) {
  wire::MessageT message;
  message.body.Set(std::forward<Body>(body));
  return send(channel, message);
}

void obey(const wire::ResumeT& resume) {
  stop_frame.store(resume.frame, kRelaxed);
  stop_draw.store(resume.draw, kRelaxed);
  report_frames.store(resume.report_frames, kRelaxed);
  armed.store(resume.stop, kRelaxed);
  watchCalls(resume.watch.get(), resume.break_at.get());
}

void letGo(wire::Channel& channel) {
  connected.store(false, kRelaxed);
  armed.store(false, kRelaxed);
  status.pause.store(false, kRelaxed);
  watchCalls(nullptr, nullptr);
  channel.close();
}

// Answers requests until Resume. `answer` maps a request to a Reply.
template <class Answer>
void serve(wire::Channel& channel, Answer answer) {
  while (true) {
    wire::Packet packet;
    if (channel.receive(packet) != wire::Received::message) return letGo(channel);
    wire::MessageT request;
    wire::GetMessage(packet.bytes.data())->UnPackTo(&request);
    if (const wire::ResumeT* resume = request.body.AsResume()) return obey(*resume);
    if (const wire::QuitT* quit = request.body.AsQuit()) _exit(quit->status);
    const Reply reply = answer(request);
    if (!send(channel, reply.message, reply.bulk)) return letGo(channel);
  }
}

Reply notAtADraw(const wire::MessageT&) {
  wire::FailedT failure;
  failure.kind = wire::ErrorKind::Unsupported;
  failure.text = "the program is between two frames, not in a draw call; resume it to a draw first";
  Reply reply;
  reply.message.body.Set(std::move(failure));
  return reply;
}

void stopAtDraw(const calls::DrawCall& call, const Number& number) {
  sendCalls();
  Connection& session = connection();
  const std::lock_guard lock(session.mutex);
  // Another thread may have stopped meanwhile, and the session asked for something else.
  if (!armed.load(kRelaxed) || !reached(number) || dispatch::currentContext() == nullptr) return;
  Stop stop(call);
  if (!sendBody(session.channel, stop.announcement(number.frame, number.draw))) return letGo(session.channel);
  serve(session.channel, [&](const wire::MessageT& request) { return stop.answer(request); });
}

void stopAtFrameEnd(std::uint64_t frame, std::uint64_t draws) {
  sendCalls();
  Connection& session = connection();
  const std::lock_guard lock(session.mutex);
  if (!armed.load(kRelaxed)) return;
  wire::FrameEndedT ended;
  ended.frame = frame;
  ended.draws = draws;
  if (!sendBody(session.channel, std::move(ended))) return letGo(session.channel);
  serve(session.channel, notAtADraw);
}

// The memory's first page becomes the page of `status`, with what that counted so far.
bool shareStatus(const wire::SharedMemory& memory) {
  auto* shared = new (memory.data()) wire::StatusPage{};
  shared->frame.store(status.frame.load());
  shared->first_draws.store(status.first_draws.load());
  shared->other_draws.store(status.other_draws.load());
  shared->earlier_draws.store(status.earlier_draws.load());
  shared->used_gl.store(status.used_gl.load());
  shared->last_call.store(reinterpret_cast<const char*>(&calls::lastCall) -
                          static_cast<const char*>(__builtin_thread_pointer()));
  return mmap(&status, wire::kPageBytes, PROT_READ | PROT_WRITE, MAP_FIXED | MAP_SHARED, memory.descriptor(),
              0) != MAP_FAILED;
}

std::string programPath() {
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  return length > 0 ? std::string(path, static_cast<std::size_t>(length)) : std::string();
}

// A forked child has its parent's socket and memory: it leaves both alone, and takes no lock, which a thread
// that is not here may hold.
void inForkedChild() {
  armed.store(false, kRelaxed);
  connected.store(false, kRelaxed);
  useJournal(nullptr);
  const std::uint64_t frame = status.frame.load(), draw = status.draw(), draws = status.draws();
  const std::uint32_t used_gl = status.used_gl.load();
  mmap(&status, wire::kPageBytes, PROT_READ | PROT_WRITE, MAP_FIXED | MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  status.frame.store(frame, kRelaxed);
  status.other_draws.store(draws, kRelaxed);
  status.earlier_draws.store(draws - draw, kRelaxed);
  status.used_gl.store(used_gl, kRelaxed);
  connection().channel.close();
}

}  // namespace

void stopAtCall(CallStop& stop, std::optional<wire::CallReason> (*reason)(const CallStop&)) {
  sendCalls();
  Connection& session = connection();
  const std::lock_guard lock(session.mutex);
  const auto why = reason(stop);
  if (!why || !session.channel.open()) return;
  status.pause.store(false, kRelaxed);
  if (!sendBody(session.channel, stop.announcement(*why, status.draw()))) return letGo(session.channel);
  serve(session.channel, [&](const wire::MessageT& request) { return stop.answer(request); });
}

void sendToSession(wire::CallsT&& calls, bool wait) {
  Connection& session = connection();
  std::unique_lock lock(session.mutex, std::defer_lock);
  if (wait) {
    lock.lock();
  } else if (!lock.try_lock()) {
    return;
  }
  if (session.channel.open() && !sendBody(session.channel, std::move(calls))) letGo(session.channel);
}

void onLoad() {
  // A library's constructor that ran before ours may have made a context current, or another thread of it
  // does now.
  static constinit std::atomic<bool> begun{false};
  if (begun.exchange(true)) return;
  const char* socket = std::getenv(wire::kSocketVariable);
  if (socket == nullptr || *socket == '\0') return;
  Connection& session = connection();
  session.memory = wire::SharedMemory::create("shadestep-status", sizeof(wire::AgentMemory));
  session.channel = wire::Channel::connect(socket);
  if (!session.memory || !session.channel.open() || !shareStatus(session.memory))
    return session.channel.close();
  useJournal(&reinterpret_cast<wire::AgentMemory*>(session.memory.data())->journal);
  connected.store(true, kRelaxed);
  pthread_atfork(nullptr, nullptr, inForkedChild);

  wire::HelloT hello;
  hello.protocol = wire::kProtocol;
  hello.pid = getpid();
  hello.program = programPath();
  wire::MessageT message;
  message.body.Set(std::move(hello));
  if (!send(session.channel, message, session.memory.descriptor())) return letGo(session.channel);
  serve(session.channel, notAtADraw);
}

void onExit() {
  if (!connected.load(kRelaxed)) return;
  sendCalls(/*at_exit=*/true);
  // Not waiting: a signal handler may end the program on the very thread that is stopped.
  Connection& session = connection();
  const std::unique_lock lock(session.mutex, std::try_to_lock);
  if (!lock.owns_lock() || !session.channel.open()) return;
  armed.store(false, kRelaxed);
  wire::ExitingT exiting;
  exiting.frames = status.frame.load(kRelaxed);
  exiting.draws = status.draw();
  sendBody(session.channel, std::move(exiting));
  letGo(session.channel);
}

}  // namespace shadestep::agent

namespace shadestep::calls {

void onDraw(const DrawCall& call) {
  if (agent::drawsNothing()) return;
  if (!agent::armed.load(agent::kRelaxed)) return agent::countDraw();
  const std::lock_guard lock(agent::numbering());
  const agent::Number number = agent::number();
  if (agent::waitsFor(number)) agent::stopAtDraw(call, number);
}

bool beginDraw() {
  if (agent::drawsNothing()) return false;
  if (!agent::armed.load(agent::kRelaxed)) {
    agent::countDraw();
    return false;
  }
  const std::lock_guard lock(agent::numbering());
  agent::begun = agent::number();
  const bool waits = agent::waitsFor(agent::begun);
  if (waits) agent::waits_for_begun.store(true, agent::kRelaxed);
  return waits;
}

void forgetBegun() {
  agent::waits_for_begun.store(false, agent::kRelaxed);
}

void stopAtBegun(const DrawCall& call) {
  const std::lock_guard lock(agent::numbering());
  agent::waits_for_begun.store(false, agent::kRelaxed);
  agent::stopAtDraw(call, agent::begun);
}

void onPresent() {
  agent::endFrameOfCalls();
  const auto [frame, draws] = agent::endFrame();
  if (!agent::armed.load(agent::kRelaxed) || agent::waits_for_begun.load(agent::kRelaxed)) return;
  // The frame that was asked for is over: its draw was missed, or the session wants to hear of every frame.
  const std::uint64_t wanted = agent::stop_frame.load(agent::kRelaxed);
  if (frame >= wanted || agent::report_frames.load(agent::kRelaxed)) agent::stopAtFrameEnd(frame, draws);
}

void onContextCurrent() {
  agent::onLoad();
  leaveBegun();
  if (dispatch::currentContext() != nullptr) status.used_gl.store(1, agent::kRelaxed);
}

void onContextGone(const dispatch::Context& context) {
  guard::forgetErrors(&context);
  forgetQueries(context);
}

GLenum replace_glGetError() {
  return guard::programError();
}

}  // namespace shadestep::calls
