// The agent, asked by a session that knows what the scenes' shaders compute (agent_scene.h).
#include <cmath>

#include "agent_session.h"

namespace agent_test {
namespace {

std::string joined(const wire::ShaderStageT& stage) {
  std::string text;
  for (const auto& string : stage.sources) text += string->text;
  return text;
}

const wire::ShaderStageT* stageOf(const wire::DrawT& draw, wire::Stage stage) {
  for (const auto& entry : draw.stages) {
    if (entry->stage == stage) return entry.get();
  }
  return nullptr;
}

void replaceOnce(std::string& text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), with);
}

// "bare line | debugged line" for each pair that differs.
std::string differingLines(const std::string& bare, const std::string& debugged) {
  std::istringstream left(bare);
  std::istringstream right(debugged);
  std::string result;
  std::string a;
  std::string b;
  for (int number = 1; !left.eof() || !right.eof(); ++number, a.clear(), b.clear()) {
    std::getline(left, a);
    std::getline(right, b);
    if (a != b) result += std::to_string(number) + ": " + a + " | " + b + "\n";
  }
  return result + (bare.empty() ? "nothing was dumped" : "");
}

// A scene in two runs: bare, and with the debugger in between.
struct Case {
  const char* label;
  const char* program;
  const char* scene;
};
void PrintTo(const Case& scene, std::ostream* out) {
  *out << scene.label;
}

class AgentInScene : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override { run({GetParam().program, GetParam().scene, folder_ / "bare"}); }
  std::string out() const { return folder_ / "debugged"; }
  std::unique_ptr<Session> start() const {
    return std::make_unique<Session>(GetParam().program, GetParam().scene, out());
  }
  // Ends the program, and finds its image and state as without a debugger.
  void finishUntouched(Session& session) {
    session.resumeToEnd();
    const auto exiting = session.receive();
    ASSERT_NE(exiting, nullptr);
    ASSERT_NE(exiting->body.AsExiting(), nullptr);
    EXPECT_EQ(exiting->body.AsExiting()->draws, 2U);
    EXPECT_EQ(session.scene().status(), 0);
    expectUntouched();
  }
  void expectUntouched() {
    EXPECT_TRUE(readFile(folder_ / "bare.image") == readFile(out() + ".image")) << "the image differs";
    EXPECT_EQ(differingLines(readFile(folder_ / "bare.state"), readFile(out() + ".state")), "");
  }
  // The program's final colours, four floats a pixel.
  std::vector<float> finalColours() const {
    const std::string bytes = readFile(folder_ / "bare.image");
    std::vector<float> floats(kWidth * kHeight * 4);
    EXPECT_GE(bytes.size(), floats.size() * sizeof(float));
    std::memcpy(floats.data(), bytes.data(), floats.size() * sizeof(float));
    return floats;
  }
  bool old() const { return std::string(GetParam().scene) == "compatibility"; }

  Folder folder_;
};

TEST_P(AgentInScene, saysHelloAndCountsWithoutStopping) {
  const auto session = start();
  EXPECT_EQ(session->hello().protocol, wire::kProtocol);
  EXPECT_EQ(session->hello().pid, session->scene().pid());
  EXPECT_EQ(std::filesystem::path(session->hello().program), std::filesystem::canonical(GetParam().program));
  finishUntouched(*session);
  EXPECT_EQ(session->page().draws(), 2U);
  EXPECT_EQ(session->page().frame.load(), 0U);
  EXPECT_EQ(session->page().used_gl.load(), 1U);
}

