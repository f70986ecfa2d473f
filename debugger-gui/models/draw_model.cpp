#include "debugger-gui/models/draw_model.h"

#include <QFont>
#include <algorithm>
#include <tuple>

#include "debugger-gui/models/call_model.h"
#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {
// Internal ids: of frames this one, of draws their frame's row, of calls that and their draw's number, which
// stays what it is when draws come in before it.
constexpr quintptr kFrameRow = ~quintptr(0);
constexpr int kFrameBits = 24;
static_assert(sizeof(quintptr) == 8);

quintptr idOfCalls(quintptr frame, std::uint64_t draw) {
  return frame | (draw + 1) << kFrameBits;
}
quintptr frameOf(quintptr id) {
  return id & ((quintptr(1) << kFrameBits) - 1);
}
bool isOfCall(quintptr id) {
  return id != kFrameRow && id >> kFrameBits != 0;
}

// The frame's end stands behind its draws as if it was one: what is called before it is called behind the
// last draw.
constexpr std::uint64_t kEnd = (std::uint64_t(1) << (64 - kFrameBits)) - 2;
bool isEnd(const DrawEntry& entry) {
  return entry.stop.draw == kEnd;
}
DrawEntry endOf(std::uint64_t frame, const DrawCallsPtr& calls) {
  DrawEntry end;
  end.stop.frame = frame;
  end.stop.draw = kEnd;
  end.calls = calls;
  return end;
}

bool sameCalls(const DrawCallsPtr& a, const DrawCallsPtr& b) {
  if (!a || !b) return a == b;
  const auto parts = [](const session::LoggedCall& call) {
    return std::tie(call.name, call.arguments, call.result, call.error);
  };
  return a->left_out == b->left_out &&
         std::equal(a->calls.begin(), a->calls.end(), b->calls.begin(), b->calls.end(),
                    [&](const auto& one, const auto& other) { return parts(one) == parts(other); });
}

int rowsUnder(const DrawEntry& draw) {
  if (!draw.calls) return 1;
  return static_cast<int>(draw.calls->calls.size()) + (draw.calls->left_out > 0 ? 1 : 0);
}

QString wholeText(const session::LoggedCall& call) {
  QString text = callText(call);
  if (!call.result.empty()) text += " = " + QString::fromStdString(call.result);
  if (call.error != 0) text += ": " + QString::fromStdString(session::errorName(call.error));
  return text;
}
}  // namespace

DrawModel::DrawModel(const Debugger& debugger, QObject* parent)
    : QAbstractItemModel(parent), debugger_(debugger) {}

bool DrawModel::refresh(bool anew) {
  std::vector<Frame> frames;
  for (const DrawEntry& draw : debugger_.draws()) {
    const std::uint64_t number = draw.stop.frame;
    if (frames.empty() || frames.back().number != number)
      frames.push_back({number, debugger_.listed().value(number).more, {}});
    frames.back().draws.push_back(draw);
  }
  for (Frame& frame : frames)
    if (const DrawCallsPtr behind = debugger_.listed().value(frame.number).behind;
        behind && !behind->calls.empty())
      frame.draws.push_back(endOf(frame.number, behind));
  const bool grown = std::equal(frames_.begin(), frames_.end(), frames.begin(), frames.end(),
                                [](const Frame& a, const Frame& b) { return a.grows(b).has_value(); });
  if (anew || !grown) {
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
  takeCalls(row, now);
  const auto first = static_cast<int>(*frame.grows(now));
  const auto added = static_cast<int>(now.draws.size() - frame.draws.size());
  if (added > 0) beginInsertRows(above, first, first + added - 1);
  frame = std::move(now);
  if (added > 0) endInsertRows();
  Q_EMIT dataChanged(above, above);
  Q_EMIT dataChanged(index(0, 0, above), index(rowCount(above) - 1, kColumns - 1, above));
}

// What led to the draws that are there already, where it was not known or is other than before.
void DrawModel::takeCalls(int row, Frame& now) {
  Frame& frame = frames_[static_cast<std::size_t>(row)];
  auto next = now.draws.begin();
  for (std::size_t i = 0; i < frame.draws.size(); ++i) {
    DrawEntry& draw = frame.draws[i];
    while (next->stop.draw != draw.stop.draw) ++next;
    if (sameCalls(next->calls, draw.calls)) continue;
    const QModelIndex above = index(static_cast<int>(i), 0, index(row, 0));
    if (const int rows = rowsUnder(draw); rows > 0) {
      beginRemoveRows(above, 0, rows - 1);
      draw.calls = std::make_shared<const DrawCalls>();
      endRemoveRows();
    }
    const int rows = rowsUnder(*next);
    if (rows > 0) beginInsertRows(above, 0, rows - 1);
    draw.calls = next->calls;
    if (rows > 0) endInsertRows();
  }
}

QModelIndex DrawModel::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || row >= rowCount(parent)) return {};
  if (!parent.isValid()) return createIndex(row, column, kFrameRow);
  const DrawEntry* draw = entryAt(parent);
  return createIndex(row, column,
                     draw == nullptr ? static_cast<quintptr>(parent.row())
                                     : idOfCalls(parent.internalId(), draw->stop.draw));
}

