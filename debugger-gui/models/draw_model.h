// Frames, their draws, as far as they have been visited, the calls that led to each, and those behind the
// last.
#pragma once

#include <QAbstractItemModel>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class DrawModel : public QAbstractItemModel {
  Q_OBJECT
 public:
  enum Column { kDraw, kCall, kCount, kProgram, kTarget, kColumns };
  static constexpr int kSearched = Qt::UserRole;  // the text, where it is of the program

  explicit DrawModel(const Debugger&, QObject* parent = nullptr);
  // True: anew, as it can be asked for; false: rows were added to the frames at most.
  bool refresh(bool anew);

  const DrawEntry* drawAt(const QModelIndex&) const;
  // The draw that it leads to; null for what is no call, or behind the last draw. Row 0 of a draw whose calls
  // are not known says so.
  const DrawEntry* drawOfCall(const QModelIndex&) const;
  bool isCall(const QModelIndex&) const;
  QModelIndex indexOf(std::uint64_t frame, std::uint64_t draw) const;

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex&) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex&, int role) const override;
  QVariant headerData(int section, Qt::Orientation, int role) const override;

 private:
  struct Frame {
    std::uint64_t number = 0;
    bool more = false;             // it has draws that are not listed
    std::vector<DrawEntry> draws;  // behind them, if it is known, one for the frame's end
    std::optional<std::size_t> grows(const Frame& now) const;
  };
  void grow(int row, Frame&& now);
  void takeCalls(int frame, Frame& now);
  const DrawEntry* entryAt(const QModelIndex&) const;  // a draw, or the frame's end
  const DrawEntry* entryOfCall(const QModelIndex&) const;
  QVariant frameData(const Frame&, int column, int role) const;
  QVariant endData(const DrawEntry&, int column, int role) const;
  QVariant callData(const DrawEntry&, int row, int role) const;
  bool isHere(const DrawEntry&) const;

  const Debugger& debugger_;
  std::vector<Frame> frames_;
};

}  // namespace shadestep::gui