TEST_P(AgentInScene, stopsAtTheDrawAndDescribesIt) {
  const auto session = start();
  session->resumeTo(0, 1);
  const auto message = session->receive();
  ASSERT_NE(message, nullptr);
  const wire::StoppedT* stopped = message->body.AsStopped();
  ASSERT_NE(stopped, nullptr);
  EXPECT_EQ(stopped->frame, 0U);
  EXPECT_EQ(stopped->draw, 1U);
  EXPECT_EQ(stopped->call, old() ? "glDrawArrays" : "glDrawArraysInstanced");
  EXPECT_EQ(stopped->mode, 4U);  // GL_TRIANGLES
  EXPECT_EQ(stopped->count, 3);
  EXPECT_EQ(stopped->instances, old() ? 1 : 2);
  EXPECT_EQ(session->page().draw(), 2U);

  const wire::DrawT draw = session->describe();
  EXPECT_EQ(draw.program_reason, "");
  EXPECT_EQ(draw.target_reason, "");
  EXPECT_NE(draw.program, 0U);
  EXPECT_EQ(draw.core, !old());
  EXPECT_FALSE(draw.es);
  EXPECT_GE(draw.extensions.size(), 50U);
  EXPECT_EQ(draw.width, kWidth);
  EXPECT_EQ(draw.height, kHeight);
  EXPECT_EQ(draw.viewport, (std::vector<int>{0, 0, kWidth, kHeight}));
  const bool own_target = std::string(GetParam().scene) == "core-texture";
  EXPECT_EQ(draw.framebuffer != 0, own_target);
  EXPECT_EQ(draw.draw_buffers, own_target ? 2 : 1);
  EXPECT_EQ(draw.max_draw_buffers, 8);
  ASSERT_EQ(draw.stages.size(), 2U);
  const wire::ShaderStageT* fragment = stageOf(draw, wire::Stage::Fragment);
  ASSERT_NE(fragment, nullptr);
  EXPECT_EQ(fragment->reason, "");
  EXPECT_EQ(fragment->sources.size(), old() ? 1U : 2U);
  EXPECT_NE(joined(*fragment).find(old() ? "gl_FragColor = vec4(place" : "color = vec4(place"),
            std::string::npos);
  finishUntouched(*session);
}

// The instrumented shader must draw what the program draws, and say what it computed.
wire::PrepareT instrumented(const wire::DrawT& draw, bool old) {
  wire::PrepareT request;
  request.text = joined(*stageOf(draw, wire::Stage::Fragment));
  if (old) {
    replaceOnce(request.text, "gl_FragColor", "gl_FragData[0]");
    replaceOnce(request.text, "* gl_Color;\n",
                "* gl_Color;\n"
                "  gl_FragData[1] = vec4(steps[2].y, scale, floor(gl_FragCoord.xy));\n");
    request.first_frag_data = 1;
    request.captures.push_back(captureOutput("", wire::CaptureFormat::Float4));
    return request;
  }
  replaceOnce(
      request.text, "void main() {",
      "out uvec4 seen_a;\nout uvec4 seen_b;\nout vec4 seen_c;\nvoid main() {\n"
      "  seen_a = uvec4(floatBitsToUint(scale), uint(bias.z), floatBitsToUint(twist[2][1]), bits.y);\n"
      "  seen_b = uvec4(uint(on), floatBitsToUint(lights[1].power[1]), floatBitsToUint(tint.z),\n"
      "                 floatBitsToUint(texelFetch(image, ivec2(1, 0), 0).x));\n"
      "  seen_c = vec4(floor(gl_FragCoord.xy), extra, 1.0);\n");
  request.user_outputs = {"color"};
  request.captures.push_back(captureOutput("seen_a", wire::CaptureFormat::Uint4));
  request.captures.push_back(captureOutput("seen_b", wire::CaptureFormat::Uint4));
  request.captures.push_back(captureOutput("seen_c", wire::CaptureFormat::Float4));
  return request;
}

TEST_P(AgentInScene, capturesWhatTheShaderComputes) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  const wire::DrawT draw = session->describe();
  ASSERT_EQ(draw.stages.size(), 2U);

  wire::ExecuteT request;
  request.handle = session->prepare(instrumented(draw, old()));
  request.compare = true;
  request.read_outputs = true;
  request.repeats = 3;
  const wire::ExecutedT executed = session->execute(request);
  EXPECT_EQ(executed.width, kWidth);
  EXPECT_EQ(executed.height, kHeight);
  EXPECT_EQ(executed.times_ns.size(), 3U);
  EXPECT_EQ(executed.compare_reason, "");
  EXPECT_EQ(executed.compared, std::uint64_t{kWidth} * kHeight * 6);  // RGBA, depth, stencil
  EXPECT_EQ(executed.differing, 0U);

  // The draw blends onto what was there: the outputs are the program's own final image, bit for bit.
  ASSERT_EQ(executed.outputs.size(), 1U);
  EXPECT_EQ(session->values<float>(executed.outputs[0]), finalColours());

  ASSERT_EQ(executed.attachments.size(), old() ? 1U : 3U);
  std::vector<std::vector<std::uint32_t>> words;
  for (const auto& range : executed.attachments) words.push_back(session->values<std::uint32_t>(range));
  const std::size_t mark = old() ? 0 : 2;  // the attachment that tells which threads ran
  int ran = 0;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const std::size_t at = (y * kWidth + x) * 4;
      const auto pixel = [&](std::size_t i) {
        return std::vector<std::uint32_t>(&words[i][at], &words[i][at] + 4);
      };
      if (words[mark][at + (old() ? 0 : 3)] == 0) {
        for (std::size_t i = 0; i < words.size(); ++i)
          EXPECT_EQ(pixel(i), (std::vector<std::uint32_t>(4, 0)));
        continue;
      }
      ++ran;
      const std::uint32_t column = word(static_cast<float>(x));
      const std::uint32_t row = word(static_cast<float>(y));
      if (old()) {
        ASSERT_EQ(pixel(0), (std::vector<std::uint32_t>{word(0.3F), word(0.7F), column, row}));
        continue;
      }
      ASSERT_EQ(pixel(0), (std::vector<std::uint32_t>{word(0.7F), 0xffffffffU, word(0.0625F), 0xfffffffaU}));
      ASSERT_EQ(pixel(1), (std::vector<std::uint32_t>{1, word(1.25F), word(0.875F), word(0.5F)}));
      ASSERT_EQ(pixel(2)[0], column);
      ASSERT_EQ(pixel(2)[1], row);
      float extra = 0;  // an attribute that is dead in the original: 7 at every vertex
      std::memcpy(&extra, &words[2][at + 2], sizeof extra);
      ASSERT_NEAR(extra, 7.0F, 1e-5F);
    }
  }
  EXPECT_GT(ran, 300);
  EXPECT_LT(ran, kWidth * kHeight);
  finishUntouched(*session);
}

