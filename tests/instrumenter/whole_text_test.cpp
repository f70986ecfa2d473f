// What holds of every instrumented text of a shader.
#include <gtest/gtest.h>

#include "instrumenter/measures.h"
#include "shaders.h"

namespace shadestep::instrumenter::test {
namespace {

using frontend::CallId;
using frontend::Shader;
using frontend::StatementId;
using frontend::Token;
using When = Probe::When;

// Every text that the instrumenter makes of a shader.
std::vector<std::string> allTexts(const Shader& shader) {
  std::vector<std::string> texts = {uninstrumented(shader)};
  const auto add = [&texts](const auto& result) {
    if (const auto* failure = std::get_if<Failure>(&result)) throw std::runtime_error(failure->reason);
    texts.push_back(std::get<0>(result).text);
  };
  std::vector<StatementId> loops;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const frontend::Statement& statement = shader.statements[i];
    const auto id = static_cast<StatementId>(i);
    if (statement.kind == frontend::StatementKind::block ||
        statement.kind == frontend::StatementKind::case_label)
      continue;
    const bool jump = statement.kind == frontend::StatementKind::return_ ||
                      statement.kind == frontend::StatementKind::discard ||
                      statement.kind == frontend::StatementKind::break_ ||
                      statement.kind == frontend::StatementKind::continue_;
    for (const When when : {When::before, When::after}) {
      if (jump && when == When::after) continue;
      Probe probe;
      probe.when = when;
      probe.statement = id;
      probe.iterations = {0, 1};
      add(instrumentSingle(shader, probe, target()));
      for (std::size_t call = 0; call < shader.calls.size(); ++call) {
        if (shader.calls[call].callee != statement.function) continue;
        probe.call_path = {static_cast<CallId>(call)};
        add(instrumentSingle(shader, probe, target()));
      }
    }
    if (statement.kind == frontend::StatementKind::for_ ||
        statement.kind == frontend::StatementKind::while_ ||
        statement.kind == frontend::StatementKind::do_while)
      loops.push_back(id);
  }
  if (shader.profile != "es" || shader.version >= 310) add(instrumentRecording(shader, target()));
  for (const StatementId loop : loops) add(instrumentLoops(shader, {loop}, target()));
  add(instrumentCount(shader, {}, target()));
  if (shader.profile != "es") add(instrumentClock(shader, target()));
  return texts;
}

// The user's tokens, as an instrumented text may have them: `main`, `discard` and gl_FragColor are the only
// ones to be replaced (calls of cloned functions keep the original's name in the function that was cloned, or
// read
// "<prefix>f<depth>").
bool isSupersequence(const std::vector<Token>& instrumented, const std::vector<Token>& user) {
  std::size_t next = 0;
  for (const Token& token : instrumented) {
    if (next == user.size()) break;
    const std::string& wanted = user[next].text;
    const bool replaced = (wanted == "main" && token.text == "sd_main") ||
                          (wanted == "discard" && token.text == "sd_discard") ||
                          (wanted == "gl_FragColor" && token.text == "gl_FragData") || token.text == "sd_f0";
    if (token.text == wanted || replaced) ++next;
  }
  return next == user.size();
}

class WholeText : public testing::TestWithParam<std::tuple<Dialect, Body>> {};

TEST_P(WholeText, ParsesAgainAndKeepsTheUsersTokens) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  for (const std::string& text : allTexts(shader)) {
    const frontend::Preprocessed tokens = frontend::preprocess({text}, {});
    ASSERT_EQ(tokens.error, "") << text;
    EXPECT_TRUE(isSupersequence(tokens.tokens, shader.tokens)) << text;
    if (text.find("clock2x32ARB") != std::string::npos)
      continue;  // analysed only where the extension is declared
    EXPECT_EQ(frontend::analyse(frontend::Stage::fragment, {text}, {}).error, "") << text;
  }
}

TEST_P(WholeText, IsTheUsersWithoutInstrumentation) {
  const auto& [dialect, body] = GetParam();
  if (dialect.version < body.version) GTEST_SKIP() << "needs GLSL " << body.version;
  const Shader shader = analysed(dialect.text(body.text));
  const std::vector<Token> again = frontend::preprocess({uninstrumented(shader)}, {}).tokens;
  ASSERT_EQ(again.size(), shader.tokens.size());
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].text, shader.tokens[i].text);
}

INSTANTIATE_TEST_SUITE_P(All, WholeText,
                         testing::Combine(testing::ValuesIn(kDialects), testing::ValuesIn(kBodies)),
                         [](const auto& parameters) {
                           return std::get<0>(parameters.param).name + "_" +
                                  std::get<1>(parameters.param).name;
                         });

}  // namespace
}  // namespace shadestep::instrumenter::test
