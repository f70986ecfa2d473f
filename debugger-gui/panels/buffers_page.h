// The buffers of the stopped draw: blocks, vertex attributes, indices and the rest, and what stands in the
// chosen one, by its members or in a format that the user chooses.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSpinBox>
#include <QTableView>
#include <QTreeWidget>

#include "debugger-gui/debugger.h"
#include "debugger-gui/models/buffer_model.h"
#include "debugger-gui/views/check_badge.h"

namespace shadestep::gui {

class BuffersPage : public QWidget {
  Q_OBJECT
 public:
  explicit BuffersPage(Debugger&, QWidget* parent = nullptr);

  void ask();  // what there is, if it is not known yet
  QTreeWidget& list() { return *list_; }
  QTableView& contents() { return *contents_; }
  QComboBox& format() { return *format_; }
  QSpinBox& components() { return *components_; }
  QSpinBox& stride() { return *stride_; }

 private:
  void refresh();
  void choose();
  void arrived();
  void takeFormat();
  void refreshCheck();
  const session::BoundBuffer* chosen() const;

  Debugger& debugger_;
  BufferModel model_;
  QTreeWidget* list_;
  QTableView* contents_;
  QComboBox* format_;
  QSpinBox *components_, *stride_;
  QCheckBox* normalized_;
  QLabel* note_;
  CheckBadge* check_;
};

}  // namespace shadestep::gui