TEST_P(AgentInScene, findsOutWhenAnOutputDiffers) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  const wire::DrawT draw = session->describe();
  wire::PrepareT prepare;
  prepare.text = joined(*stageOf(draw, wire::Stage::Fragment));
  if (!old()) prepare.user_outputs = {"color"};
  wire::ExecuteT request;
  request.compare = true;
  request.handle = session->prepare(prepare);
  EXPECT_EQ(session->execute(request).differing, 0U);

  // In the old scene the alpha test throws the fragment away: three colours and the depth. In the others red.
  if (old()) {
    replaceOnce(prepare.text, "0.75", "(gl_FragCoord.xy == vec2(24.5, 15.5) ? -8.0 : 0.75)");
  } else {
    replaceOnce(prepare.text, "float(bias.z)", "(gl_FragCoord.xy == vec2(24.5, 15.5) ? 8.0 : float(bias.z))");
  }
  request.handle = session->prepare(prepare);
  const wire::ExecutedT executed = session->execute(request);
  EXPECT_EQ(executed.compared, std::uint64_t{kWidth} * kHeight * 6);
  EXPECT_EQ(executed.differing, old() ? 4U : 1U);
  ASSERT_NE(executed.largest, nullptr);
  EXPECT_GT(executed.largest->by, 0.0);
  EXPECT_EQ(executed.largest->by, std::abs(executed.largest->got - executed.largest->expected));
  finishUntouched(*session);
}

TEST_P(AgentInScene, fillsAStorageBuffer) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  const wire::DrawT draw = session->describe();
  ASSERT_GT(draw.max_storage_blocks, 0);
  wire::PrepareT prepare;
  prepare.text = joined(*stageOf(draw, wire::Stage::Fragment));
  replaceOnce(prepare.text, old() ? "#version 120\n" : "#version 330 core\n",
              std::string(old() ? "#version 120\n" : "#version 330 core\n") +
                  "#extension GL_ARB_shader_storage_buffer_object : require\n"
                  "#extension GL_ARB_uniform_buffer_object : enable\n"  // for the word "layout" in 1.20
                  "#extension GL_ARB_shader_bit_encoding : enable\n");
  replaceOnce(prepare.text, "void main() {",
              "layout(std430) buffer Record { int words[]; };\n"
              "void main() {\n"
              "  int slot = atomicAdd(words[0], 1);\n"
              "  words[2 + slot] = floatBitsToInt(scale);\n");
  prepare.storage_block = "Record";
  if (!old()) prepare.user_outputs = {"color"};
  wire::ExecuteT request;
  request.handle = session->prepare(prepare);
  request.compare = true;
  request.storage = {0, 77};
  request.storage_words = 2 + 2 * kWidth * kHeight;
  request.repeats = 2;  // the second starts afresh
  const wire::ExecutedT executed = session->execute(request);
  EXPECT_EQ(executed.differing, 0U);
  const std::vector<std::uint32_t> words = session->values<std::uint32_t>(executed.storage);
  ASSERT_EQ(words.size(), request.storage_words);
  EXPECT_GT(words[0], 300U);
  EXPECT_EQ(words[1], 77U);
  for (std::size_t i = 2; i < words.size(); ++i) ASSERT_EQ(words[i], i < 2 + words[0] ? word(0.7F) : 0U) << i;
  finishUntouched(*session);
}

