// What leaves the window: tables, texts, and measurements that are compared with earlier ones.
#include <gtest/gtest.h>

#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QPushButton>
#include <algorithm>
#include <fstream>

#include "window.h"

namespace shadestep::test {
namespace {

class Export : public testing::Test {
 protected:
  // In the loop, where some threads are not any more.
  void SetUp() override {
    window_.start(smallRaycaster());
    window_.pick(32, 30);
    const auto& steps = window_.debugger().run()->run.steps;
    const auto in_loop = std::find_if(steps.begin(), steps.end(), [](const session::Step& step) {
      return step.iteration == std::vector<int>{kIteration} && step.kind == session::Step::Kind::statement;
    });
    ASSERT_NE(in_loop, steps.end());
    window_.debugger().moveToStep(static_cast<int>(in_loop - steps.begin()));
    window_.settle();
    line_ = in_loop->line;
  }
  std::string fromCommandLine(const std::string& expressions) {
    const Finished done =
        scratch_.shadestep({"debug", "--at", std::to_string(line_), "--iteration", std::to_string(kIteration),
                            "--print", expressions, "--csv", scratch_.file("cli.csv")},
                           smallRaycaster());
    EXPECT_EQ(done.status, 0) << done.err;
    return readFile(scratch_.file("cli.csv"));
  }
  // Answers the dialog that asks where to.
  std::string written() {
    auto* dialog = window_->findChild<QFileDialog*>();
    if (dialog == nullptr) return "no dialog";
    Q_EMIT dialog->fileSelected(QString::fromStdString(scratch_.file("window.csv")));
    delete dialog;
    return readFile(scratch_.file("window.csv"));
  }

  static constexpr int kIteration = 9;
  int line_ = 0;
  Scratch scratch_;
  Window window_;
};

TEST_F(Export, AVariableOfAllThreadsIsWhatTheCommandLineWrites) {
  const std::string expected = fromCommandLine("dst");
  ASSERT_GT(std::count(expected.begin(), expected.end(), '\n'), 100);
  window_->variables().exportCsv("dst");
  EXPECT_EQ(written(), expected);
  window_.debugger().addWatch("dst.a * 2.0");
  window_.settle();
  window_->variables().exportCsv("dst.a * 2.0");
  EXPECT_EQ(written(), fromCommandLine("dst.a * 2.0"));
}

TEST_F(Export, TheTableOfThreadsHoldsTheSameValues) {
  const std::string expected = fromCommandLine("dst");
  for (QToolButton* button : window_->threads().findChildren<QToolButton*>())
    if (button->text() == "Export...") button->click();
  const std::string all = written();
  std::ofstream(scratch_.file("all.csv")) << all;
  const auto header = QString::fromStdString(all.substr(0, all.find('\n'))).split(',');
  const auto rows = readCsv(scratch_.file("all.csv")), own = readCsv(scratch_.file("cli.csv"));
  ASSERT_EQ(rows.size(), own.size());
  const auto first = static_cast<std::size_t>(header.indexOf("dst.x"));
  ASSERT_LT(first, rows.front().size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i][0], own[i][0]);
    ASSERT_EQ(rows[i][1], own[i][1]);
    for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(rows[i][first + c], own[i][2 + c]) << i;
  }
}

TEST_F(Export, CopiesWhatTheVariablesShow) {
  window_->variables().copy(window_.row("dst"));
  EXPECT_EQ(QApplication::clipboard()->text(), "dst = " + window_.shown("dst"));
  window_->variables().copy(window_.row("dst.w"));
  EXPECT_EQ(QApplication::clipboard()->text(), "dst.w = " + window_.shown("dst.w"));
  window_.debugger().addWatch("2 * i");
  window_.settle();
  window_->variables().copyAll();
  const QStringList lines = QApplication::clipboard()->text().split('\n');
  EXPECT_EQ(lines.front(), QString("2 * i = %1").arg(2 * kIteration));
  EXPECT_EQ(lines.count(QString("i = %1").arg(kIteration)), 1);
}

// The map shows what differs from the profile that the command line wrote of another run.
TEST(Compare, CostsAgainstAnEarlierRunPixelByPixel) {
  Scratch scratch;
  const auto raycaster = [](const std::string& termination) {
    std::vector<std::string> program = smallRaycaster();
    program.insert(program.end(), {"--ert", termination});
    return program;
  };
  ASSERT_EQ(
      scratch.shadestep({"profile", "--method", "count", "--out", scratch.file("before")}, raycaster("1"))
          .status,
      0);
  Window window;
  window.start(raycaster("1"));
  window.debugger().askProfile({"count", 5, {}});
  window.settle();
  const gui::ProfilePtr before = window.debugger().profile();
  ASSERT_TRUE(before) << window.lastMessage().toStdString();
  window.start(raycaster("0.5"));
  window.debugger().askProfile({"count", 5, scratch.file("before/profile.json")});
  window.settle();
  const gui::ProfilePtr now = window.debugger().profile();
  ASSERT_TRUE(now && now->comparison) << window.lastMessage().toStdString();
  EXPECT_EQ(window.debugger().picture().kind, gui::PictureSource::Kind::difference);
  const gui::PicturePtr picture = window->picture().view().picture();
  ASSERT_TRUE(picture);
  int cheaper = 0;
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    if (picture->cells[p] != gui::Picture::Cell::reached) continue;
    const double difference = now->profile.map.cost[p] - before->profile.map.cost[p];
    ASSERT_EQ(static_cast<double>(picture->values[p]), difference) << p;
    cheaper += difference < 0 ? 1 : 0;
  }
  EXPECT_GT(cheaper, 100);
}

}  // namespace
}  // namespace shadestep::test
