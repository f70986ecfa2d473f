// A whole session in the window, against what the command line says of the same thread.
#include <gtest/gtest.h>

#include "session/text.h"
#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

// A value as the command line's JSON has it, in the text of the window.
QString textOf(const Json& value) {
  if (value.is_array()) {
    QStringList parts;
    for (const Json& part : value) parts.push_back(textOf(part));
    return parts.join(", ");
  }
  return QString::fromStdString(value.is_string() ? value.get<std::string>() : value.dump());
}

// Numbers alone, so that 0 and 0.0 and vec3(0, 0, 0) and [0, 0, 0] compare.
QList<double> numbersIn(const QString& text) {
  static const QRegularExpression kNumber(R"((?<![A-Za-z_])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)");
  QString plain = text;
  plain.remove(QRegularExpression(R"(^[a-z]+\d*\()"));
  QList<double> numbers;
  auto matches = kNumber.globalMatch(plain);
  while (matches.hasNext()) numbers.push_back(matches.next().captured().toDouble());
  return numbers;
}

TEST(Session, ShowsWhatTheCommandLineShows) {
  Scratch scratch;
  const Json run = scratch.shadestep({"debug", "--pixel", "32,30", "--json"}, smallRaycaster()).json();

  Window window;
  window.start(smallRaycaster());
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  ASSERT_NE(window->source(), nullptr);
  window.pick(32, 30);
  ASSERT_TRUE(window.debugger().pixel());
  EXPECT_EQ(window.debugger().pixel()->x, 32);
  EXPECT_EQ(window.debugger().pixel()->y, 30);
  ASSERT_TRUE(window.debugger().run()) << window.debugger().runReason().toStdString();
  ASSERT_EQ(window.debugger().run()->run.steps.size(), run["steps"].size());

  // Behind every step of the thread so far, what it had changed is what the window shows at the next one.
  int compared = 0;
  const auto& positions = window.debugger().run()->positions;
  for (std::size_t i = 0; i + 1 < positions.size() && compared < 40; ++i) {
    const Json& step = run["steps"][i];
    if (!positions[i + 1] || step["kind"] != "statement" || step["changed"].empty()) continue;
    window.debugger().moveToStep(static_cast<int>(i + 1));
    window.settle();
    ASSERT_EQ(window.debugger().place()->line, run["steps"][i + 1]["line"].get<int>());
    for (const auto& [name, value] : step["changed"].items()) {
      const QString shown = window.shown(QString::fromStdString(name));
      if (shown.isEmpty()) continue;  // out of scope at the next statement
      EXPECT_EQ(numbersIn(shown), numbersIn(textOf(value["value"])))
          << name << " behind step " << i << ": " << shown.toStdString();
      ++compared;
    }
    ASSERT_TRUE(window.debugger().check());
    EXPECT_TRUE(window.debugger().check()->identical());
  }
  EXPECT_GE(compared, 15);
}

// On a pixel that the draw covers, and by the picked thread's own way.
TEST(Session, OpenGlEsAndPipelinesAreAsTheCommandLineHasThem) {
  Scratch scratch;
  for (const char* name : {"programs/es-window", "programs/es-target", "programs/pipelines"}) {
    SCOPED_TRACE(name);
    if (scratch.run({binary(name)}).status == 77) continue;  // the driver has no such surface
    Window window;
    window.start({binary(name)});
    ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
    ASSERT_TRUE(window.debugger().values());
    const session::ThreadValues& threads = window.debugger().values()->threads;
    std::size_t covered = 0;
    while (covered < threads.marks.size() && !threads.reachedAt(covered)) ++covered;
    ASSERT_LT(covered, threads.marks.size());
    const int x = static_cast<int>(covered) % threads.width, y = static_cast<int>(covered) / threads.width;
    window.pick(x, y);
    ASSERT_TRUE(window.debugger().run()) << window.debugger().runReason().toStdString();
    ASSERT_TRUE(window.debugger().check());
    EXPECT_TRUE(window.debugger().check()->identical());
    const std::string pixel = std::to_string(x) + "," + std::to_string(y);
    const Json run = scratch.shadestep({"debug", "--pixel", pixel, "--json"}, {binary(name)}).json();
    const auto& steps = window.debugger().run()->run.steps;
    ASSERT_EQ(steps.size(), run["steps"].size());
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i].line, run["steps"][i]["line"]) << i;
  }
}

