#include "debugger-gui/models/draw_model.h"

#include <QFont>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {
constexpr quintptr kFrameRow = ~quintptr(0);  // internal id of frames; a draw's is its frame's row
}

DrawModel::DrawModel(const Debugger& debugger, QObject* parent)
    : QAbstractItemModel(parent), debugger_(debugger) {}

void DrawModel::refresh() {
  std::vector<Frame> frames;
  const QList<DrawEntry>& draws = debugger_.draws();
  for (qsizetype i = 0; i < draws.size(); ++i) {
    if (frames.empty() || frames.back().number != draws[i].stop.frame)
      frames.push_back({draws[i].stop.frame, i, 0});
    ++frames.back().count;
  }
  if (frames != frames_) {
    beginResetModel();
    frames_ = std::move(frames);
    draws_ = draws;
    endResetModel();
    return;
  }
  draws_ = draws;
  for (int row = 0; row < static_cast<int>(frames_.size()); ++row) {
    const QModelIndex frame = index(row, 0);
    Q_EMIT dataChanged(index(0, 0, frame), index(rowCount(frame) - 1, kColumns - 1, frame));
  }
}

QModelIndex DrawModel::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || row >= rowCount(parent)) return {};
  return createIndex(row, column, parent.isValid() ? static_cast<quintptr>(parent.row()) : kFrameRow);
}

QModelIndex DrawModel::parent(const QModelIndex& child) const {
  if (!child.isValid() || child.internalId() == kFrameRow) return {};
  return createIndex(static_cast<int>(child.internalId()), 0, kFrameRow);
}

int DrawModel::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return static_cast<int>(frames_.size());
  if (parent.internalId() != kFrameRow || parent.column() > 0) return 0;
  return static_cast<int>(frames_[static_cast<std::size_t>(parent.row())].count);
}

const DrawEntry* DrawModel::drawAt(const QModelIndex& index) const {
  if (!index.isValid() || index.internalId() == kFrameRow) return nullptr;
  return &draws_[frames_[index.internalId()].first + index.row()];
}

QModelIndex DrawModel::indexOf(std::uint64_t frame, std::uint64_t draw) const {
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (frames_[f].number != frame) continue;
    for (qsizetype i = 0; i < frames_[f].count; ++i)
      if (draws_[frames_[f].first + i].stop.draw == draw) return createIndex(static_cast<int>(i), 0, f);
  }
  return {};
}

bool DrawModel::isHere(const DrawEntry& entry) const {
  return debugger_.stop() && debugger_.stop()->draw.stop.frame == entry.stop.frame &&
         debugger_.stop()->draw.stop.draw == entry.stop.draw;
}

QVariant DrawModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const DrawEntry* entry = drawAt(index);
  if (entry == nullptr) {
    const Frame& frame = frames_[static_cast<std::size_t>(index.row())];
    if (role == Qt::DisplayRole && index.column() == kDraw)
      return frame.count == 1 ? tr("Frame %1, one draw seen").arg(frame.number)
                              : tr("Frame %1, %2 draws seen").arg(frame.number).arg(frame.count);
    if (role == Qt::ForegroundRole) return theme().faint;
    return {};
  }
  if (role == Qt::DisplayRole) {
    switch (index.column()) {
      case kDraw:
        return QString::number(entry->stop.draw);
      case kCall:
        return QString::fromStdString(entry->stop.call);
      case kCount: {
        QString text = entry->stop.count < 0 ? QString("?") : QString::number(entry->stop.count);
        if (entry->stop.mode != 0xffffffffU)
          text += " " + QString::fromStdString(session::primitiveModeName(entry->stop.mode)).mid(3).toLower();
        if (entry->stop.instances >= 0 && entry->stop.instances != 1)
          text += QString(" × %1").arg(entry->stop.instances);
        return text;
      }
      case kProgram:
        return entry->program == 0 ? QString("-") : QString::number(entry->program);
      default:
        return tr("%1: %2 × %3").arg(entry->framebuffer).arg(entry->viewport[2]).arg(entry->viewport[3]);
    }
  }
  if (role == Qt::DecorationRole && index.column() == kDraw) {
    if (!entry->thumbnail.isNull()) return QIcon(QPixmap::fromImage(entry->thumbnail));
    if (isHere(*entry)) return icon("start");
  }
  if (role == Qt::FontRole && isHere(*entry)) {
    QFont font;
    font.setBold(true);
    return font;
  }
  if (role == Qt::ForegroundRole && !entry->reason.empty()) return theme().faint;
  if (role == Qt::ToolTipRole)
    return entry->reason.empty()
               ? tr("%1. Double-click to go there").arg(QString::fromStdString(entry->stop.call))
               : QString::fromStdString(entry->reason);
  return {};
}

QVariant DrawModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  static const char* const kNames[] = {"Draw", "Call", "Vertices", "Program", "Target"};
  return tr(kNames[section]);
}

}  // namespace shadestep::gui
