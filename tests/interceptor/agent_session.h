// The session's side of the wire, as small as it gets: starts a scene under the preload library and talks to
// the agent in it.
#pragma once

#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "wire/channel.h"
#include "wire/messages_generated.h"
#include "wire/status_page.h"

namespace agent_test {

namespace wire = shadestep::wire;

inline constexpr int kWidth = 48, kHeight = 32;
inline constexpr int kPatience = 60'000;  // milliseconds; only a hang takes that long

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// A folder that goes with the test, unless the test failed.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "shadestep-agent-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "cannot make " << name;
    path_ = name;
  }
  ~Folder() {
    if (testing::Test::HasFailure()) {
      std::fprintf(stderr, "kept: %s\n", path_.c_str());
    } else {
      std::filesystem::remove_all(path_);
    }
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// A running scene; waited for at the latest when it goes.
class Scene {
 public:
  Scene(const std::vector<std::string>& command, const std::vector<std::string>& variables) {
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::vector<char*> environment;
    for (char** entry = environ; *entry != nullptr; ++entry) {
      if (std::strncmp(*entry, "LD_PRELOAD=", 11) != 0) environment.push_back(*entry);
    }
    for (const std::string& entry : variables) environment.push_back(const_cast<char*>(entry.c_str()));
    environment.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, arguments[0], nullptr, nullptr, arguments.data(), environment.data()), 0);
  }
  ~Scene() { status(); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  // Exit status, or 128 + signal.
  int status() {
    int raw = 0;
    if (!status_ && waitpid(pid_, &raw, 0) == pid_)
      status_ = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
    return status_.value_or(-1);
  }
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

inline void run(const std::vector<std::string>& command) {
  Scene scene(command, {});
  ASSERT_EQ(scene.status(), 0) << command[0];
}

class Session {
 public:
  // `out`: the scene's second argument, "" for none.
  Session(const std::string& scene, const std::string& name, const std::string& out)
      : listener_(*wire::Listener::create()),
        scene_(command(scene, name, out),
               {"LD_PRELOAD=" PRELOAD_LIBRARY, "SHADESTEP_SOCKET=" + listener_.name()}),
        channel_(listener_.accept(kPatience)) {
    const auto hello = receive();
    if (hello == nullptr || hello->body.AsHello() == nullptr) {
      ADD_FAILURE() << "no Hello";
      return;
    }
    hello_ = *hello->body.AsHello();
    page_ = wire::SharedMemory::map(std::move(bulk_));
  }

  const wire::HelloT& hello() const { return hello_; }
  const wire::StatusPage& page() const { return *reinterpret_cast<const wire::StatusPage*>(page_.data()); }
  Scene& scene() { return scene_; }
  void hangUp() { channel_.close(); }

  template <class Body>
  void send(Body body) {
    wire::MessageT message;
    message.body.Set(std::move(body));
    flatbuffers::FlatBufferBuilder builder;
    builder.Finish(wire::Message::Pack(builder, &message));
    EXPECT_TRUE(channel_.send({builder.GetBufferPointer(), builder.GetSize()}));
  }
  // Null when the other side is gone.
  std::unique_ptr<wire::MessageT> receive() {
    wire::Packet packet;
    if (channel_.receive(packet, kPatience) != wire::Received::message) return nullptr;
    bulk_ = std::move(packet.bulk);
    return wire::UnPackMessage(packet.bytes.data());
  }
  template <class Body>
  std::unique_ptr<wire::MessageT> ask(Body body) {
    send(std::move(body));
    auto reply = receive();
    return reply != nullptr ? std::move(reply) : std::make_unique<wire::MessageT>();
  }

  // Whatever these bytes are; null: the agent has hung up.
  std::unique_ptr<wire::MessageT> askBytes(const std::vector<std::uint8_t>& bytes) {
    channel_.send(bytes);
    return receive();
  }

  void resumeTo(std::uint64_t frame, std::uint64_t draw) {
    wire::ResumeT resume;
    resume.stop = true;
    resume.frame = frame;
    resume.draw = draw;
    send(resume);
  }
  void resumeToEnd() { send(wire::ResumeT{}); }

  // ---- requests that must succeed ----
  wire::DrawT describe() {
    const auto reply = ask(wire::DescribeT{});
    const wire::DrawT* draw = reply->body.AsDraw();
    EXPECT_NE(draw, nullptr);
    return draw != nullptr ? *draw : wire::DrawT{};
  }
  std::uint32_t prepare(const wire::PrepareT& request) {
    const auto reply = ask(request);
    if (const wire::FailedT* failed = reply->body.AsFailed()) ADD_FAILURE() << failed->text;
    const wire::PreparedT* prepared = reply->body.AsPrepared();
    EXPECT_NE(prepared, nullptr);
    return prepared != nullptr ? prepared->handle : 0;
  }
  wire::ExecutedT execute(const wire::ExecuteT& request) {
    const auto reply = ask(request);
    if (const wire::FailedT* failed = reply->body.AsFailed()) ADD_FAILURE() << failed->text;
    const wire::ExecutedT* executed = reply->body.AsExecuted();
    const bool again = executed != nullptr && executed->memory != 0 && executed->memory == request.given_back;
    if (bulk_ || !again) values_ = {};
    if (bulk_) values_ = wire::SharedMemory::map(std::move(bulk_));
    EXPECT_NE(executed, nullptr);
    return executed != nullptr ? *executed : wire::ExecutedT{};
  }
  // The values beside the last Executed; copied, so that they outlive the next one.
  template <class Word>
  std::vector<Word> values(const std::unique_ptr<wire::BulkRangeT>& range) const {
    if (range == nullptr || range->offset + range->bytes > values_.size()) {
      ADD_FAILURE() << "the values are not there";
      return {};
    }
    std::vector<Word> words(range->bytes / sizeof(Word));
    std::memcpy(words.data(), values_.data() + range->offset, words.size() * sizeof(Word));
    return words;
  }

 private:
  static std::vector<std::string> command(const std::string& scene, const std::string& name,
                                          const std::string& out) {
    return out.empty() ? std::vector<std::string>{scene, name} : std::vector<std::string>{scene, name, out};
  }

  wire::Listener listener_;
  Scene scene_;
  wire::Channel channel_;
  wire::HelloT hello_;
  wire::Descriptor bulk_;
  wire::SharedMemory page_, values_;
};

inline std::unique_ptr<wire::CaptureOutputT> captureOutput(const std::string& name,
                                                           wire::CaptureFormat format) {
  auto output = std::make_unique<wire::CaptureOutputT>();
  output->name = name;
  output->format = format;
  return output;
}

inline std::uint32_t word(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace agent_test
