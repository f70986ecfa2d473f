// Stages other than the fragment stage in the window, against what the command line says of the same threads.
#include <gtest/gtest.h>

#include <QClipboard>
#include <QPushButton>
#include <set>

#include "session/values.h"
#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;
using session::Stage;

std::vector<std::string> cells() {
  return {binary("marching-cubes"), "12"};
}

// A row of the threads panel by who it is; -1 if there is none.
int rowOf(Window& window, const session::ThreadName& name) {
  const auto& threads = window.debugger().values()->threads;
  const auto thread = threads.find(name);
  return thread ? window->threads().model().rowOf(*thread) : -1;
}

// A component in the threads panel, as text.
QString cell(Window& window, int row, const QString& column) {
  const auto& model = window->threads().model();
  for (int i = 0; i < model.columnCount(); ++i)
    if (model.headerData(i, Qt::Horizontal, Qt::DisplayRole).toString() == column)
      return model.index(row, i).data().toString();
  return {};
}

void openThreads(Window& window, Stage stage) {
  window->dock("threads")->raise();
  window.debugger().selectStage(stage);
  window.settle();
  ASSERT_EQ(window.debugger().stage(), stage) << window.lastMessage().toStdString();
}

TEST(Stages, AVertexIsFollowedAsOnTheCommandLine) {
  Scratch scratch;
  const Json run =
      scratch.shadestep({"debug", "--stage", "vertex", "--vertex", "3", "--json"}, smallRaycaster()).json();
  Window window;
  window.start(smallRaycaster());
  openThreads(window, Stage::vertex);
  EXPECT_EQ(window->source()->source().stage, Stage::vertex);
  window.debugger().pick(session::ThreadName{{"vertex", 3}, {"instance", 0}});
  window.settle();
  ASSERT_TRUE(window.debugger().run()) << window.debugger().runReason().toStdString();
  const auto& steps = window.debugger().run()->run.steps;
  ASSERT_EQ(steps.size(), run["steps"].size());
  // Behind each step, the panel shows of this vertex what the step had changed.
  int compared = 0;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    window.debugger().moveToStep(static_cast<int>(i + 1));
    window.settle();
    for (const session::NamedValue& value : steps[i].changed) {
      const QString shown = window.shown(QString::fromStdString(value.name));
      if (shown.isEmpty()) continue;
      EXPECT_EQ(shown.toStdString(), session::formatValue(value.value)) << value.name;
      ++compared;
    }
    EXPECT_TRUE(window.debugger().check()->identical());
  }
  EXPECT_GT(compared, 0);
  // And the inputs that the command line names.
  for (const auto& [name, value] : run["inputs"].items()) {
    if (value["type"] != "vec3") continue;
    const int row = rowOf(window, {{"vertex", 3}, {"instance", 0}});
    ASSERT_GE(row, 0);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(cell(window, row, QString::fromStdString(name) + "." + "xyz"[c]).toDouble(),
                value["value"][static_cast<std::size_t>(c)].get<double>());
  }
}

TEST(Stages, APixelLeadsToTheVerticesThatItComesFrom) {
  Scratch scratch;
  const Json runs =
      scratch.shadestep({"debug", "--stage", "vertex", "--pixel", "32,30", "--json"}, smallRaycaster())
          .json();
  Window window;
  window.start(smallRaycaster());
  window.pick(32, 30);
  window.debugger().askOrigin(Stage::vertex);
  window.settle();
  ASSERT_TRUE(window.debugger().origin()) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().stage(), Stage::vertex);
  ASSERT_EQ(window.debugger().origin()->threads.size(), runs["runs"].size());
  for (std::size_t i = 0; i < runs["runs"].size(); ++i)
    EXPECT_EQ(window.debugger().origin()->threads[i][0].second,
              runs["runs"][i]["thread"]["vertex"].get<int>());
  EXPECT_EQ(window.debugger().picked().thread, window.debugger().origin()->threads.front());
  EXPECT_EQ(window.debugger().pixel(), (gui::Pixel{32, 30}));  // still there for the fragment stage
  window.debugger().selectStage(Stage::fragment);
  window.settle();
  EXPECT_EQ(window.debugger().picked().pixel, (gui::Pixel{32, 30}));
  EXPECT_TRUE(window.debugger().run());
}

TEST(Stages, TheTableIsSortedAndCopied) {
  Window window;
  window.start(cells());
  openThreads(window, Stage::geometry);
  for (int i = 0; i < 3; ++i) window.press("over");
  auto& model = window->threads().model();
  ASSERT_GT(model.rowCount(), 100);
  for (int column = 0; column < model.columnCount(); ++column) {
    for (const Qt::SortOrder order : {Qt::AscendingOrder, Qt::DescendingOrder}) {
      window->threads().table().sortByColumn(column, order);
      for (int row = 1; row < model.rowCount(); ++row) {
        const double before = model.number(model.threadAt(row - 1), column);
        const double here = model.number(model.threadAt(row), column);
        if (std::isnan(here)) continue;  // at the end
        ASSERT_FALSE(std::isnan(before));
        ASSERT_TRUE(order == Qt::AscendingOrder ? before <= here : before >= here) << "row " << row;
      }
    }
  }
  for (QToolButton* button : window->threads().findChildren<QToolButton*>())
    if (button->text() == "Copy") button->click();
  const QStringList lines = QApplication::clipboard()->text().split('\n', Qt::SkipEmptyParts);
  ASSERT_EQ(lines.size(), model.rowCount() + 1);
  EXPECT_EQ(lines[1].split('\t')[0], model.index(0, 0).data().toString());
}

