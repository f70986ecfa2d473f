#include "debugger-gui/models/buffer_model.h"

#include <algorithm>
#include <limits>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {

void BufferModel::show(const BufferPtr& buffer) {
  beginResetModel();
  buffer_ = buffer;
  endResetModel();
}

void BufferModel::read(const std::optional<session::ElementFormat>& format) {
  beginResetModel();
  format_ = format;
  endResetModel();
}

int BufferModel::rowCount(const QModelIndex& parent) const {
  if (!buffer_ || parent.isValid()) return 0;
  const std::uint64_t rows = format_ ? format_->count(buffer_->bytes.size()) : buffer_->values.members.size();
  return static_cast<int>(std::min<std::uint64_t>(rows, std::numeric_limits<int>::max()));
}

int BufferModel::columnCount(const QModelIndex& parent) const {
  if (parent.isValid()) return 0;
  return format_ ? 1 + format_->components : 4;
}

QVariant BufferModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || !buffer_) return {};
  if (role == Qt::FontRole) return monospaced();
  if (format_) {
    const auto element = static_cast<std::uint64_t>(index.row());
    if (role == Qt::TextAlignmentRole) return int(Qt::AlignRight | Qt::AlignVCenter);
    if (role == Qt::ForegroundRole && index.column() == 0) return theme().faint;
    if (role != Qt::DisplayRole) return {};
    if (index.column() == 0) return QString::number(element * format_->step());
    return QString::fromStdString(
        session::elementText(*format_, buffer_->bytes, element, index.column() - 1));
  }
  const session::MemberValue& member = buffer_->values.members[static_cast<std::size_t>(index.row())];
  if (role == Qt::TextAlignmentRole && index.column() == 0) return int(Qt::AlignRight | Qt::AlignVCenter);
  const bool missing = member.value.empty();
  if (role == Qt::ForegroundRole && (index.column() != 3 || missing) && index.column() != 1)
    return theme().faint;
  if (role != Qt::DisplayRole && role != Qt::ToolTipRole) return {};
  switch (index.column()) {
    case 0:
      return QString::number(member.offset);
    case 1:
      return QString::fromStdString(member.name);
    case 2:
      return QString::fromStdString(member.type);
    default:
      return missing ? tr("behind the buffer's end") : QString::fromStdString(member.value);
  }
}

QVariant BufferModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role == Qt::TextAlignmentRole && orientation == Qt::Horizontal && format_)
    return int(Qt::AlignRight | Qt::AlignVCenter);
  if (role != Qt::DisplayRole) return {};
  if (orientation == Qt::Vertical) return section;
  if (section == 0) return tr("Byte");
  if (format_) return format_->components == 1 ? tr("Value") : QString("%1").arg("xyzw"[section - 1]);
  return section == 1 ? tr("Member") : section == 2 ? tr("Type") : tr("Value");
}

}  // namespace shadestep::gui