TEST_P(AgentInScene, writesToMemoryAgainThatWasGivenBack) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  wire::PrepareT prepare;
  prepare.text = joined(*stageOf(session->describe(), wire::Stage::Fragment));
  if (!old()) prepare.user_outputs = {"color"};
  wire::ExecuteT request;
  request.handle = session->prepare(prepare);
  const auto memoryFor = [&](std::uint32_t word, std::uint64_t words) {
    request.storage = {word};
    request.storage_words = words;
    const wire::ExecutedT executed = session->execute(request);
    std::vector<std::uint32_t> expected(words, 0);
    expected[0] = word;
    EXPECT_EQ(session->values<std::uint32_t>(executed.storage), expected);
    return executed.memory;
  };
  const std::uint64_t first = memoryFor(5, 64);
  EXPECT_NE(first, 0U);
  const std::uint64_t second = memoryFor(6, 64);
  EXPECT_NE(second, first) << "the session may still read the first";
  request.given_back = second;
  EXPECT_EQ(memoryFor(7, 32), second) << "there is room for it";
  const std::uint64_t third = memoryFor(8, 4096);
  EXPECT_NE(third, second) << "there is none";
  request.given_back = second;
  EXPECT_NE(memoryFor(9, 32), second) << "which is gone";
  finishUntouched(*session);
}

TEST_P(AgentInScene, coversASquareOfItsOwn) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  wire::PrepareT prepare;
  prepare.geometry = wire::Geometry::Covering;
  if (old()) {
    prepare.vertex_text = "#version 120\nvoid main() { gl_Position = vec4(gl_Vertex.xy, 0.0, 1.0); }\n";
    prepare.text =
        "#version 120\nuniform float scale;\nuniform vec2 place_of_one[2];\n"
        "void main() { gl_FragColor = vec4(place_of_one[1], scale, 9.0); }\n";
  } else {
    prepare.vertex_text =
        "#version 330 core\nvoid main() {\n"
        "  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
    prepare.text =
        "#version 330 core\nuniform float scale;\nuniform vec2 place_of_one[2];\nout vec4 color;\n"
        "void main() { color = vec4(place_of_one[1], scale, 9.0); }\n";
    prepare.user_outputs = {"color"};
  }
  wire::ExecuteT request;
  request.handle = session->prepare(prepare);
  request.covering_size = 37;
  request.repeats = 4;
  request.read_outputs = true;
  auto place = std::make_unique<wire::UniformValueT>();
  place->name = "place_of_one";
  place->gl_type = 0x8B50;  // GL_FLOAT_VEC2
  place->words = {word(1), word(2), word(-0.25F), word(4.5F)};
  request.uniforms.push_back(std::move(place));
  const wire::ExecutedT executed = session->execute(request);
  EXPECT_EQ(executed.width, 37);
  EXPECT_EQ(executed.height, 37);
  EXPECT_EQ(executed.times_ns.size(), 4U);
  EXPECT_EQ(executed.cpu_ns.size(), 4U);
  EXPECT_NE(executed.compare_reason, "");
  ASSERT_FALSE(executed.outputs.empty());
  const std::vector<float> colours = session->values<float>(executed.outputs.back());
  ASSERT_EQ(colours.size(), 37U * 37U * 4U);
  for (std::size_t i = 0; i < colours.size(); i += 4) {
    ASSERT_EQ(std::vector<float>(&colours[i], &colours[i] + 4),
              (std::vector<float>{-0.25F, 4.5F, 0.7F, 9.0F}))
        << i;
  }

  // Several draws in one request: every repeat draws once per set.
  for (const float x : {2.0F, 3.0F}) {
    request.sets.push_back(std::make_unique<wire::UniformSetT>());
    auto set = std::make_unique<wire::UniformValueT>();
    set->name = "place_of_one";
    set->gl_type = 0x8B50;
    set->words = {word(1), word(2), word(x), word(-x)};
    request.sets.back()->uniforms.push_back(std::move(set));
  }
  const wire::ExecutedT both = session->execute(request);
  EXPECT_EQ(both.times_ns.size(), 8U);
  EXPECT_EQ(both.cpu_ns.size(), 8U);
  EXPECT_EQ(session->values<float>(both.outputs.back())[0], 3.0F) << "the last set is drawn last";
  finishUntouched(*session);
}

