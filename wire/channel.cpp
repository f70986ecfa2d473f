#include "wire/channel.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "wire/messages_generated.h"

namespace shadestep::wire {
namespace {

// A packet is this header and, if `inline_bytes` says so, the message. A longer message is a memfd of
// `total_bytes`, passed before the bulk descriptor.
struct PacketHeader {
  std::uint32_t magic;
  std::uint32_t total_bytes;
  std::uint32_t inline_bytes;  // total_bytes or 0
  std::uint32_t has_bulk;
};
constexpr std::uint32_t kMagic = 0x50455453;  // "STEP"
constexpr std::size_t kLargestInline = 64 * 1024;
constexpr std::size_t kLargestMessage = 256u * 1024 * 1024;
// Memory that the other side could cut short would kill who reads it (SIGBUS).
constexpr int kOfFixedSize = F_SEAL_SHRINK | F_SEAL_GROW;

sockaddr_un abstractAddress(const std::string& name, socklen_t& length) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t n = std::min(name.size(), sizeof(address.sun_path) - 1);
  std::memcpy(address.sun_path + 1, name.data(), n);
  length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + n);
  return address;
}

bool sameUser(int socket) {
  ucred credentials{};
  socklen_t length = sizeof credentials;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &length) == 0 &&
         credentials.uid == geteuid();
}

// True when `fd` has something to read (or hung up) within the time.
bool waitReadable(int fd, int timeout_ms) {
  pollfd entry{fd, POLLIN, 0};
  while (true) {
    const int ready = poll(&entry, 1, timeout_ms);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

bool verified(const std::vector<std::uint8_t>& bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), 64, 4'000'000);
  if (!VerifyMessageBuffer(verifier)) return false;
  // A union may be valid and say nothing.
  const Message* message = GetMessage(bytes.data());
  return message->body_type() <= Body::MAX && message->body() != nullptr;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    reset();
    fd_ = other.release();
  }
  return *this;
}

void Descriptor::reset() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Channel Channel::connect(const std::string& name) {
  Descriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (!socket) return {};
  socklen_t length = 0;
  const sockaddr_un address = abstractAddress(name, length);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0) return {};
  if (!sameUser(socket.get())) return {};
  return Channel(std::move(socket));
}

