// The agent in situations where it must refuse with a reason, or take special care (agent_situation.cpp).
#include <algorithm>

#include "agent_session.h"

namespace agent_test {
namespace {

TEST(Situations, goWellWithoutADebugger) {
  for (const char* name :
       {"ordinary", "deleted-program", "fixed-function", "immediate-mode", "display-list", "query",
        "condition", "no-rasterizer", "multisampled", "pipeline", "several-shaders", "feedback",
        "subroutines", "storage-block", "debug-messages", "forked"}) {
    Scene scene({SITUATION, name}, {});
    EXPECT_EQ(scene.status(), 0) << name;
  }
}

std::string fragmentText(const wire::DrawT& draw) {
  for (const auto& stage : draw.stages) {
    if (stage->stage != wire::Stage::Fragment) continue;
    std::string text;
    for (const auto& string : stage->sources) text += string->text;
    return text;
  }
  return "";
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
                                         Refused{"immediate-mode", "glBegin draws cannot be replayed"},
                                         Refused{"display-list", "display list"}, Refused{"query", "query"},
                                         Refused{"condition", "condition"},
                                         Refused{"no-rasterizer", "GL_RASTERIZER_DISCARD"},
                                         Refused{"multisampled", "multisampled"},
                                         Refused{"pipeline", "pipeline"},
                                         Refused{"several-shaders", "several shader objects"}),
                         [](const auto& one) {
                           std::string name = one.param.situation;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// ---- special care
// ----------------------------------------------------------------------------------------------

// Captures what the shader is about to write, in every pixel.
void expectHalfEverywhere(Session& session, const std::string& expression) {
  session.resumeTo(0, 0);
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

TEST(Situations, transformFeedbackPausesForReplays) {
  Session session(SITUATION, "feedback", "");
  expectHalfEverywhere(session, "0.5");
  end(session);
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
  EXPECT_EQ(session.page().draws.load(), 1U);
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
