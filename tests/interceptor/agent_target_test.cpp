// Captures and outputs on targets of every kind (agent_target.cpp): layer by layer, sample by sample, against
// what the program itself finds in its target after its own draw.
#include <cstdio>

#include "agent_session.h"

namespace agent_test {
namespace {

constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

std::string fragmentText(const wire::DrawT& draw) {
  std::string text;
  for (const auto& stage : draw.stages) {
    if (stage->stage != wire::Stage::Fragment) continue;
    for (const auto& string : stage->sources) text += string->text;
  }
  return text;
}

// The scene's text, with what it gives `color` captured too.
std::string capturing(const std::string& text, const std::string& seen) {
  std::string result = text;
  result.insert(result.find("void main"), "out uvec4 seen;\n");
  const std::size_t assigned = result.find(';', result.find("color = "));
  return result.insert(assigned + 1, " seen = " + seen + ";");
}
constexpr const char* kAsFloats = "uvec4(floatBitsToUint(color.xyz), 1u)";
constexpr const char* kAsIntegers = "uvec4(color.xyz, 1)";

// A session that stands in the scene's second draw (or its only one) with one output captured.
class TargetSession {
 public:
  TargetSession(const std::string& scene, std::uint64_t draw = 1, const std::string& seen = kAsFloats)
      : out_((folder_ / "target").string()), session_(TARGET, scene, out_) {
    session_.resumeTo(0, draw);
    EXPECT_NE(session_.receive(), nullptr) << scene;
    draw_ = session_.describe();
    EXPECT_EQ(draw_.target_reason + draw_.program_reason, "");
    wire::PrepareT prepare;
    prepare.text = capturing(fragmentText(draw_), seen);
    prepare.user_outputs = {"color", "weight"};
    prepare.captures.push_back(captureOutput("seen", wire::CaptureFormat::Uint4));
    handle_ = session_.prepare(prepare);
  }

  const wire::DrawT& draw() const { return draw_; }

  struct Plane {
    std::vector<std::uint32_t> seen, output;
  };
  Plane plane(int layer, int sample, std::uint64_t components) {
    wire::ExecuteT execute;
    execute.handle = handle_;
    execute.compare = true;
    execute.read_outputs = true;
    execute.layer = layer;
    execute.sample = sample;
    const wire::ExecutedT executed = session_.execute(execute);
    EXPECT_EQ(executed.compare_reason, "");
    EXPECT_EQ(executed.compared, components);
    EXPECT_EQ(executed.differing, 0U);
    Plane plane;
    if (executed.attachments.size() == 1)
      plane.seen = session_.values<std::uint32_t>(executed.attachments[0]);
    if (executed.outputs.size() == 1) plane.output = session_.values<std::uint32_t>(executed.outputs[0]);
    if (plane.seen.empty()) plane.seen.resize(kPixels * 4);  // has failed above
    EXPECT_EQ(executed.attachments.size(), 1U);
    return plane;
  }
  const wire::FailedT* refusal(int layer, int sample) {
    wire::ExecuteT execute;
    execute.handle = handle_;
    execute.layer = layer;
    execute.sample = sample;
    reply_ = session_.ask(execute);
    return reply_->body.AsFailed();
  }

  // Ends the program; what it found in its target.
  std::vector<std::uint32_t> truth() {
    session_.resumeToEnd();
    EXPECT_EQ(session_.scene().status(), 0);
    const std::string bytes = readFile(out_);
    std::vector<std::uint32_t> words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), words.size() * 4);
    return words;
  }

 private:
  Folder folder_;
  std::string out_;
  Session session_;
  wire::DrawT draw_;
  std::unique_ptr<wire::MessageT> reply_;
  std::uint32_t handle_ = 0;
};

using Words = std::vector<std::uint32_t>;

// Where the target holds a fragment of the second draw (alpha 1), that fragment was captured; elsewhere
// nothing was.
void expectSeenWhereDrawn(const Words& seen, const Words& target) {
  ASSERT_EQ(seen.size(), kPixels * 4);
  ASSERT_EQ(target.size(), kPixels * 4);
  for (std::size_t i = 0; i < target.size(); i += 4) {
    const bool drawn = target[i + 3] == word(1.0F);
    ASSERT_EQ(Words(&seen[i], &seen[i] + 4),
              drawn ? (Words{target[i], target[i + 1], target[i + 2], 1}) : (Words{0, 0, 0, 0}))
        << "pixel " << i / 4;
  }
}

struct Layout {
  const char* scene;
  int layers, samples;
  int components;  // compared on each pixel of each plane: colours, depth, stencil
};
void PrintTo(const Layout& layout, std::ostream* out) {
  *out << layout.scene;
}
class Targets : public testing::TestWithParam<Layout> {};