bool Channel::send(std::span<const std::uint8_t> message, int bulk) {
  if (!open() || message.size() > kLargestMessage) return false;
  const auto total = static_cast<std::uint32_t>(message.size());
  const bool fits = message.size() <= kLargestInline;
  PacketHeader header{kMagic, total, fits ? total : 0, bulk >= 0 ? 1u : 0u};

  SharedMemory spill;
  if (!fits) {
    spill = SharedMemory::create("shadestep-message", message.size());
    if (!spill) return false;
    std::memcpy(spill.data(), message.data(), message.size());
  }

  iovec parts[2] = {{&header, sizeof header},
                    {const_cast<std::uint8_t*>(message.data()), fits ? message.size() : 0}};
  msghdr packet{};
  packet.msg_iov = parts;
  packet.msg_iovlen = 2;

  int descriptors[2];
  int count = 0;
  if (!fits) descriptors[count++] = spill.descriptor();
  if (bulk >= 0) descriptors[count++] = bulk;
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof descriptors)] = {};
  if (count > 0) {
    const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(int);
    packet.msg_control = control;
    packet.msg_controllen = CMSG_SPACE(bytes);
    cmsghdr* head = CMSG_FIRSTHDR(&packet);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(bytes);
    std::memcpy(CMSG_DATA(head), descriptors, bytes);
  }

  ssize_t sent;
  do {
    sent = sendmsg(socket_.get(), &packet, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  if (sent < 0) {
    close();
    return false;
  }
  return true;
}

Received Channel::receive(Packet& result, int timeout_ms) {
  if (!open()) return Received::closed;
  if (!waitReadable(socket_.get(), timeout_ms)) return Received::timeout;

  PacketHeader header{};
  std::vector<std::uint8_t> bytes(kLargestInline);
  iovec parts[2] = {{&header, sizeof header}, {bytes.data(), bytes.size()}};
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
  msghdr packet{};
  packet.msg_iov = parts;
  packet.msg_iovlen = 2;
  packet.msg_control = control;
  packet.msg_controllen = sizeof control;

  ssize_t got;
  do {
    got = recvmsg(socket_.get(), &packet, MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  if (got <= 0) {
    close();
    return Received::closed;
  }

  Descriptor descriptors[2];
  std::size_t count = 0;
  for (cmsghdr* head = CMSG_FIRSTHDR(&packet); head != nullptr; head = CMSG_NXTHDR(&packet, head)) {
    if (head->cmsg_level != SOL_SOCKET || head->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t held = (head->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < held; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(head) + i * sizeof(int), sizeof fd);
      if (count < 2) {
        descriptors[count++] = Descriptor(fd);
      } else {
        ::close(fd);
      }
    }
  }

  const auto malformed = [&] {
    close();
    return Received::malformed;
  };
  const bool fits = header.inline_bytes != 0;
  const std::size_t expected = (fits ? 0u : 1u) + header.has_bulk;
  if (static_cast<std::size_t>(got) < sizeof header || header.magic != kMagic || header.has_bulk > 1 ||
      header.total_bytes > kLargestMessage || count != expected ||
      static_cast<std::size_t>(got) != sizeof header + header.inline_bytes) {
    return malformed();
  }
  if (fits) {
    if (header.inline_bytes != header.total_bytes) return malformed();
    bytes.resize(header.total_bytes);
  } else {
    const SharedMemory spill = SharedMemory::map(std::move(descriptors[0]));
    if (!spill || spill.size() < header.total_bytes) return malformed();
    const auto* first = reinterpret_cast<const std::uint8_t*>(spill.data());
    bytes.assign(first, first + header.total_bytes);
  }
  if (!verified(bytes)) return malformed();

  result.bytes = std::move(bytes);
  result.bulk = header.has_bulk != 0 ? std::move(descriptors[fits ? 0 : 1]) : Descriptor();
  return Received::message;
}

std::optional<Listener> Listener::create() {
  std::uint64_t random[2] = {};
  if (getrandom(random, sizeof random, 0) != static_cast<ssize_t>(sizeof random)) return std::nullopt;
  char name[64];
  std::snprintf(name, sizeof name, "shadestep-%016llx%016llx", static_cast<unsigned long long>(random[0]),
                static_cast<unsigned long long>(random[1]));

  Listener listener;
  listener.name_ = name;
  listener.socket_ = Descriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  if (!listener.socket_) return std::nullopt;
  socklen_t length = 0;
  const sockaddr_un address = abstractAddress(listener.name_, length);
  if (bind(listener.socket_.get(), reinterpret_cast<const sockaddr*>(&address), length) != 0)
    return std::nullopt;
  if (listen(listener.socket_.get(), 16) != 0) return std::nullopt;
  return listener;
}

Channel Listener::accept(int timeout_ms) {
  if (!waitReadable(socket_.get(), timeout_ms)) return {};
  Descriptor socket(accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!socket || !sameUser(socket.get())) return {};
  return Channel(std::move(socket));
}

SharedMemory SharedMemory::create(const char* label, std::size_t bytes) {
  Descriptor fd(memfd_create(label, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!fd || ftruncate(fd.get(), static_cast<off_t>(bytes)) != 0 ||
      fcntl(fd.get(), F_ADD_SEALS, kOfFixedSize) != 0)
    return {};
  return map(std::move(fd));
}

SharedMemory SharedMemory::map(Descriptor fd) {
  struct stat info {};
  const int seals = fd ? fcntl(fd.get(), F_GET_SEALS) : -1;
  if (seals < 0 || (seals & kOfFixedSize) != kOfFixedSize) return {};
  if (fstat(fd.get(), &info) != 0 || info.st_size <= 0) return {};
  const auto size = static_cast<std::size_t>(info.st_size);
  // All of it is about to be written or read: mapped at once it costs no fault a page.
  void* data = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd.get(), 0);
  if (data == MAP_FAILED) return {};
  SharedMemory memory;
  memory.fd_ = std::move(fd);
  memory.data_ = static_cast<std::byte*>(data);
  memory.size_ = size;
  return memory;
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : fd_(std::move(other.fd_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  if (this != &other) {
    if (data_ != nullptr) munmap(data_, size_);
    fd_ = std::move(other.fd_);
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
  }
  return *this;
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) munmap(data_, size_);
}

}  // namespace shadestep::wire
