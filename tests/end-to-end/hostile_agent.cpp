// Says it is the interceptor, and then answers with whatever a seed makes of plausible answers: hostile-agent
// SEED.
#include <cstdlib>
#include <cstring>
#include <new>
#include <random>

#include "wire/channel.h"
#include "wire/messages_generated.h"
#include "wire/status_page.h"

namespace {

namespace wire = shadestep::wire;

class Agent {
 public:
  explicit Agent(unsigned seed)
      : random_(seed), channel_(wire::Channel::connect(std::getenv(wire::kSocketVariable))) {
    memory_ = wire::SharedMemory::create("hostile", sizeof(wire::AgentMemory));
    for (std::size_t i = sizeof(wire::StatusPage); i + 8 <= memory_.size(); i += 8)
      if (random_() % 4 == 0) std::memcpy(memory_.data() + i, &(number_ = random_()), sizeof number_);
    auto* page = new (memory_.data()) wire::StatusPage{};
    page->used_gl.store(random_() % 4 != 0);
    page->frame.store(random_() % 3);
    page->last_call.store(static_cast<std::int64_t>(random_()));
  }

  void run() {
    wire::HelloT hello;
    hello.protocol = wire::kProtocol;
    hello.pid = 1;
    say(hello, memory_.descriptor());
    for (int i = 0; i < 40; ++i) {
      wire::Packet packet;
      if (channel_.receive(packet) != wire::Received::message) return;
      wire::MessageT request;
      wire::GetMessage(packet.bytes.data())->UnPackTo(&request);
      answer(request);
    }
  }

 private:
  template <class Number>
  Number odd(Number plain) {
    const Number numbers[] = {plain,     plain,      plain,           plain,
                              Number(0), Number(-1), Number(1 << 20), Number(random_())};
    return numbers[random_() % 8];
  }
  bool rarely() { return random_() % 8 == 0; }

  template <class Body>
  void say(Body body, int bulk = -1) {
    wire::MessageT message;
    message.body.Set(std::move(body));
    flatbuffers::FlatBufferBuilder builder;
    builder.Finish(wire::Message::Pack(builder, &message));
    std::vector<std::uint8_t> bytes(builder.GetBufferPointer(),
                                    builder.GetBufferPointer() + builder.GetSize());
    if (rarely())
      for (int flips = 1 + static_cast<int>(random_() % 4); flips > 0; --flips)
        bytes[random_() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random_() % 8);
    channel_.send(bytes, rarely() ? memory_.descriptor() : bulk);
  }

  void stop() {
    if (rarely()) {
      wire::CallsT calls;
      calls.number = random_();
      for (int i = 0; i < 200; ++i) calls.batch.push_back(static_cast<std::uint8_t>(random_() % 5));
      say(std::move(calls));
    }
    if (random_() % 3 == 0) {
      wire::CallStoppedT call;
      if (!rarely()) call.call = std::make_unique<wire::CallT>();
      call.reason = static_cast<wire::CallReason>(random_() % 7);
      return say(std::move(call));
    }
    if (rarely()) return say(wire::FrameEndedT{});
    if (rarely()) {
      say(wire::ExitingT{});
      std::exit(0);
    }
    wire::StoppedT stopped;
    stopped.frame = odd(std::uint64_t{0});
    stopped.draw = odd(std::uint64_t{0});
    say(std::move(stopped));
  }

  wire::DrawT draw() {
    wire::DrawT draw;
    draw.version = "4.5";
    draw.major = odd(4);
    draw.minor = 5;
    draw.program = 1;
    auto stage = std::make_unique<wire::ShaderStageT>();
    stage->stage = rarely() ? static_cast<wire::Stage>(random_()) : wire::Stage::Fragment;
    stage->sources.push_back(std::make_unique<wire::TextT>());
    stage->sources.back()->text =
        rarely() ? "#\\\n\xff{" : "#version 330\nout vec4 c;\nvoid main() {\n  c = gl_FragCoord;\n}\n";
    draw.stages.push_back(std::move(stage));
    for (int i = static_cast<int>(random_() % 6); i > 0; --i) draw.viewport.push_back(odd(4));
    draw.width = odd(4);
    draw.height = odd(4);
    draw.draw_buffers = odd(1);
    draw.max_draw_buffers = odd(8);
    draw.max_storage_blocks = odd(8);
    draw.layers = rarely() ? odd(1) : 0;
    draw.samples = rarely() ? odd(4) : 0;
    return draw;
  }

  std::unique_ptr<wire::BulkRangeT> range(std::uint64_t bytes) {
    auto range = std::make_unique<wire::BulkRangeT>();
    range->offset = rarely() ? odd(std::uint64_t{64}) : 0;
    range->bytes = odd(bytes);
    return range;
  }

  wire::ExecutedT executed() {
    wire::ExecutedT executed;
    executed.width = odd(4);
    executed.height = odd(4);
    for (int i = static_cast<int>(random_() % 4); i > 0; --i)
      executed.attachments.push_back(range(4 * 4 * 16));
    for (int i = static_cast<int>(random_() % 3); i > 0; --i) {
      executed.outputs.push_back(range(4 * 4 * 16));
      executed.output_draw_buffers.push_back(odd(0));
      if (!rarely()) executed.output_types.push_back(odd(0x1406u));
    }
    if (random_() % 2 == 0) executed.storage = range(odd(std::uint64_t{4096}));
    executed.compared = odd(std::uint64_t{64});
    executed.unstable = odd(std::uint64_t{0});
    executed.outside_outputs = odd(std::uint64_t{0});
    if (random_() % 2 == 0) executed.times_ns.push_back(random_());
    if (random_() % 2 == 0) executed.cpu_ns.push_back(random_());
    return executed;
  }

  void answer(const wire::MessageT& request) {
    if (request.body.AsResume() != nullptr) return stop();
    if (request.body.AsQuit() != nullptr) std::exit(0);
    if (request.body.AsRelease() != nullptr || rarely()) return say(wire::DoneT{});
    if (rarely()) return say(wire::FailedT{});
    if (request.body.AsDescribe() != nullptr) return say(draw());
    if (request.body.AsPrepare() != nullptr) {
      wire::PreparedT prepared;
      prepared.handle = random_() % 9;
      if (random_() % 2 == 0) prepared.output_locations.push_back(odd(0));
      return say(std::move(prepared));
    }
    if (request.body.AsSetArgument() != nullptr) return say(wire::CallValueT{});
    if (request.body.AsDescribeState() != nullptr) return say(wire::StateT{});
    const auto bulk = wire::SharedMemory::create("hostile", 1 + random_() % 8192);
    for (std::size_t i = 0; i < bulk.size(); ++i) bulk.data()[i] = static_cast<std::byte>(random_() % 3);
    say(executed(), bulk.descriptor());
  }

  std::mt19937 random_;
  std::uint64_t number_ = 0;
  wire::Channel channel_;
  wire::SharedMemory memory_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || std::getenv(wire::kSocketVariable) == nullptr) return 2;
  Agent(static_cast<unsigned>(std::atoi(argv[1]))).run();
}