TEST_P(Targets, everyPlaneIsTheProgramsOwn) {
  const Layout layout = GetParam();
  TargetSession session(layout.scene);
  EXPECT_EQ(session.draw().layers, layout.layers);
  EXPECT_EQ(session.draw().samples, layout.samples);
  std::vector<TargetSession::Plane> planes;
  const int layers = std::max(layout.layers, 1);
  const int samples = std::max(layout.samples, 1);
  const std::uint64_t pixels = session.draw().width * static_cast<std::uint64_t>(session.draw().height);
  const std::uint64_t components = pixels * static_cast<std::uint64_t>(layers * samples * layout.components);
  for (int layer = 0; layer < layers; ++layer) {
    for (int sample = 0; sample < samples; ++sample)
      planes.push_back(session.plane(layer, sample, components));
  }
  EXPECT_NE(session.refusal(layers, 0), nullptr);
  EXPECT_NE(session.refusal(0, samples), nullptr);
  const Words truth = session.truth();
  ASSERT_EQ(truth.size(), planes.size() * kPixels * 4);
  bool differ = false;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    SCOPED_TRACE("plane " + std::to_string(i));
    const Words mine(truth.begin() + static_cast<std::ptrdiff_t>(i * kPixels * 4),
                     truth.begin() + static_cast<std::ptrdiff_t>((i + 1) * kPixels * 4));
    planes[i].seen.resize(kPixels *
                          4);  // of a cube map's face, which is a square, the scene looks at the lower part
    planes[i].output.resize(kPixels * 4);
    EXPECT_EQ(planes[i].output, mine);
    expectSeenWhereDrawn(planes[i].seen, mine);
    differ = differ || planes[i].seen != planes[0].seen;
  }
  EXPECT_TRUE(differ || planes.size() == 1) << "all planes alike: the scene shows nothing";
}

INSTANTIATE_TEST_SUITE_P(Layouts, Targets,
                         testing::Values(Layout{"samples", 0, 4, 6}, Layout{"sample-shading", 0, 4, 6},
                                         Layout{"layered-array", 3, 0, 5}, Layout{"layered-cube", 6, 0, 4},
                                         Layout{"layered-volume", 3, 0, 4},
                                         Layout{"layered-samples", 3, 4, 6}, Layout{"slice", 0, 0, 4},
                                         Layout{"cube-face", 0, 0, 4}),
                         [](const auto& one) {
                           std::string name = one.param.scene;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Outputs that do not keep the shader's colour bit for bit: captured is what a fragment of such a place
// writes.
void expectSeenAtItsPlace(const Words& seen, const Words& output) {
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < seen.size(); i += 4) {
    if (seen[i + 3] == 0) continue;
    ++drawn;
    const auto x = static_cast<float>(i / 4 % kWidth) + 0.5F;
    const auto y = static_cast<float>(i / 4 / kWidth) + 0.5F;
    ASSERT_EQ(Words(&seen[i], &seen[i] + 3), (Words{word(x / 64), word(y / 64), word(0.7F)}))
        << "pixel " << i / 4;
  }
  EXPECT_GT(drawn, kPixels / 8);
  EXPECT_LT(drawn, kPixels / 2);
  EXPECT_EQ(output.size(), kPixels * 4);
}

struct Kind {
  const char* scene;
  int components;
};
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.scene;
}
class Formats : public testing::TestWithParam<Kind> {};

TEST_P(Formats, areCopiedExactly) {
  TargetSession session(GetParam().scene);
  const auto plane = session.plane(0, 0, kPixels * static_cast<std::uint64_t>(GetParam().components));
  expectSeenAtItsPlace(plane.seen, plane.output);
  EXPECT_EQ(plane.output, session.truth());
}

INSTANTIATE_TEST_SUITE_P(Formats, Formats,
                         testing::Values(Kind{"alpha", 1}, Kind{"luminance", 1}, Kind{"luminance-alpha", 2},
                                         Kind{"intensity", 1}, Kind{"unsized", 4}, Kind{"small", 3},
                                         Kind{"packed-float", 3}, Kind{"half", 2}, Kind{"signed", 4},
                                         Kind{"srgb", 4}, Kind{"logic-op", 4}),
                         [](const auto& one) {
                           std::string name = one.param.scene;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// What stands between a fragment's outputs and its target changes the target, not what is captured.
TEST(Operations, dualSourceBlendingLeavesCapturesAlone) {
  TargetSession session("dual-source");
  const auto plane = session.plane(0, 0, kPixels * 4);
  const Words truth = session.truth();
  EXPECT_EQ(plane.output, truth);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < truth.size(); i += 4) {
    if (truth[i + 3] != word(1.0F)) continue;  // the second source takes all of the old alpha away
    ++drawn;
    const auto x = static_cast<float>(i / 4 % kWidth) + 0.5F;
    const auto y = static_cast<float>(i / 4 / kWidth) + 0.5F;
    ASSERT_EQ(Words(&plane.seen[i], &plane.seen[i] + 4), (Words{word(x), word(y), word(3.0F), 1}));
  }
  EXPECT_GT(drawn, kPixels / 8);
}

TEST(Operations, clampedColoursAreCapturedUnclamped) {
  TargetSession session("clamped");
  const auto plane = session.plane(0, 0, kPixels * 4);
  const Words truth = session.truth();
  EXPECT_EQ(plane.output, truth);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < truth.size(); i += 4) {
    if (plane.seen[i + 3] == 0) continue;
    ++drawn;
    ASSERT_EQ(truth[i + 2], word(1.0F));
    ASSERT_EQ(plane.seen[i + 2], word(3.0F));
  }
  EXPECT_GT(drawn, kPixels / 8);
}

