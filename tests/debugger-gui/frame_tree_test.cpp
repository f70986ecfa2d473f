// The tree of frames, draws and the calls that lead to each, against the command line's log of calls.
#include <gtest/gtest.h>

#include <QAbstractProxyModel>

#include "debugger-gui/panels/frame_panel.h"
#include "window.h"

namespace shadestep::test {
namespace {

using gui::Debugger;

class FrameTree : public testing::Test {
 protected:
  void start(const std::vector<std::string>& program, std::uint64_t frame = 0) {
    window_.start(program, frame);
    ASSERT_EQ(window_.debugger().program(), Debugger::Program::stopped)
        << window_.lastMessage().toStdString();
    panel_ = window_->dock("frames")->findChild<gui::FramePanel*>();
  }
  QAbstractItemModel& model() { return *panel_->tree().model(); }
  // As the tree shows them, by its draw's number.
  QModelIndex draw(std::uint64_t frame, std::uint64_t number) {
    for (int f = 0; f < model().rowCount(); ++f) {
      const QModelIndex above = model().index(f, 0);
      if (!above.data().toString().startsWith(QString("Frame %1,").arg(frame))) continue;
      for (int row = 0; row < model().rowCount(above); ++row)
        if (model().index(row, 0, above).data().toString() == QString::number(number))
          return model().index(row, 0, above);
    }
    return {};
  }
  QStringList under(const QModelIndex& draw) {
    QStringList rows;
    for (int row = 0; row < model().rowCount(draw); ++row)
      rows.push_back(model().index(row, 0, draw).data().toString());
    return rows;
  }
  void listCallsBefore(const QModelIndex& draw) {
    const QModelIndex row = model().index(0, 0, draw);
    ASSERT_TRUE(row.data().toString().contains("list the calls")) << row.data().toString().toStdString();
    Q_EMIT panel_->tree().activated(row);
    window_.settle();
    ASSERT_EQ(window_.debugger().program(), Debugger::Program::stopped)
        << window_.lastMessage().toStdString();
  }
  // The names of the frame's calls before each draw, and the whole of it as the last one.
  static std::vector<QStringList> namesBefore(const std::vector<std::string>& program, int frame) {
    const Scratch scratch;
    std::vector<QStringList> names(1);
    const Json log = scratch.shadestep({"calls", "--json", "--frame", std::to_string(frame)}, program).json();
    for (const Json& call : log["calls"]) {
      if (call["frame"] != frame) continue;
      const QString name = QString::fromStdString(call["name"].get<std::string>());
      if (name.startsWith("glDraw")) {
        names.emplace_back();
      } else {
        names.back().push_back(name);
      }
    }
    return names;
  }
  static QStringList namesIn(const QStringList& rows) {
    QStringList names;
    for (const QString& row : rows) names.push_back(row.section('(', 0, 0));
    return names;
  }

  Window window_;
  gui::FramePanel* panel_ = nullptr;
};

TEST_F(FrameTree, ShowsTheCallsThatLeadToEachDraw) {
  const std::vector<std::string> program{binary("programs/several-draws")};
  const auto names = namesBefore(program, 0);
  ASSERT_EQ(names.size(), 4U);
  start(program);
  window_.press("list");
  EXPECT_EQ(namesIn(under(draw(0, 1))), names[1]);
  EXPECT_EQ(under(draw(0, 1)).filter("glUniform4f(").value(0).count("0.5"), 1);
  EXPECT_EQ(namesIn(under(draw(0, 2))), names[2]);
  listCallsBefore(draw(0, 0));  // those are from the program's start on: it is started again
  EXPECT_EQ(namesIn(under(draw(0, 0))), names[0]);
  EXPECT_EQ(namesIn(under(draw(0, 1))), names[1]);
  EXPECT_EQ(window_.debugger().stop()->draw.stop.draw, 0U);
  EXPECT_EQ(window_.debugger().listed().value(0).calls.count("glLinkProgram"), 0U);
}

TEST_F(FrameTree, TheFirstCallsOfAFrameAreThoseFromItsBegin) {
  const std::vector<std::string> program{binary("programs/frames"), "3"};
  const auto names = namesBefore(program, 1);
  ASSERT_EQ(names.size(), 3U);
  start(program, 1);
  listCallsBefore(draw(1, 0));
  EXPECT_EQ(namesIn(under(draw(1, 0))), names[0]);
  EXPECT_EQ(namesIn(under(draw(1, 1))), names[1]);
  EXPECT_EQ(window_.debugger().stop()->draw.stop.frame, 1U);
}

// The last names of the log are those behind the last draw.
TEST_F(FrameTree, ShowsTheCallsBehindTheLastDraw) {
  const std::vector<std::string> program{binary("programs/frames"), "3"};
  for (const int frame : {0, 1}) {
    const auto names = namesBefore(program, frame);
    ASSERT_EQ(names.size(), 3U);
    ASSERT_FALSE(names.back().isEmpty());
    start(program, static_cast<std::uint64_t>(frame));
    window_.press("list");
    const QModelIndex above = draw(static_cast<std::uint64_t>(frame), 0).parent();
    EXPECT_TRUE(above.data().toString().contains("2 draws")) << above.data().toString().toStdString();
    ASSERT_EQ(model().rowCount(above), 3);
    const QModelIndex end = model().index(2, 0, above);
    EXPECT_EQ(end.data().toString(), "end");
    // The log of the command line ends before the call that ends the frame.
    EXPECT_EQ(namesIn(under(end)), names.back() + QStringList("eglSwapBuffers"));
    Q_EMIT panel_->tree().activated(end);  // it is no place to go to
    EXPECT_EQ(window_.debugger().stop()->draw.stop.draw, 0U);
  }
}

TEST_F(FrameTree, FindsCalls) {
  start({binary("programs/several-draws")});
  window_.press("list");
  const QModelIndex frame = model().index(0, 0);
  ASSERT_EQ(model().rowCount(frame), 4) << "its draws, and what is behind them";
  panel_->search().setText("gluseprogram");
  ASSERT_EQ(model().rowCount(model().index(0, 0)), 1);
  EXPECT_EQ(namesIn(under(draw(0, 2))), QStringList("glUseProgram"));
  EXPECT_TRUE(panel_->tree().isExpanded(draw(0, 2)));
  panel_->search().setText("list the calls");  // what the tree says itself is not searched
  EXPECT_EQ(model().rowCount(), 0);
  panel_->search().clear();
  EXPECT_EQ(model().rowCount(model().index(0, 0)), 4);
}

// Draws that come in before others leave theirs where they are.
TEST_F(FrameTree, StaysUnfoldedWhileItGrows) {
  start({binary("programs/several-draws")});
  window_.debugger().list(0, 2, gui::Listing::calls);
  window_.settle();
  panel_->tree().setExpanded(draw(0, 2), true);
  const auto& shown = static_cast<QAbstractProxyModel&>(model());
  const QPersistentModelIndex call = shown.mapToSource(model().index(0, 0, draw(0, 2)));
  const QString text = call.data().toString();
  ASSERT_TRUE(text.startsWith("glUseProgram")) << text.toStdString();
  window_.debugger().goTo(0, 1);
  window_.settle();
  ASSERT_EQ(model().rowCount(model().index(0, 0)), 4);
  EXPECT_TRUE(panel_->tree().isExpanded(draw(0, 2)));
  EXPECT_EQ(call.data().toString(), text);
  EXPECT_EQ(call.parent(), shown.mapToSource(draw(0, 2)));
}

}  // namespace
}  // namespace shadestep::test
