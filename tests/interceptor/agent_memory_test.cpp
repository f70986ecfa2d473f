// Memory that shaders write, of every kind (agent_memory.cpp): replayed any number of times, it ends up as
// without a debugger.
#include <algorithm>

#include "agent_session.h"

namespace agent_test {
namespace {

std::vector<std::string> pairs() {
  std::vector<std::string> names;
  std::FILE* pipe = popen(MEMORY " --list", "r");
  char line[256];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr)
    names.emplace_back(line, std::strlen(line) - 1);
  EXPECT_EQ(pclose(pipe), 0);
  return names;
}

std::string capturing(const wire::DrawT& draw) {
  std::string text;
  for (const auto& stage : draw.stages) {
    if (stage->stage != wire::Stage::Fragment) continue;
    for (const auto& string : stage->sources) text += string->text;
  }
  text.insert(text.find("out vec4"), "out uvec4 seen;\n");
  return text.insert(text.find("color = "), "seen = uvec4(gl_FragCoord.xy, 7u, 9u); ");
}

// Stops at one draw of each pair, the first or the second, and replays it five times.
void expectUntouched(std::uint64_t which) {
  const std::vector<std::string> names = pairs();
  ASSERT_GT(names.size(), 45U);
  Folder folder;
  const std::string bare = (folder / "bare").string();
  const std::string debugged = (folder / "debugged").string();
  run({MEMORY, bare});
  Session session(MEMORY, debugged, "");
  for (std::size_t i = 0; i < names.size(); ++i) {
    SCOPED_TRACE(names[i]);
    session.resumeTo(0, 2 * i + which);
    ASSERT_NE(session.receive(), nullptr);
    wire::PrepareT prepare;
    prepare.text = capturing(session.describe());
    prepare.user_outputs = {"color"};
    prepare.captures.push_back(captureOutput("seen", wire::CaptureFormat::Uint4));
    wire::ExecuteT execute;
    execute.handle = session.prepare(prepare);
    execute.compare = true;
    execute.repeats = 3;
    const wire::ExecutedT executed = session.execute(execute);
    EXPECT_EQ(executed.compare_reason, "");
    EXPECT_GT(executed.compared, 16U * 16 * 4);  // colours and memory
    EXPECT_EQ(executed.differing, 0U);
    ASSERT_EQ(executed.attachments.size(), 1U);
    const auto seen = session.values<std::uint32_t>(executed.attachments[0]);
    EXPECT_EQ(std::vector<std::uint32_t>(seen.begin(), seen.begin() + 4),
              (std::vector<std::uint32_t>{0, 0, 7, 9}));
  }
  session.resumeToEnd();
  ASSERT_EQ(session.scene().status(), 0);
  EXPECT_EQ(readFile(debugged), readFile(bare));
}

TEST(EveryKindOfMemory, isAsWithoutADebuggerAfterTheFirstDraw) {
  expectUntouched(0);
}

TEST(EveryKindOfMemory, isAsWithoutADebuggerAfterTheSecondDraw) {
  expectUntouched(1);
}

}  // namespace
}  // namespace agent_test