TEST(Session, StepsOverIntoAndOut) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  ASSERT_TRUE(window.debugger().place());
  const int first = window.debugger().place()->line;
  EXPECT_EQ(window->source()->current(), first);
  window.press("over");
  EXPECT_NE(window.debugger().place()->line, first);
  // To the first call of a function, into it and out again.
  for (int i = 0; i < 80 && window.debugger().place()->stack.size() < 2; ++i) window.press("into");
  ASSERT_EQ(window.debugger().place()->stack.size(), 2U);
  const int call = window.debugger().place()->stack[1].line;
  window.press("out");
  ASSERT_EQ(window.debugger().place()->stack.size(), 1U);
  EXPECT_EQ(window.debugger().place()->line, call);
}

TEST(Session, ShowsAVariableAsAPicture) {
  Scratch scratch;
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  window.press("over");
  window.press("over");
  ASSERT_TRUE(window.debugger().values());
  ASSERT_FALSE(window.debugger().values()->threads.values.empty());
  const QString name = QString::fromStdString(window.debugger().values()->values.front().watched.name);
  window.debugger().show({gui::PictureSource::Kind::value, name, 0});
  window.settle();
  const gui::PicturePtr picture = window->picture().view().picture();
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 64);
  EXPECT_EQ(picture->title, name);
  const QString pixel = window->picture().view().describe(32, 30);
  const QString row = window.shown(name);
  EXPECT_EQ(numbersIn(pixel.section(':', 1)), numbersIn(row))
      << pixel.toStdString() << " / " << row.toStdString();
}

// What the driver has for an output that is not written yet is no value.
TEST(Session, AnOutputHasNoValueBeforeItIsWritten) {
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  window.debugger().addWatch("FragColor.r");
  window.settle();
  EXPECT_EQ(window.shown("FragColor"), "not written yet");
  EXPECT_EQ(window.shown("FragColor.r"), "not written yet");
  window.debugger().show({gui::PictureSource::Kind::value, "FragColor", 0});
  window.settle();
  EXPECT_FALSE(window->picture().view().picture());

  window.debugger().selectStage(session::Stage::vertex);
  window.settle();
  window.debugger().pick(session::ThreadName{{"vertex", 3}, {"instance", 0}});
  window.settle();
  EXPECT_EQ(window.shown("gl_Position"), "not written yet");
  const auto& lines = window.debugger().source()->lines;
  const auto written = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("gl_Position =") != std::string::npos;
  });
  ASSERT_NE(written, lines.end());
  const int line = static_cast<int>(written - lines.begin()) + 1;
  ASSERT_TRUE(window.stepTo(line));
  EXPECT_EQ(window.shown("gl_Position"), "not written yet");
  window.press("over");
  if (!window.debugger().place()->ended) {
    EXPECT_TRUE(window.shown("gl_Position").startsWith("vec4(")) << window.shown("gl_Position").toStdString();
  }
}

TEST(Session, AnIncludedStringHasATabOfItsOwn) {
  Window window;
  window.start({binary("programs/included-strings")});
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  const gui::SourceView* own = window->source();
  ASSERT_NE(own, nullptr);
  const QString text = own->text();
  ASSERT_TRUE(text.contains("void main")) << text.toStdString();
  EXPECT_FALSE(text.contains("float height(vec2 p)"));
  for (int i = 0; i < 20 && window.debugger().place()->stack.size() < 3; ++i) window.press("into");
  ASSERT_EQ(window.debugger().place()->stack.size(), 3U);  // main, tone, height
  const gui::SourceView* included = window->source();
  EXPECT_NE(included, own);
  EXPECT_TRUE(included->isVisible());
  EXPECT_EQ(included->current(), window.debugger().place()->line);
  EXPECT_EQ(own->current(), 0);
  EXPECT_TRUE(included->text().contains("float height(vec2 p)")) << included->text().toStdString();
}

}  // namespace
}  // namespace shadestep::test
