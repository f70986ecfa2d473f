// One end of the connection between agent and session: whole messages, each with at most one descriptor.
// Runs inside the debugged program too: no exceptions, no threads, SIGPIPE never raised.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shadestep::wire {

// Raised when the schema or AgentMemory change their meaning; Hello carries it.
inline constexpr std::uint32_t kProtocol = 5;

// Environment variable by which the session tells the agent the (abstract) socket name.
inline constexpr const char* kSocketVariable = "SHADESTEP_SOCKET";

// Executed.compare_reason where a draw leaves nothing that could be compared.
inline constexpr const char* kNothingToCompare = "it writes nothing that could be compared";

// An owned file descriptor; closes it.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { reset(); }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  int release() {
    const int fd = fd_;
    fd_ = -1;
    return fd;
  }
  void reset();

 private:
  int fd_ = -1;
};

// A message as received. `bytes` is a verified FlatBuffer of wire::Message.
struct Packet {
  std::vector<std::uint8_t> bytes;
  Descriptor bulk;  // the memfd beside the message, if any
};

// How a receive ended.
enum class Received { message, closed, timeout, malformed };

// A connected SOCK_SEQPACKET socket. Messages larger than a packet travel in a memfd, unseen by the caller.
class Channel {
 public:
  Channel() = default;
  explicit Channel(Descriptor socket) : socket_(std::move(socket)) {}

  // Connects to the abstract socket `name`; the channel is not open if that fails.
  static Channel connect(const std::string& name);

  bool open() const { return static_cast<bool>(socket_); }
  int descriptor() const { return socket_.get(); }
  void close() { socket_.reset(); }

  // False if the other side is gone; then the channel is closed.
  bool send(std::span<const std::uint8_t> message, int bulk = -1);
  // Waits at most timeout_ms (-1: for ever). Malformed packets close the channel.
  Received receive(Packet& packet, int timeout_ms = -1);

 private:
  Descriptor socket_;
};

// Listens on an abstract socket with a fresh name: nothing in the file system, nothing left after a crash.
class Listener {
 public:
  static std::optional<Listener> create();
  const std::string& name() const { return name_; }
  int descriptor() const { return socket_.get(); }
  // Accepts one connection of the same user; others are refused. Not open: nothing came in time.
  Channel accept(int timeout_ms);

 private:
  Descriptor socket_;
  std::string name_;
};

// Anonymous shared memory of a fixed size, mapped.
class SharedMemory {
 public:
  SharedMemory() = default;
  static SharedMemory create(const char* label, std::size_t bytes);  // empty on failure
  // The whole of another's; empty on failure, and where its size is not sealed.
  static SharedMemory map(Descriptor fd);
  SharedMemory(SharedMemory&&) noexcept;
  SharedMemory& operator=(SharedMemory&&) noexcept;
  ~SharedMemory();
  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  int descriptor() const { return fd_.get(); }
  explicit operator bool() const { return data_ != nullptr; }

 private:
  Descriptor fd_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace shadestep::wire
