#include "debugger-gui/models/call_model.h"

#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {

QString callText(const session::LoggedCall& call) {
  QStringList arguments;
  for (const auto& [name, value] : call.arguments)
    arguments.push_back(QString::fromStdString(name + " = " + value));
  return QString::fromStdString(call.name) + "(" + arguments.join(", ") + ")";
}

void CallModel::add(const std::vector<session::LoggedCall>& calls) {
  if (calls.empty()) return;
  const int first = static_cast<int>(calls_.size());
  beginInsertRows({}, first, first + static_cast<int>(calls.size()) - 1);
  calls_.insert(calls_.end(), calls.begin(), calls.end());
  endInsertRows();
}

void CallModel::clear() {
  beginResetModel();
  calls_.clear();
  endResetModel();
}

int CallModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(calls_.size());
}

QVariant CallModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const session::LoggedCall& call = calls_[static_cast<std::size_t>(index.row())];
  if (role == Qt::ForegroundRole && call.error != 0) return theme().bad;
  if (role == Qt::FontRole && index.column() == 1) return monospaced();
  if (role != Qt::DisplayRole) return {};
  switch (index.column()) {
    case 0:
      return QString("%1:%2").arg(call.frame).arg(call.index);
    case 1:
      return callText(call);
    case 2:
      return QString::fromStdString(call.result);
    default:
      return call.error != 0 ? QString::fromStdString(session::errorName(call.error))
             : call.skipped  ? tr("left out")
                             : QString();
  }
}

QVariant CallModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  static const char* const kNames[] = {"Frame", "Call", "Result", "Error"};
  return tr(kNames[section]);
}

}  // namespace shadestep::gui
