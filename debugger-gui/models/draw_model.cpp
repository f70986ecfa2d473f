#include "debugger-gui/models/draw_model.h"

#include <QFont>
#include <algorithm>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {
constexpr quintptr kFrameRow = ~quintptr(0);  // internal id of frames; a draw's is its frame's row
}

DrawModel::DrawModel(const Debugger& debugger, QObject* parent)
    : QAbstractItemModel(parent), debugger_(debugger) {}

bool DrawModel::refresh() {
  std::vector<Frame> frames;
  for (const DrawEntry& draw : debugger_.draws()) {
    const std::uint64_t number = draw.stop.frame;
    if (frames.empty() || frames.back().number != number)
      frames.push_back({number, debugger_.listed().value(number).more, {}});
    frames.back().draws.push_back(draw);
  }
  const bool grown = std::equal(frames_.begin(), frames_.end(), frames.begin(), frames.end(),
                                [](const Frame& a, const Frame& b) { return a.grows(b).has_value(); });
  if (!grown) {
    beginResetModel();
    frames_ = std::move(frames);
    endResetModel();
    return true;
  }
  for (int row = 0; row < static_cast<int>(frames.size()); ++row)
    grow(row, std::move(frames[static_cast<std::size_t>(row)]));
  return false;
}

// Draws come in at one place: behind which draw; nothing if `now` is no such successor.
std::optional<std::size_t> DrawModel::Frame::grows(const Frame& now) const {
  if (number != now.number || draws.size() > now.draws.size()) return std::nullopt;
  const auto same = [](const DrawEntry& a, const DrawEntry& b) { return a.stop.draw == b.stop.draw; };
  const auto behind = std::mismatch(draws.begin(), draws.end(), now.draws.begin(), same).first;
  const auto rest = draws.end() - behind;
  if (!std::equal(behind, draws.end(), now.draws.end() - rest, same)) return std::nullopt;
  return static_cast<std::size_t>(behind - draws.begin());
}

void DrawModel::grow(int row, Frame&& now) {
  Frame& frame = frames_[static_cast<std::size_t>(row)];
  const QModelIndex above = index(row, 0);
  const auto first = static_cast<int>(*frame.grows(now));
  const auto added = static_cast<int>(now.draws.size() - frame.draws.size());
  if (added > 0) beginInsertRows(above, first, first + added - 1);
  frame = std::move(now);
  if (added > 0) endInsertRows();
  Q_EMIT dataChanged(above, above);
  Q_EMIT dataChanged(index(0, 0, above), index(rowCount(above) - 1, kColumns - 1, above));
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
  return static_cast<int>(frames_[static_cast<std::size_t>(parent.row())].draws.size());
}

const DrawEntry* DrawModel::drawAt(const QModelIndex& index) const {
  if (!index.isValid() || index.internalId() == kFrameRow) return nullptr;
  return &frames_[index.internalId()].draws[static_cast<std::size_t>(index.row())];
}

QModelIndex DrawModel::indexOf(std::uint64_t frame, std::uint64_t draw) const {
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (frames_[f].number != frame) continue;
    for (std::size_t i = 0; i < frames_[f].draws.size(); ++i)
      if (frames_[f].draws[i].stop.draw == draw) return createIndex(static_cast<int>(i), 0, f);
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
    if (role == Qt::DisplayRole && index.column() == kDraw) {
      const QString seen = frame.draws.size() == 1
                               ? tr("Frame %1, one draw seen").arg(frame.number)
                               : tr("Frame %1, %2 draws seen").arg(frame.number).arg(frame.draws.size());
      return frame.more ? tr("%1, more to list").arg(seen) : seen;
    }
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
