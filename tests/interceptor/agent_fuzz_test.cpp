// A session that asks for nonsense: whatever comes over the socket, the program draws what it draws alone and
// ends as ever, with the state that it had.
#include <sys/socket.h>

#include <random>

#include "agent_session.h"

namespace agent_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

class Nonsense {
 public:
  explicit Nonsense(unsigned seed) : random_(seed) {}

  // A plausible request, most often with bits turned.
  Bytes request() {
    wire::MessageT message = plausible();
    flatbuffers::FlatBufferBuilder builder;
    builder.Finish(wire::Message::Pack(builder, &message));
    Bytes bytes(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
    if (random_() % 4 == 0) return bytes;
    for (int flips = 1 + static_cast<int>(random_() % 3); flips > 0; --flips)
      bytes[random_() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random_() % 8);
    return bytes;
  }
  bool onceIn(unsigned n) { return random_() % n == 0; }

 private:
  template <class Number>
  Number odd(Number plain) {
    const Number numbers[] = {plain, plain, plain, Number(0), Number(-1), Number(1 << 30), Number(random_())};
    return numbers[random_() % 7];
  }
  std::string text() {
    const char* texts[] = {"",        "void main() {}", "#version 330\nvoid main(){}",
                           "}{ \xff", "colour",         "gl_FragColor"};
    return texts[random_() % 6];
  }

  wire::MessageT plausible() {
    wire::MessageT message;
    switch (random_() % 8) {
      case 0:
        message.body.Set(wire::DescribeT{});
        break;
      case 1:
        message.body.Set(wire::DescribeStateT{});
        break;
      case 2:
      case 3:
        message.body.Set(prepare());
        break;
      case 4:
      case 5:
        message.body.Set(execute());
        break;
      case 6: {
        wire::ReleaseT release;
        release.handle = random_() % 5;
        message.body.Set(release);
        break;
      }
      default: {
        wire::SetArgumentT change;
        change.name = text();
        message.body.Set(change);
      }
    }
    return message;
  }

  wire::PrepareT prepare() {
    wire::PrepareT prepare;
    prepare.stage = static_cast<wire::Stage>(odd(4));
    prepare.text = text();
    prepare.geometry = static_cast<wire::Geometry>(random_() % 3);
    prepare.vertex_text = text();
    if (onceIn(2)) prepare.user_outputs.push_back(text());
    for (int i = static_cast<int>(random_() % 12); i > 0; --i) {
      prepare.captures.push_back(captureOutput(text(), static_cast<wire::CaptureFormat>(random_() % 3)));
    }
    prepare.first_frag_data = odd(-1);
    prepare.storage_block = text();
    return prepare;
  }

  wire::ExecuteT execute() {
    wire::ExecuteT execute;
    execute.handle = random_() % 5;
    if (onceIn(2)) {
      execute.uniforms.push_back(std::make_unique<wire::UniformValueT>());
      execute.uniforms.back()->name = text();
      execute.uniforms.back()->gl_type = odd(0x8B52u);
      execute.uniforms.back()->words.resize(random_() % 5);
    }
    execute.storage.resize(random_() % 9);
    execute.storage_words = odd(std::uint64_t{16});
    execute.compare = onceIn(2);
    execute.read_outputs = onceIn(2);
    execute.repeats = random_() % 3;
    execute.covering_size = odd(8);
    execute.layer = odd(0);
    execute.sample = odd(0);
    if (onceIn(3)) {
      execute.raster = std::make_unique<wire::RasterT>();
      execute.raster->depth_test = static_cast<wire::Switch>(odd(1));
      execute.raster->clear_buffers = onceIn(2);
    }
    return execute;
  }

  std::mt19937 random_;
};

bool isMessage(const Bytes& bytes) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  return wire::VerifyMessageBuffer(verifier);
}

// A message that makes sense all the same: run on, end, or draw for a long time.
bool makesSense(const Bytes& bytes) {
  const wire::Message* message = wire::GetMessage(bytes.data());
  const wire::Execute* execute = message->body_as_Execute();
  return message->body_as_Resume() != nullptr || message->body_as_Quit() != nullptr ||
         (execute != nullptr && execute->repeats() > 8);
}

class AgentHearsNonsense : public testing::TestWithParam<const char*> {};

TEST_P(AgentHearsNonsense, andTheProgramIsAsEver) {
  const Folder folder;
  run({SCENE_OSMESA, GetParam(), folder / "bare"});
  int answers = 0, hung_up = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Nonsense nonsense(seed);
    {
      Session session(SCENE_OSMESA, GetParam(), folder / "asked");
      session.resumeTo(0, seed % 2);
      ASSERT_NE(session.receive(), nullptr);
      for (int i = 0; i < 60; ++i) {
        const Bytes bytes = nonsense.request();
        if (isMessage(bytes) ? makesSense(bytes) : !nonsense.onceIn(20)) continue;
        const auto reply = session.askBytes(bytes);
        if (reply == nullptr) {
          ++hung_up;  // that was no message
          break;
        }
        ++answers;
      }
      session.hangUp();
      EXPECT_EQ(session.scene().status(), 0);
    }
    EXPECT_TRUE(readFile(folder / "bare.image") == readFile(folder / "asked.image")) << "the image differs";
    EXPECT_TRUE(readFile(folder / "bare.state") == readFile(folder / "asked.state")) << "the state differs";
  }
  EXPECT_GT(answers, 20);
  EXPECT_GT(hung_up, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AgentHearsNonsense, testing::Values("compatibility", "core"));

}  // namespace
}  // namespace agent_test
