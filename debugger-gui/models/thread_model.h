// The values at the place, a row a thread: who it is, and a column for each component. Sorted by any column.
#pragma once

#include <QAbstractTableModel>
#include <QStringList>
#include <vector>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class ThreadModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  // Fragments are many: a table of more rows than this shows the first of them.
  static constexpr std::size_t kMostRows = 200'000;

  explicit ThreadModel(const Debugger&, QObject* parent = nullptr);

  // Takes over what the debugger knows now. The columns by which it is sorted stay while they are there.
  void refresh();
  void refreshPicked();                              // other rows are the picked thread's and its fragment's
  std::size_t leftOut() const { return left_out_; }  // threads beyond kMostRows
  std::size_t threadAt(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  int rowOf(std::size_t thread) const;  // -1: not in the table
  int identityColumns() const { return static_cast<int>(who_.size()); }
  double number(std::size_t thread, int column) const;  // NaN where the thread does not get here

  int rowCount(const QModelIndex& = {}) const override;
  int columnCount(const QModelIndex& = {}) const override;
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;
  void sort(int column, Qt::SortOrder) override;

 private:
  struct Column {
    QString name;
    const session::WatchedValues* values = nullptr;  // null: x or y of a fragment
    std::size_t word = 0;
    frontend::Basic basic = frontend::Basic::int_;
  };
  void addColumns(const session::WatchedValues&, std::vector<Column>&);
  const Column& at(int column) const;
  QString text(std::size_t thread, const Column&, int column) const;
  void arrange();
  bool isUniform(const std::string& name) const;

  const Debugger& debugger_;
  LookPtr look_;
  std::vector<Column> who_, columns_;
  std::vector<std::size_t> rows_;
  std::size_t left_out_ = 0;
  QString sorted_by_;
  Qt::SortOrder order_ = Qt::AscendingOrder;
  std::optional<std::size_t> picked_;
  std::vector<std::size_t> of_fragment_;  // threads that the picked pixel's fragment comes from
};

}  // namespace shadestep::gui