QModelIndex DrawModel::parent(const QModelIndex& child) const {
  if (!child.isValid() || child.internalId() == kFrameRow) return {};
  const quintptr frame = frameOf(child.internalId());
  if (const DrawEntry* draw = entryOfCall(child))
    return createIndex(static_cast<int>(draw - frames_[frame].draws.data()), 0, frame);
  return createIndex(static_cast<int>(frame), 0, kFrameRow);
}

int DrawModel::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return static_cast<int>(frames_.size());
  if (parent.column() > 0 || isOfCall(parent.internalId())) return 0;
  if (const DrawEntry* draw = entryAt(parent)) return rowsUnder(*draw);
  return static_cast<int>(frames_[static_cast<std::size_t>(parent.row())].draws.size());
}

const DrawEntry* DrawModel::entryAt(const QModelIndex& index) const {
  if (!index.isValid() || index.internalId() == kFrameRow || isOfCall(index.internalId())) return nullptr;
  return &frames_[index.internalId()].draws[static_cast<std::size_t>(index.row())];
}

const DrawEntry* DrawModel::drawAt(const QModelIndex& index) const {
  const DrawEntry* entry = entryAt(index);
  return entry == nullptr || isEnd(*entry) ? nullptr : entry;
}

const DrawEntry* DrawModel::entryOfCall(const QModelIndex& index) const {
  if (!index.isValid() || !isOfCall(index.internalId())) return nullptr;
  const std::uint64_t number = (index.internalId() >> kFrameBits) - 1;
  const auto& draws = frames_[frameOf(index.internalId())].draws;
  const auto at = std::lower_bound(draws.begin(), draws.end(), number,
                                   [](const DrawEntry& one, std::uint64_t n) { return one.stop.draw < n; });
  return at == draws.end() ? nullptr : &*at;
}

const DrawEntry* DrawModel::drawOfCall(const QModelIndex& index) const {
  const DrawEntry* entry = entryOfCall(index);
  return entry == nullptr || isEnd(*entry) ? nullptr : entry;
}