TEST_P(AgentInScene, refusesWithAReasonAndGoesOn) {
  const auto session = start();
  session->resumeTo(0, 0);
  ASSERT_NE(session->receive(), nullptr);
  const auto failure = [&](auto request) {
    const auto reply = session->ask(std::move(request));
    const wire::FailedT* failed = reply->body.AsFailed();
    return failed != nullptr ? *failed : wire::FailedT{};
  };
  wire::PrepareT prepare;
  prepare.text = "#version 120\nvoid main() { gl_FragColor = nothing_of_the_kind; }\n";
  const wire::FailedT compile = failure(prepare);
  EXPECT_EQ(compile.kind, wire::ErrorKind::Compile);
  EXPECT_NE(compile.text.find("nothing_of_the_kind"), std::string::npos) << compile.text;

  prepare.text =
      old() ? "#version 120\nvarying vec3 place;\nvoid main() { gl_FragColor = place.xyzz; }\n"
            : "#version 330 core\nin vec3 place;\nout vec4 color;\nvoid main() { color = place.xyzz; }\n";
  EXPECT_EQ(failure(prepare).kind, wire::ErrorKind::Link);

  prepare.stage = wire::Stage::Geometry;
  EXPECT_EQ(failure(prepare).kind, wire::ErrorKind::Unsupported);

  const wire::DrawT draw = session->describe();
  wire::PrepareT many = instrumented(draw, old());
  for (int i = 0; i < 8; ++i)
    many.captures.push_back(captureOutput(old() ? "" : "seen_a", wire::CaptureFormat::Float4));
  EXPECT_EQ(failure(many).kind, wire::ErrorKind::Limit);

  wire::ExecuteT execute;
  execute.handle = 4711;
  EXPECT_EQ(failure(execute).kind, wire::ErrorKind::Internal);
  execute.handle = session->prepare(instrumented(draw, old()));
  execute.storage_words = std::uint64_t{1} << 40;
  EXPECT_EQ(failure(execute).kind, wire::ErrorKind::Limit);

  wire::ReleaseT release;
  release.handle = execute.handle;
  EXPECT_NE(session->ask(release)->body.AsDone(), nullptr);
  execute.storage_words = 0;
  EXPECT_EQ(failure(execute).kind, wire::ErrorKind::Internal);
  finishUntouched(*session);
}

TEST_P(AgentInScene, runsOnWhenTheSessionIsGone) {
  const auto session = start();
  session->resumeTo(0, 1);
  ASSERT_NE(session->receive(), nullptr);
  const wire::DrawT draw = session->describe();
  wire::ExecuteT request;
  request.handle = session->prepare(instrumented(draw, old()));
  session->execute(request);
  session->hangUp();
  EXPECT_EQ(session->scene().status(), 0);
  expectUntouched();
}

INSTANTIATE_TEST_SUITE_P(Scenes, AgentInScene,
                         testing::Values(Case{"osmesa_core", SCENE_OSMESA, "core"},
                                         Case{"osmesa_core_texture", SCENE_OSMESA, "core-texture"},
                                         Case{"osmesa_compatibility", SCENE_OSMESA, "compatibility"},
                                         Case{"egl_core", SCENE_EGL, "core"},
                                         Case{"egl_core_texture", SCENE_EGL, "core-texture"}),
                         [](const auto& one) { return std::string(one.param.label); });

// ---- without a parameter
// ---------------------------------------------------------------------------------------

TEST(Agent, tellsOfAMissedDrawAtTheEnd) {
  const Folder folder;
  Session session(SCENE_OSMESA, "core", folder / "out");
  session.resumeTo(0, 7);
  const auto exiting = session.receive();
  ASSERT_NE(exiting, nullptr);
  ASSERT_NE(exiting->body.AsExiting(), nullptr);
  EXPECT_EQ(exiting->body.AsExiting()->frames, 0U);
  EXPECT_EQ(exiting->body.AsExiting()->draws, 2U);
  EXPECT_EQ(session.scene().status(), 0);
}

TEST(Agent, endsTheProgramWhenToldTo) {
  const Folder folder;
  Session session(SCENE_OSMESA, "core", folder / "out");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  wire::QuitT quit;
  quit.status = 42;
  session.send(quit);
  EXPECT_EQ(session.scene().status(), 42);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.image"));
}

TEST(Agent, leavesAProgramAloneWhenNobodyListens) {
  const Folder folder;
  Scene scene({SCENE_OSMESA, "core", folder / "out"},
              {"LD_PRELOAD=" PRELOAD_LIBRARY, "SHADESTEP_SOCKET=nobody-is-here"});
  EXPECT_EQ(scene.status(), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out.image"));
}

}  // namespace
}  // namespace agent_test
