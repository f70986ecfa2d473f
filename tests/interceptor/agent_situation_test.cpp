// The agent in situations where it must refuse with a reason, or take special care (agent_situation.cpp).
#include <algorithm>
#include <cmath>

#include "agent_session.h"

namespace agent_test {
namespace {

TEST(Situations, goWellWithoutADebugger) {
  for (const char* name : {"ordinary",
                           "deleted-program",
                           "fixed-function",
                           "immediate-mode",
                           "display-list",
                           "queries",
                           "queried-condition",
                           "condition-holds",
                           "condition",
                           "no-rasterizer",
                           "pipeline",
                           "separate-stages",
                           "several-shaders",
                           "feedback",
                           "emits",
                           "subroutines",
                           "storage-block",
                           "memory",
                           "clock-in-memory",
                           "multisampled-image",
                           "debug-messages",
                           "forked"}) {
    Scene scene({SITUATION, name}, {});
    EXPECT_EQ(scene.status(), 0) << name;
  }
}

std::string textOf(const wire::DrawT& draw, wire::Stage wanted) {
  std::string text;
  for (const auto& stage : draw.stages) {
    if (stage->stage != wanted) continue;
    for (const auto& string : stage->sources) text += string->text;
  }
  return text;
}

std::string fragmentText(const wire::DrawT& draw) {
  return textOf(draw, wire::Stage::Fragment);
}

std::string inserted(std::string text, const std::string& before, const std::string& what) {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? text : text.insert(at, what);
}

void end(Session& session) {
  session.resumeToEnd();
  EXPECT_EQ(session.scene().status(), 0);
}

// ---- refusals
// --------------------------------------------------------------------------------------------------

struct Refused {
  const char* situation;
  const char* reason;  // a part of it
};
void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.situation;
}

class Refusals : public testing::TestWithParam<Refused> {};

TEST_P(Refusals, sayWhyAndLeaveTheProgramAlone) {
  Session session(SITUATION, GetParam().situation, "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  const wire::DrawT draw = session.describe();
  std::string reasons = draw.program_reason + draw.target_reason;
  for (const auto& stage : draw.stages) reasons += stage->reason;
  EXPECT_NE(reasons.find(GetParam().reason), std::string::npos) << reasons;

  wire::PrepareT prepare;
  prepare.text = "#version 330 compatibility\nout vec4 color;\nvoid main() { color = vec4(0.5); }\n";
  const auto reply = session.ask(prepare);
  const wire::FailedT* failed = reply->body.AsFailed();
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->kind, wire::ErrorKind::Unsupported);
  EXPECT_NE(failed->text.find(GetParam().reason), std::string::npos) << failed->text;
  end(session);
}

INSTANTIATE_TEST_SUITE_P(Situations, Refusals,
                         testing::Values(Refused{"deleted-program", "deleted while in use"},
                                         Refused{"fixed-function", "no GLSL program"},
                                         Refused{"condition", "does not hold"},
                                         Refused{"no-rasterizer", "GL_RASTERIZER_DISCARD"}),
                         [](const auto& one) {
                           std::string name = one.param.situation;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// ---- special care
// ----------------------------------------------------------------------------------------------

// Captures what the shader is about to write, in every pixel.
void expectHalfEverywhere(Session& session, const std::string& expression, std::uint64_t at_draw = 0) {
  session.resumeTo(0, at_draw);
  ASSERT_NE(session.receive(), nullptr);
  const wire::DrawT draw = session.describe();
  wire::PrepareT prepare;
  prepare.text = inserted(inserted(fragmentText(draw), "void main", "out uvec4 seen;\n"),
                          "color = ", "seen = uvec4(floatBitsToUint(" + expression + "), 1u, 2u, 3u); ");
  prepare.user_outputs = {"color"};
  prepare.captures.push_back(captureOutput("seen", wire::CaptureFormat::Uint4));
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  execute.repeats = 2;
  const wire::ExecutedT executed = session.execute(execute);
  EXPECT_GT(executed.compared, 0U);
  EXPECT_EQ(executed.differing, 0U);
  ASSERT_EQ(executed.attachments.size(), 1U);
  const auto words = session.values<std::uint32_t>(executed.attachments[0]);
  ASSERT_EQ(words.size(), static_cast<std::size_t>(kWidth) * kHeight * 4);
  for (std::size_t i = 0; i < words.size(); i += 4) {
    ASSERT_EQ(std::vector<std::uint32_t>(&words[i], &words[i] + 4),
              (std::vector<std::uint32_t>{word(0.5F), 1, 2, 3}));
  }
}

TEST(Situations, immediateModeIsReplayed) {
  Session session(SITUATION, "immediate-mode", "");
  expectHalfEverywhere(session, "0.5");
  end(session);
}

TEST(Situations, activeQueriesCountWhatTheProgramDraws) {
  Session session(SITUATION, "queries", "");
  expectHalfEverywhere(session, "0.5", 1);
  end(session);
}

TEST(Situations, conditionsStandOnAllThatAQueryCounted) {
  Session session(SITUATION, "queried-condition", "");
  session.resumeTo(0, 1);
  ASSERT_NE(session.receive(), nullptr);
  wire::PrepareT prepare;
  prepare.text = fragmentText(session.describe());
  prepare.user_outputs = {"color"};
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  EXPECT_EQ(session.execute(execute).differing, 0U);
  end(session);
}

TEST(Situations, drawsWhoseConditionHoldsAreReplayed) {
  Session session(SITUATION, "condition-holds", "");
  expectHalfEverywhere(session, "0.5");
  end(session);
}

// The geometry stage of the situation "emits", with `emit` in place of its EmitVertex().
wire::ExecutedT emitting(const std::string& emit) {
  Session session(SITUATION, "emits", "");
  session.resumeTo(0, 0);
  EXPECT_NE(session.receive(), nullptr);
  wire::PrepareT prepare;
  prepare.stage = wire::Stage::Geometry;
  prepare.geometry = wire::Geometry::Unrasterized;
  prepare.feedback_outputs = {"gl_Position"};
  prepare.text = textOf(session.describe(), wire::Stage::Geometry);
  prepare.text.replace(prepare.text.find("EmitVertex()"), 12, emit);
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  wire::ExecutedT executed = session.execute(execute);
  end(session);
  return executed;
}

// What a shorter draw leaves behind its last vertex are the vertices of the draw before.
TEST(Situations, aShaderThatEmitsLessDiffers) {
  EXPECT_EQ(emitting("EmitVertex()").differing, 0U);
  EXPECT_GT(emitting("if (i < 0) EmitVertex()").differing, 0U);
}

TEST(Situations, theCheckSaysByHowMuchAStagesOutputsDiffer) {
  const wire::ExecutedT executed = emitting("gl_Position.y = 64.0, EmitVertex()");
  EXPECT_GT(executed.differing, 0U);
  ASSERT_NE(executed.largest, nullptr);
  EXPECT_EQ(executed.largest->where, "the outputs of the geometry stage");
  EXPECT_EQ(executed.largest->got, 64.0);
  EXPECT_EQ(executed.largest->by, std::abs(64.0 - executed.largest->expected));
}

TEST(Situations, displayListsAreReplayed) {
  Session session(SITUATION, "display-list", "");
  expectHalfEverywhere(session, "0.5");
  end(session);
}

TEST(Situations, transformFeedbackPausesForReplays) {
  Session session(SITUATION, "feedback", "");
  expectHalfEverywhere(session, "0.5");
  end(session);
}

TEST(Situations, oneTextStandsForAllShadersOfTheStage) {
  Session session(SITUATION, "several-shaders", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  const wire::DrawT draw = session.describe();
  ASSERT_EQ(draw.stages.size(), 3U);  // a vertex and two fragment shader objects
  for (const auto& stage : draw.stages) EXPECT_EQ(stage->reason, "");
  wire::PrepareT prepare;
  prepare.text =
      "#version 330 compatibility\nvec4 halves() { return vec4(0.5); }\nout vec4 color;\nout uvec4 seen;\n"
      "void main() { color = halves(); seen = uvec4(floatBitsToUint(color.x), 1u, 2u, 3u); }\n";
  prepare.user_outputs = {"color"};
  prepare.captures.push_back(captureOutput("seen", wire::CaptureFormat::Uint4));
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  const wire::ExecutedT executed = session.execute(execute);
  EXPECT_GT(executed.compared, 0U);
  EXPECT_EQ(executed.differing, 0U);
  const auto words = session.values<std::uint32_t>(executed.attachments.at(0));
  EXPECT_EQ(words.at(0), word(0.5F));
  end(session);
}

TEST(Situations, aPipelinesFragmentStageIsReplacedAlone) {
  for (const auto& [situation, expression] :
       {std::pair("pipeline", "0.5"), std::pair("separate-stages", "half_of_it + value - 7.0")}) {
    Session session(SITUATION, situation, "");
    expectHalfEverywhere(session, expression);
    end(session);
  }
}

TEST(Situations, subroutinesStayChosen) {
  Session session(SITUATION, "subroutines", "");
  expectHalfEverywhere(session, "shade()");
  end(session);
}

TEST(Situations, theProgramsStorageBlockStaysBound) {
  Session session(SITUATION, "storage-block", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  wire::PrepareT prepare;
  prepare.text = inserted(inserted(fragmentText(session.describe()), "void main",
                                   "layout(std430) buffer Debugger { int seen[]; };\n"),
                          "color = ", "seen[1] = floatBitsToInt(half_of_it); ");
  prepare.user_outputs = {"color"};
  prepare.storage_block = "Debugger";
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  execute.storage_words = 3;
  const wire::ExecutedT executed = session.execute(execute);
  EXPECT_EQ(executed.differing, 0U);
  EXPECT_EQ(session.values<std::uint32_t>(executed.storage), (std::vector<std::uint32_t>{0, word(0.5F), 0}));
  end(session);
}

// ---- memory that shaders write (kCountingFragment)
// ------------------------------------------------------------------

constexpr std::uint64_t kPixels = std::uint64_t{kWidth} * kHeight;
// Colours, and a word each in the cells and for a vertex, the counter and what lies before it, both layers of
// the picture, the row.
constexpr std::uint64_t kCompared = 4 * kPixels + kPixels + 3 + 2 + 2 * kPixels + kWidth;

wire::ExecutedT executeText(Session& session, const std::string& text, int repeats = 1) {
  wire::PrepareT prepare;
  prepare.text = text;
  prepare.user_outputs = {"color"};
  if (text.find("out uvec4 seen;") != std::string::npos) {
    prepare.captures.push_back(captureOutput("seen", wire::CaptureFormat::Uint4));
  }
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  execute.repeats = static_cast<std::uint32_t>(repeats);
  return session.execute(execute);
}

TEST(Memory, isWrittenOnceHoweverOftenTheDrawIsReplayed) {
  Session session(SITUATION, "memory", "");
  session.resumeTo(0, 1);
  ASSERT_NE(session.receive(), nullptr);
  const std::string text = fragmentText(session.describe());
  const std::string capturing = inserted(
      inserted(text, "void main", "out uvec4 seen;\n"),
      "color = ", "seen = uvec4(cell, cells[place.y * 48 + place.x], floatBitsToUint(before), 1u); ");
  for (int round = 0; round < 2; ++round) {
    const wire::ExecutedT executed = executeText(session, capturing, 3);
    EXPECT_EQ(executed.compare_reason, "");
    EXPECT_EQ(executed.compared, kCompared);
    EXPECT_EQ(executed.differing, 0U);
    ASSERT_EQ(executed.attachments.size(), 1U);
    const auto words = session.values<std::uint32_t>(executed.attachments[0]);
    for (std::size_t i = 0; i < words.size(); i += 4) {
      ASSERT_EQ(
          std::vector<std::uint32_t>(&words[i], &words[i] + 4),
          (std::vector<std::uint32_t>{8, 9, word(4.0F), 1}));  // after the first draw, before the second
    }
  }
  end(session);
}

TEST(Memory, isWrittenOnceBesideTheDebuggersOwnBuffer) {
  Session session(SITUATION, "memory", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  wire::PrepareT prepare;
  prepare.text = inserted(inserted(fragmentText(session.describe()), "void main",
                                   "layout(std430) buffer Debugger { uint seen[]; };\n"),
                          "color = ", "seen[place.y * 48 + place.x] = cell; ");
  prepare.user_outputs = {"color"};
  prepare.storage_block = "Debugger";
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  execute.compare = true;
  execute.storage_words = kPixels;
  execute.repeats = 2;
  const wire::ExecutedT executed = session.execute(execute);
  EXPECT_EQ(executed.compared, kCompared);
  EXPECT_EQ(executed.differing, 0U);
  EXPECT_EQ(session.values<std::uint32_t>(executed.storage), std::vector<std::uint32_t>(kPixels, 7));
  end(session);
}

TEST(Memory, isComparedWithWhatTheProgramsOwnDrawLeaves) {
  Session session(SITUATION, "memory", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  const std::string text = fragmentText(session.describe());
  const auto differing = [&](const std::string& statement) {
    const wire::ExecutedT executed = executeText(session, inserted(text, "color = ", statement));
    EXPECT_EQ(executed.compare_reason, "");
    EXPECT_EQ(executed.compared, kCompared);
    EXPECT_EQ(executed.largest, nullptr) << "nobody says what a buffer's bytes are";
    return executed.differing;
  };
  EXPECT_EQ(differing("cells[place.y * 48 + place.x] = uint(place.x < 2); "), kPixels);
  EXPECT_EQ(differing("if (place.x < 2) cells[place.y * 48 + place.x] = 1u; "), 2U * kHeight);
  EXPECT_EQ(differing("if (place.x < 3) atomicCounterIncrement(fragments); "), 1U);
  EXPECT_EQ(differing("if (place.x < 4) imageStore(picture, ivec3(place, 0), vec4(8.0)); "), 4U * kHeight);
  EXPECT_EQ(differing("if (place.x < 5) imageAtomicAdd(row, place.x, 1u); "), 5U);
  end(session);
}

TEST(Memory, thatIsNeverTheSameProvesNothing) {
  Session session(SITUATION, "clock-in-memory", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  const std::string text = fragmentText(session.describe());
  const wire::ExecutedT same = executeText(session, text);
  EXPECT_NE(same.compare_reason.find("the storage buffer at binding 0"), std::string::npos)
      << same.compare_reason;
  EXPECT_EQ(same.compared, 4 * kPixels);
  EXPECT_EQ(same.differing, 0U);
  // What is the same each time is compared all the same.
  const wire::ExecutedT other =
      executeText(session, inserted(text, "color = ", "if (gl_FragCoord.x < 1.0) color.x = 1.0; else "));
  EXPECT_EQ(other.compare_reason, "");
  EXPECT_GE(other.differing, std::uint64_t{kHeight});
  end(session);
}

TEST(Memory, thatCannotBeCopiedIsNotTouched) {
  Session session(SITUATION, "multisampled-image", "");
  session.resumeTo(0, 0);
  ASSERT_NE(session.receive(), nullptr);
  wire::PrepareT prepare;
  prepare.text = fragmentText(session.describe());
  prepare.user_outputs = {"color"};
  wire::ExecuteT execute;
  execute.handle = session.prepare(prepare);
  const auto reply = session.ask(execute);
  const wire::FailedT* failed = reply->body.AsFailed();
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->kind, wire::ErrorKind::Unsupported);
  EXPECT_NE(failed->text.find("image at unit 0"), std::string::npos) << failed->text;
  EXPECT_NE(failed->text.find("multisampled"), std::string::npos) << failed->text;
  end(session);
}

TEST(Situations, debugCallbacksHearNothing) {
  Session session(SITUATION, "debug-messages", "");
  expectHalfEverywhere(session, "0.5");
  wire::PrepareT wrong;
  wrong.text = "#version 330\nnonsense\n";
  EXPECT_NE(session.ask(wrong)->body.AsFailed(), nullptr);
  end(session);
}

TEST(Situations, aForkedChildGoesItsOwnWay) {
  Session session(SITUATION, "forked", "");
  expectHalfEverywhere(session, "0.5");
  EXPECT_EQ(session.page().draws(), 1U);
  session.resumeToEnd();
  const auto exiting = session.receive();
  ASSERT_NE(exiting, nullptr);
  ASSERT_NE(exiting->body.AsExiting(), nullptr);
  EXPECT_EQ(exiting->body.AsExiting()->draws, 1U);
  EXPECT_EQ(session.scene().status(), 0);
}

// ---- frames
// ----------------------------------------------------------------------------------------------------

TEST(Frames, endWhenTheProgramPresents) {
  const Folder folder;
  Session session(SCENE_EGL, "frames", folder / "out");
  wire::ResumeT resume;
  resume.stop = true;
  resume.frame = 1;
  resume.draw = 2;
  resume.report_frames = true;
  session.send(resume);
  auto message = session.receive();
  ASSERT_NE(message, nullptr);
  ASSERT_NE(message->body.AsFrameEnded(), nullptr);
  EXPECT_EQ(message->body.AsFrameEnded()->frame, 0U);
  EXPECT_EQ(message->body.AsFrameEnded()->draws, 3U);
  EXPECT_NE(session.ask(wire::DescribeT{})->body.AsFailed(), nullptr);  // not in a draw

  session.send(resume);
  message = session.receive();
  ASSERT_NE(message, nullptr);
  ASSERT_NE(message->body.AsStopped(), nullptr);
  EXPECT_EQ(message->body.AsStopped()->frame, 1U);
  EXPECT_EQ(message->body.AsStopped()->draw, 2U);

  session.resumeTo(2, 5);  // there is none
  message = session.receive();
  ASSERT_NE(message, nullptr);
  ASSERT_NE(message->body.AsFrameEnded(), nullptr);
  EXPECT_EQ(message->body.AsFrameEnded()->frame, 2U);

  session.resumeToEnd();
  message = session.receive();
  ASSERT_NE(message, nullptr);
  ASSERT_NE(message->body.AsExiting(), nullptr);
  EXPECT_EQ(message->body.AsExiting()->frames, 4U);
  EXPECT_EQ(message->body.AsExiting()->draws, 0U);
  EXPECT_EQ(session.scene().status(), 0);
}

}  // namespace
}  // namespace agent_test