bool DrawModel::isCall(const QModelIndex& index) const {
  const DrawEntry* entry = entryOfCall(index);
  return entry != nullptr && entry->calls && index.row() < static_cast<int>(entry->calls->calls.size());
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

QVariant DrawModel::callData(const DrawEntry& draw, int row, int role) const {
  const bool known = draw.calls != nullptr;
  const bool is_call = known && row < static_cast<int>(draw.calls->calls.size());
  // Drawn across the columns, it makes none of them wider.
  if (role == Qt::SizeHintRole) return QSize(0, 0);
  if (role == Qt::ForegroundRole) {
    const bool is_error = is_call && draw.calls->calls[static_cast<std::size_t>(row)].error != 0;
    return is_error ? theme().bad : is_call ? theme().text : theme().faint;
  }
  if (role == Qt::FontRole && is_call) return monospaced();
  if (role != Qt::DisplayRole && role != Qt::ToolTipRole && (role != kSearched || !is_call)) return {};
  if (is_call) return wholeText(draw.calls->calls[static_cast<std::size_t>(row)]);
  if (known) return tr("%1 more calls, too many to keep").arg(draw.calls->left_out);
  return tr("Double-click to list the calls before it");
}

QVariant DrawModel::frameData(const Frame& frame, int column, int role) const {
  if (role == Qt::ForegroundRole) return theme().faint;
  if (role != Qt::DisplayRole || column != kDraw) return {};
  const std::size_t draws = frame.draws.size() - (isEnd(frame.draws.back()) ? 1 : 0);
  const QString seen = draws == 1 ? tr("Frame %1, one draw seen").arg(frame.number)
                                  : tr("Frame %1, %2 draws seen")
                                        .arg(QString::number(frame.number),
                                             QString::fromStdString(session::withThousands(draws)));
  return frame.more ? tr("%1, more to list").arg(seen) : seen;
}

QVariant DrawModel::endData(const DrawEntry& end, int column, int role) const {
  if (role == Qt::ForegroundRole) return theme().faint;
  if (role == Qt::ToolTipRole) return tr("What is called behind the last draw of the frame");
  if (role != Qt::DisplayRole) return {};
  const std::uint64_t calls = end.calls->calls.size() + end.calls->left_out;
  return column == kDraw   ? tr("end")
         : column == kCall ? tr("%1 calls").arg(QString::fromStdString(session::withThousands(calls)))
                           : QVariant();
}

QVariant DrawModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  if (const DrawEntry* draw = entryOfCall(index))
    return index.column() == kDraw ? callData(*draw, index.row(), role) : QVariant();
  const DrawEntry* entry = entryAt(index);
  if (entry != nullptr && isEnd(*entry)) return endData(*entry, index.column(), role);
  if (role == kSearched) role = Qt::DisplayRole;
  if (entry == nullptr)
    return frameData(frames_[static_cast<std::size_t>(index.row())], index.column(), role);
  if (role == Qt::DisplayRole) {
    switch (index.column()) {
      case kDraw:
        return QString::number(entry->stop.draw);
      case kCall:
        return QString::fromStdString(entry->stop.call);
      case kCount: {
        const bool primitives = entry->stop.mode != 0xffffffffU;
        if (!primitives && entry->stop.count < 0) return {};  // a dispatch
        QString text = entry->stop.count < 0 ? QString("?")
                                             : QString::fromStdString(session::withThousands(
                                                   static_cast<std::uint64_t>(entry->stop.count)));
        if (primitives)
          text += " " + QString::fromStdString(session::primitiveModeName(entry->stop.mode))
                            .mid(3)
                            .toLower()
                            .replace('_', ' ');
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
    if (!entry->thumbnail.isNull()) {
      const QPixmap picture = QPixmap::fromImage(entry->thumbnail);
      QIcon shown(picture);
      shown.addPixmap(picture, QIcon::Selected);  // else it is tinted there: other colours than the draw's
      return shown;
    }
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
               ? tr("%1 by program %2 into framebuffer %3, %4 × %5. Double-click to go there")
                     .arg(QString::fromStdString(entry->stop.call))
                     .arg(entry->program)
                     .arg(entry->framebuffer)
                     .arg(entry->viewport[2])
                     .arg(entry->viewport[3])
               : QString::fromStdString(entry->reason);
  return {};
}

QVariant DrawModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  static const char* const kNames[] = {"Draw", "Call", "Vertices", "Program", "Target"};
  return tr(kNames[section]);
}

}  // namespace shadestep::gui
