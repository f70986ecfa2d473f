// What stands in buffers, against what the program puts there.
#include <gtest/gtest.h>

#include <set>

#include "debugger-gui/panels/state_panel.h"
#include "window.h"

namespace shadestep::test {
namespace {

class Buffers : public testing::Test {
 protected:
  void SetUp() override {
    window_.start({binary("programs/memory-blocks")});
    ASSERT_EQ(window_.debugger().program(), gui::Debugger::Program::stopped)
        << window_.lastMessage().toStdString();
    auto* panel = window_->dock("state")->findChild<gui::StatePanel*>();
    ASSERT_NE(panel, nullptr);
    page_ = &panel->buffers();
    window_->dock("state")->raise();
    panel->showTab(gui::StatePanel::kBuffers);
    window_.settle();
  }

  // The row of the list whose first two columns these are, chosen as by a click.
  void choose(const QString& use, const QString& name) {
    for (int i = 0; i < page_->list().topLevelItemCount(); ++i) {
      QTreeWidgetItem* const item = page_->list().topLevelItem(i);
      if (item->text(0) != use || item->text(1) != name) continue;
      page_->list().scrollToItem(item);
      const QRect row = page_->list().visualItemRect(item);
      QTest::mouseClick(page_->list().viewport(), Qt::LeftButton, {}, {row.left() + 20, row.center().y()});
      window_.settle();
      ASSERT_EQ(page_->list().currentItem(), item);
      return;
    }
    FAIL() << "no " << use.toStdString() << " " << name.toStdString();
  }

  QString at(int row, int column) const {
    const QAbstractItemModel& model = *page_->contents().model();
    return model.index(row, column).data().toString();
  }
  // Offset, type and value of a block's member.
  QStringList member(const QString& name) const {
    for (int i = 0; i < page_->contents().model()->rowCount(); ++i)
      if (at(i, 1) == name) return {at(i, 0), at(i, 2), at(i, 3)};
    return {};
  }
  void as(const QString& format) {
    page_->format().setCurrentText(format);
    Q_EMIT page_->format().activated(page_->format().currentIndex());
  }

  Window window_;
  gui::BuffersPage* page_ = nullptr;
};

TEST_F(Buffers, AUniformBlockShowsItsMembers) {
  choose("uniform block", "Light");
  EXPECT_EQ(page_->contents().model()->rowCount(), 9);
  EXPECT_EQ(member("Light.power"), QStringList({"0", "float", "0.25"}));
  EXPECT_EQ(member("Light.direction"), QStringList({"16", "vec3", "vec3(1, 2, 3)"}));
  EXPECT_EQ(member("Light.turn"), QStringList({"32", "mat3", "mat3(0, 1, 2, 10, 11, 12, 20, 21, 22)"}));
  EXPECT_EQ(member("Light.weights[0]"), QStringList({"80", "float", "0.5"}));
  EXPECT_EQ(member("Light.weights[2]"), QStringList({"112", "float", "2.5"}));
  EXPECT_EQ(member("Light.on"), QStringList({"128", "bool", "true"}));
  EXPECT_EQ(member("Light.size"), QStringList({"136", "ivec2", "ivec2(7, -8)"}));
  EXPECT_EQ(member("Light.skew"), QStringList({"144", "mat2x3", "mat2x3(0, 1, 2, 100, 101, 102)"}));
}

TEST_F(Buffers, AnArrayWithoutASizeIsAsLongAsItsBuffer) {
  choose("storage block", "Items");
  EXPECT_EQ(member("used"), QStringList({"0", "uint", "5"}));
  EXPECT_EQ(member("exact"), QStringList({"8", "double", "0.1"}));
  EXPECT_EQ(page_->contents().model()->rowCount(), 2 + 2 * 5);
  EXPECT_EQ(member("items[0].place"),
            QStringList({"16", "vec3", "vec3(0, 0.5, 0)"}).replaceInStrings(" 0)", " -0)"));
  EXPECT_EQ(member("items[3].place"), QStringList({"64", "vec3", "vec3(3, 3.5, -3)"}));
  EXPECT_EQ(member("items[3].weight"), QStringList({"76", "float", "0.25"}));
  EXPECT_EQ(member("items[4].weight"), QStringList({"92", "float", "0.2"}));
}

TEST_F(Buffers, CountersAreNamed) {
  choose("atomic counters", "");
  EXPECT_EQ(member("counted"), QStringList({"4", "uint", "42"}));
}

TEST_F(Buffers, VerticesAreReadAsTheirAttributeReadsThem) {
  choose("vertex attribute", "position");
  ASSERT_EQ(page_->contents().model()->rowCount(), 3);
  EXPECT_EQ(at(1, 0), "12");
  EXPECT_EQ(at(1, 1), "3");
  EXPECT_EQ(at(1, 2), "-1");
  choose("vertex attribute", "tint");
  ASSERT_EQ(page_->contents().model()->rowCount(), 3);
  EXPECT_EQ(at(1, 2), "1");
  EXPECT_EQ(at(1, 3), "0.2");
  EXPECT_EQ(at(2, 4), "0");
}

TEST_F(Buffers, AnyFormatCanBeChosen) {
  choose("indices", "");
  as("uint16");
  ASSERT_EQ(page_->contents().model()->rowCount(), 3);
  EXPECT_EQ(at(0, 1), "2");
  EXPECT_EQ(at(2, 1), "1");
  as("hex bytes");
  EXPECT_EQ(page_->contents().model()->rowCount(), 6);
  EXPECT_EQ(at(0, 1), "02");
  choose("uniform block", "Light");
  as("float");
  page_->components().setValue(3);
  page_->stride().setValue(16);
  EXPECT_EQ(at(1, 0), "16");
  EXPECT_EQ(at(1, 1), "1");
  EXPECT_EQ(at(1, 3), "3");
  as("members");
  EXPECT_EQ(member("Light.power").value(2), "0.25");
}

TEST_F(Buffers, HaveTheirCheckBesideThem) {
  auto* badge = page_->findChild<gui::CheckBadge*>();
  ASSERT_NE(badge, nullptr);
  EXPECT_TRUE(badge->isVisibleTo(page_));
  EXPECT_EQ(badge->text(), "no values yet");
  choose("storage block", "Items");
  EXPECT_EQ(badge->text(), "identical");
  ASSERT_TRUE(window_.debugger().buffer());
  EXPECT_EQ(window_.debugger().buffer()->check.compared, window_.debugger().buffer()->bytes.size());
  window_.start(smallRaycaster());
  EXPECT_EQ(badge->text(), "no values yet");
}

TEST_F(Buffers, AreThoseOfThePresentDraw) {
  const auto uses = [&] {
    std::set<QString> list;
    for (int i = 0; i < page_->list().topLevelItemCount(); ++i)
      list.insert(page_->list().topLevelItem(i)->text(0));
    return list;
  };
  EXPECT_EQ(uses().count("uniform block"), 1U);
  window_.start(smallRaycaster());
  window_.settle();
  EXPECT_EQ(uses().count("vertex attribute"), 1U);
  EXPECT_EQ(uses().count("uniform block"), 0U);
}

}  // namespace
}  // namespace shadestep::test
