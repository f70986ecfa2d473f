#include "debugger-gui/models/thread_model.h"

#include <QFont>
#include <algorithm>
#include <cmath>
#include <limits>

#include "debugger-gui/style/theme.h"
#include "session/values.h"

namespace shadestep::gui {

ThreadModel::ThreadModel(const Debugger& debugger, QObject* parent)
    : QAbstractTableModel(parent), debugger_(debugger) {}

void ThreadModel::refresh() {
  beginResetModel();
  look_ = debugger_.values();
  who_.clear();
  columns_.clear();
  rows_.clear();
  left_out_ = 0;
  if (look_) {
    const session::ThreadValues& threads = look_->threads;
    if (threads.identity.empty()) who_ = {{"x"}, {"y"}};
    for (const session::WatchedValues& one : threads.identity) addColumns(one, who_);
    for (const Look::Value& one : look_->values)
      if (!isUniform(one.watched.name)) addColumns(one.watched, columns_);
    for (std::size_t thread = 0; thread < threads.marks.size(); ++thread) {
      if (threads.marks[thread] == 0) continue;
      if (rows_.size() < kMostRows)
        rows_.push_back(thread);
      else
        ++left_out_;
    }
    arrange();
  }
  endResetModel();
  refreshPicked();
}

// What is the same for all threads has no column, unless somebody watches it.
bool ThreadModel::isUniform(const std::string& name) const {
  if (!debugger_.place() || debugger_.watches().contains(QString::fromStdString(name))) return false;
  const auto& scope = debugger_.place()->scope;
  return std::any_of(scope.begin(), scope.end(), [&](const ScopeEntry& entry) {
    return entry.name == name && entry.storage == frontend::Storage::uniform;
  });
}

void ThreadModel::refreshPicked() {
  picked_ = look_ ? debugger_.picked().in(look_->threads) : std::nullopt;
  of_fragment_.clear();
  if (look_ && debugger_.origin())
    for (const session::ThreadName& name : debugger_.origin()->threads)
      if (const auto thread = Picked{debugger_.stage(), {}, name}.in(look_->threads))
        of_fragment_.push_back(*thread);
  if (!rows_.empty())
    Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, columnCount() - 1),
                       {Qt::BackgroundRole, Qt::FontRole});
}

void ThreadModel::addColumns(const session::WatchedValues& value, std::vector<Column>& columns) {
  std::size_t word = 0;
  for (const frontend::Component& component : frontend::components(value.type)) {
    columns.push_back({QString::fromStdString(value.name + component.access), &value, word, component.basic});
    word += static_cast<std::size_t>(session::wordsPerComponent(component.basic));
  }
}

const ThreadModel::Column& ThreadModel::at(int column) const {
  const auto i = static_cast<std::size_t>(column);
  return i < who_.size() ? who_[i] : columns_[i - who_.size()];
}

int ThreadModel::rowOf(std::size_t thread) const {
  const auto found = std::find(rows_.begin(), rows_.end(), thread);
  return found == rows_.end() ? -1 : static_cast<int>(found - rows_.begin());
}

double ThreadModel::number(std::size_t thread, int column) const {
  const Column& one = at(column);
  const auto width = static_cast<std::size_t>(std::max(look_->threads.width, 1));
  if (one.values == nullptr) return static_cast<double>(column == 0 ? thread % width : thread / width);
  if (column >= identityColumns() && !look_->threads.reachedAt(thread))
    return std::numeric_limits<double>::quiet_NaN();
  return session::componentAsDouble(one.basic, one.values->at(thread) + one.word);
}

QString ThreadModel::text(std::size_t thread, const Column& one, int column) const {
  if (one.values == nullptr) return QString::number(number(thread, column), 'f', 0);
  if (column >= identityColumns() && !look_->threads.reachedAt(thread)) return QString("-");
  return QString::fromStdString(session::formatComponent(one.basic, one.values->at(thread) + one.word));
}

void ThreadModel::sort(int column, Qt::SortOrder order) {
  sorted_by_ = column >= 0 && column < columnCount() ? at(column).name : QString();
  order_ = order;
  Q_EMIT layoutAboutToBeChanged();
  arrange();
  Q_EMIT layoutChanged();
}

// NaN and threads that do not get here come last, whichever way it is sorted; unsorted they stand in the
// order of their numbers.
void ThreadModel::arrange() {
  const auto before = [&](std::size_t a, std::size_t b) {
    for (int column = 0; column < identityColumns() && who_.front().values != nullptr; ++column)
      if (number(a, column) != number(b, column)) return number(a, column) < number(b, column);
    return a < b;
  };
  // Fragments lie in their order from the start.
  if (!std::is_sorted(rows_.begin(), rows_.end(), before)) std::sort(rows_.begin(), rows_.end(), before);
  for (int column = 0; column < columnCount(); ++column) {
    if (at(column).name != sorted_by_) continue;
    std::vector<std::pair<double, std::size_t>> keys;
    keys.reserve(rows_.size());
    for (const std::size_t thread : rows_) keys.emplace_back(number(thread, column), thread);
    const bool descending = order_ == Qt::DescendingOrder;
    std::stable_sort(keys.begin(), keys.end(), [descending](const auto& a, const auto& b) {
      if (std::isnan(a.first) || std::isnan(b.first)) return !std::isnan(a.first) && std::isnan(b.first);
      return descending ? a.first > b.first : a.first < b.first;
    });
    for (std::size_t i = 0; i < keys.size(); ++i) rows_[i] = keys[i].second;
    return;
  }
}

int ThreadModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int ThreadModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(who_.size() + columns_.size());
}

QVariant ThreadModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const std::size_t thread = threadAt(index.row());
  switch (role) {
    case Qt::DisplayRole:
      return text(thread, at(index.column()), index.column());
    case Qt::TextAlignmentRole:
      return int(Qt::AlignRight | Qt::AlignVCenter);
    case Qt::FontRole: {
      QFont font = monospaced();
      font.setBold(std::find(of_fragment_.begin(), of_fragment_.end(), thread) != of_fragment_.end());
      return font;
    }
    case Qt::ForegroundRole:
      if (index.column() < identityColumns() || !look_->threads.reachedAt(thread)) return theme().faint;
      return {};
    case Qt::BackgroundRole:
      if (picked_ == thread) return theme().current_line;
      return {};
    default:
      return {};
  }
}

QVariant ThreadModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole || section >= columnCount()) return {};
  return at(section).name;
}

}  // namespace shadestep::gui