TEST(Operations, alphaToOneLeavesCapturesAlone) {
  TargetSession session("alpha-to-one");
  const auto plane = session.plane(0, 2, kPixels * 4 * 4);
  const Words truth = session.truth();
  const Words mine(truth.begin() + 2 * kPixels * 4, truth.begin() + 3 * kPixels * 4);
  EXPECT_EQ(plane.output, mine);
}

TEST(Formats, integersAreCopiedExactly) {
  TargetSession session("integers", 1, kAsIntegers);
  const auto plane = session.plane(0, 0, kPixels * 2);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < plane.seen.size(); i += 4) {
    if (plane.seen[i + 3] == 0) continue;
    ++drawn;
    const auto x = static_cast<std::uint32_t>(-100 * static_cast<int>(i / 4 % kWidth));
    ASSERT_EQ(plane.seen[i], x);
    ASSERT_EQ(plane.output[i], x);
  }
  EXPECT_GT(drawn, kPixels / 8);
  session.truth();
}

TEST(Formats, ofSamplesMayBeSrgb) {
  TargetSession session("srgb-samples");
  const auto plane = session.plane(0, 3, kPixels * 4 * 4);
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < plane.seen.size(); i += 4) {
    if (plane.seen[i + 3] == 0) continue;
    ++drawn;
    ASSERT_EQ(plane.seen[i + 2], word(0.7F));
    // 0.7 encoded (IEC 61966-2-1) is 0.8542, of 255 steps the 218th.
    float output = 0;
    std::memcpy(&output, &plane.output[i + 2], 4);
    ASSERT_FLOAT_EQ(output, 218.0F / 255.0F);
  }
  EXPECT_GT(drawn, kPixels / 8);
  session.truth();
}

TEST(Samples, ofRenderbuffersAreSeenToo) {
  TargetSession session("multisampled-renderbuffers");
  EXPECT_EQ(session.draw().samples, 4);
  const auto first = session.plane(0, 0, kPixels * 5 * 4);
  const auto last = session.plane(0, 3, kPixels * 5 * 4);
  EXPECT_NE(first.seen, last.seen);  // on the triangle's edges
  session.truth();
}

// What the program finds without a debugger.
Words bare(const std::string& scene) {
  Folder folder;
  const std::string out = (folder / "target").string();
  run({TARGET, scene, out});
  const std::string bytes = readFile(out);
  Words words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  return words;
}

// ---- no colour
// --------------------------------------------------------------------------------------------------

TEST(NoColour, depthAloneIsCompared) {
  TargetSession session("depth-only");
  const auto plane = session.plane(0, 0, kPixels);
  EXPECT_TRUE(plane.output.empty());
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < plane.seen.size(); i += 4) {
    if (plane.seen[i + 3] == 0) continue;
    ++drawn;
    const auto x = static_cast<float>(i / 4 % kWidth) + 0.5F;
    ASSERT_EQ(plane.seen[i], word(x));
  }
  EXPECT_GT(drawn, kPixels / 8);
  EXPECT_LT(drawn, kPixels / 2);
  session.truth();
}

TEST(NoColour, aFramebufferNeedsNoAttachments) {
  for (const char* scene : {"empty", "empty-samples"}) {
    TargetSession session(scene, 0);
    const auto plane = session.plane(0, 0, kPixels);  // a word of the storage buffer each
    ASSERT_EQ(plane.seen.size(), kPixels * 4) << scene;
    for (std::size_t i = 0; i < plane.seen.size(); i += 4) {
      const auto x = static_cast<float>(i / 4 % kWidth) + 0.5F;
      const auto y = static_cast<float>(i / 4 / kWidth) + 0.5F;
      ASSERT_EQ(Words(&plane.seen[i], &plane.seen[i] + 4), (Words{word(x), word(y), word(3.0F), 1})) << scene;
    }
    // How often its shader ran (with samples, llvmpipe runs it twice on some pixels).
    EXPECT_EQ(session.truth(), bare(scene)) << scene;
  }
}

}  // namespace
}  // namespace agent_test