TEST(Stages, AClickInTheTableAndInThePlotPicksTheThread) {
  Window window;
  window.start(cells());
  openThreads(window, Stage::vertex);
  window.press("over");
  auto& threads = window->threads();
  QTest::mouseClick(threads.table().viewport(), Qt::LeftButton, {},
                    threads.table().visualRect(threads.model().index(5, 1)).center());
  window.settle();
  EXPECT_EQ(window.debugger().pickedIndex(), threads.model().threadAt(5));
  threads.showTab(gui::ThreadsPanel::kScatter);
  threads.plot("cell.x", "cell.y", "cell.z", "vertex");
  // The one in front of all others where it is seen.
  const std::size_t point = *threads.scatter().pointAt(threads.scatter().positionOf(40));
  QTest::mouseClick(&threads.scatter(), Qt::LeftButton, {}, threads.scatter().positionOf(point).toPoint());
  window.settle();
  ASSERT_TRUE(window.debugger().pickedIndex());
  const auto clicked = threads.scatter().pointAt(threads.scatter().positionOf(point).toPoint());
  ASSERT_TRUE(clicked);
  EXPECT_EQ(*window.debugger().pickedIndex(), threads.model().threadAt(static_cast<int>(*clicked)));
  EXPECT_TRUE(window.debugger().run()) << window.debugger().runReason().toStdString();
}

TEST(Stages, TheTreeOfAGeometryShaderIsThatOfTheCommandLine) {
  Scratch scratch;
  const Json made = scratch.shadestep({"primitives", "--json"}, cells()).json();
  Window window;
  window.start(cells());
  openThreads(window, Stage::geometry);
  window->threads().showTab(gui::ThreadsPanel::kMade);
  window.settle();
  ASSERT_TRUE(window.debugger().emits()) << window.lastMessage().toStdString();
  const QAbstractItemModel& tree = *window->threads().tree().model();
  std::vector<Json> emitting;
  for (const Json& input : made["inputs"])
    if (input["runs"][0]["vertices"] != 0) emitting.push_back(input);
  ASSERT_EQ(tree.rowCount(), static_cast<int>(emitting.size()));
  for (int i = 0; i < tree.rowCount(); ++i) {
    const QModelIndex run = tree.index(0, 0, tree.index(i, 0));
    const Json& outputs = emitting[static_cast<std::size_t>(i)]["runs"][0]["outputs"];
    ASSERT_EQ(tree.rowCount(run), static_cast<int>(outputs.size()));
    for (int k = 0; k < tree.rowCount(run); ++k)
      ASSERT_EQ(tree.rowCount(tree.index(k, 0, run)),
                static_cast<int>(outputs[static_cast<std::size_t>(k)]["vertices"].size()));
  }
  // A click goes to the run.
  auto& view = window->threads().tree();
  QTest::mouseClick(view.viewport(), Qt::LeftButton, {}, view.visualRect(tree.index(2, 0)).center());
  window.settle();
  EXPECT_EQ(window.debugger().picked().thread[0].second, emitting[2]["primitive"].get<int>());
}

TEST(Stages, ADispatchIsSteppedThrough) {
  Window window;
  window.start({binary("prefix-sums")});
  ASSERT_EQ(window.debugger().program(), Debugger::Program::stopped) << window.lastMessage().toStdString();
  ASSERT_EQ(window.debugger().stage(), Stage::compute);  // the only one
  window->dock("threads")->raise();
  window.press("over");
  const auto& threads = window.debugger().values()->threads;
  std::set<int> seen;
  for (int row = 0; row < window->threads().model().rowCount(); ++row)
    seen.insert(cell(window, row, "x").toInt());
  EXPECT_EQ(seen.size(), threads.launched);
  // A branch over a dispatch: every thread has its side's colour.
  for (int i = 0; i < 40 && window.debugger().place()->sides.empty(); ++i) window.press("over");
  const auto place = *window.debugger().place();
  ASSERT_GE(place.sides.size(), 2U);
  window.debugger().show({gui::PictureSource::Kind::outcome, {}, 0});
  const gui::PicturePtr picture = window->picture().view().picture();
  ASSERT_TRUE(picture);
  for (std::size_t side = 0; side < place.sides.size(); ++side) {
    std::uint64_t pixels = 0;
    for (const QRgb one : picture->colors) pixels += one == gui::colorOfSide(place, side) ? 1 : 0;
    EXPECT_EQ(pixels, place.sides[side].threads) << place.sides[side].name;
  }
}

TEST(Stages, BreakpointsAndThreadsOfAStageComeBackWithTheSession) {
  QByteArray saved;
  {
    Window window;
    window.start(smallRaycaster());
    window.debugger().toggleBreakpoint(40);
    openThreads(window, Stage::vertex);
    EXPECT_TRUE(window.debugger().breakpoints().isEmpty());  // they are another stage's
    window.debugger().pick(session::ThreadName{{"vertex", 2}, {"instance", 0}});
    window.debugger().toggleBreakpoint(1);
    window.settle();
    ASSERT_EQ(window.debugger().breakpoints().size(), 1);
    saved = window.debugger().saved();
  }
  Window window;
  window.debugger().restore(saved);
  window.settle();
  EXPECT_EQ(window.debugger().stage(), Stage::vertex);
  EXPECT_EQ(window.debugger().picked().thread.at(0).second, 2);
  EXPECT_EQ(window.debugger().breakpoints().size(), 1);
  window.debugger().selectStage(Stage::fragment);
  window.settle();
  EXPECT_TRUE(window.debugger().breakpoints().contains(40));
}

}  // namespace
}  // namespace shadestep::test
