// The connection between agent and session: whole messages, descriptors, and every kind of bad input.
#include "wire/channel.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <random>

#include "wire/messages_generated.h"

namespace shadestep::wire {
namespace {

std::vector<std::uint8_t> helloMessage(const std::string& program) {
  MessageT message;
  HelloT hello;
  hello.protocol = kProtocol;
  hello.program = program;
  message.body.Set(std::move(hello));
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(Message::Pack(builder, &message));
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

struct Pair {
  Channel left, right;
  int raw = -1;  // the left socket's descriptor, to write garbage with
};

Pair connectedPair() {
  int sockets[2];
  EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets), 0);
  return {Channel(Descriptor(sockets[0])), Channel(Descriptor(sockets[1])), sockets[0]};
}

TEST(Channel, CarriesAMessageUnchanged) {
  Pair pair = connectedPair();
  const auto sent = helloMessage("a program");
  ASSERT_TRUE(pair.left.send(sent));
  Packet packet;
  ASSERT_EQ(pair.right.receive(packet, 1000), Received::message);
  EXPECT_EQ(packet.bytes, sent);
  EXPECT_FALSE(packet.bulk);
}

TEST(Channel, CarriesAMessageLargerThanAPacket) {
  Pair pair = connectedPair();
  std::string large(3'000'000, 'x');
  large[1'234'567] = 'y';
  ASSERT_TRUE(pair.left.send(helloMessage(large)));
  Packet packet;
  ASSERT_EQ(pair.right.receive(packet, 1000), Received::message);
  EXPECT_EQ(GetMessage(packet.bytes.data())->body_as_Hello()->program()->str(), large);
}

TEST(Channel, PassesSharedMemoryBesideTheMessage) {
  for (const std::size_t size : {10u, 200'000u}) {  // inline, and in a memfd of its own
    Pair pair = connectedPair();
    SharedMemory memory = SharedMemory::create("test", 4096);
    ASSERT_TRUE(memory);
    std::memcpy(memory.data(), "words", 6);
    ASSERT_TRUE(pair.left.send(helloMessage(std::string(size, 'x')), memory.descriptor()));
    Packet packet;
    ASSERT_EQ(pair.right.receive(packet, 1000), Received::message);
    const SharedMemory received = SharedMemory::map(std::move(packet.bulk));
    ASSERT_TRUE(received);
    EXPECT_EQ(received.size(), 4096u);
    EXPECT_STREQ(reinterpret_cast<const char*>(received.data()), "words");
  }
}

TEST(Channel, SaysThatTheOtherSideIsGone) {
  Pair pair = connectedPair();
  pair.left.close();
  Packet packet;
  EXPECT_EQ(pair.right.receive(packet, 1000), Received::closed);
  EXPECT_FALSE(pair.right.open());
  EXPECT_FALSE(pair.right.send(helloMessage("x")));
}

TEST(Channel, TimesOutWithoutLosingTheConnection) {
  Pair pair = connectedPair();
  Packet packet;
  EXPECT_EQ(pair.right.receive(packet, 0), Received::timeout);
  ASSERT_TRUE(pair.left.send(helloMessage("later")));
  EXPECT_EQ(pair.right.receive(packet, 1000), Received::message);
}

// Garbage and truncated packets end the connection; none gets through, none crashes.
TEST(Channel, RefusesGarbage) {
  std::mt19937 random(7);
  for (int round = 0; round < 500; ++round) {
    Pair pair = connectedPair();
    std::vector<std::uint8_t> bytes(random() % 200);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (bytes.empty()) bytes.push_back(0);
    ASSERT_EQ(send(pair.raw, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    Packet packet;
    EXPECT_EQ(pair.right.receive(packet, 1000), Received::malformed);
    EXPECT_FALSE(pair.right.open());
  }
}

TEST(Channel, RefusesATruncatedMessageBehindAValidHeader) {
  const auto whole = helloMessage("a program whose message is cut");
  for (std::size_t length = 1; length < whole.size(); ++length) {
    Pair pair = connectedPair();
    std::vector<std::uint8_t> packet_bytes(16 + length);
    const std::uint32_t header[4] = {0x50455453, static_cast<std::uint32_t>(length),
                                     static_cast<std::uint32_t>(length), 0};
    std::memcpy(packet_bytes.data(), header, sizeof header);
    std::memcpy(packet_bytes.data() + sizeof header, whole.data(), length);
    ASSERT_GT(send(pair.raw, packet_bytes.data(), packet_bytes.size(), 0), 0);
    Packet packet;
    // Cutting padding at the very end leaves a valid buffer; anything else must be refused.
    const Received received = pair.right.receive(packet, 1000);
    if (length < whole.size() - 8) {
      EXPECT_EQ(received, Received::malformed) << "cut to " << length << " of " << whole.size();
    }
  }
}

TEST(SharedMemory, IsNotTakenWhereTheOtherSideCouldCutIt) {
  Descriptor file(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(ftruncate(file.get(), 4096), 0);
  EXPECT_FALSE(SharedMemory::map(Descriptor(dup(file.get()))));
  ASSERT_EQ(fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW), 0);
  EXPECT_TRUE(SharedMemory::map(Descriptor(dup(file.get()))));

  const SharedMemory ours = SharedMemory::create("test", 4096);
  EXPECT_NE(ftruncate(ours.descriptor(), 1), 0);
}

TEST(Listener, RefusesAnotherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  auto listener = Listener::create();
  ASSERT_TRUE(listener);
  const pid_t other = fork();
  if (other == 0) {
    constexpr uid_t kNobody = 65534;
    const bool taken = setuid(kNobody) == 0 && Channel::connect(listener->name()).open();
    _exit(taken ? 1 : 0);
  }
  EXPECT_FALSE(listener->accept(10'000).open());
  int status = -1;
  ASSERT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0) << "the other user's side took us for its own debugger";
}

TEST(Listener, AcceptsItsOwnUser) {
  auto listener = Listener::create();
  ASSERT_TRUE(listener);
  Channel client = Channel::connect(listener->name());
  ASSERT_TRUE(client.open());
  Channel server = listener->accept(1000);
  ASSERT_TRUE(server.open());
  ASSERT_TRUE(client.send(helloMessage("x")));
  Packet packet;
  EXPECT_EQ(server.receive(packet, 1000), Received::message);
}

TEST(Listener, ConnectsNowhereWithoutAListener) {
  EXPECT_FALSE(Channel::connect("shadestep-nobody-listens").open());
}

}  // namespace
}  // namespace shadestep::wire
