// What to start: the program, its arguments, environment and folder, and the draw to stop at first.
#pragma once

#include <QComboBox>
#include <QDialog>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QSpinBox>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {

class StartDialog : public QDialog {
  Q_OBJECT
 public:
  explicit StartDialog(const ProgramSpec&, QWidget* parent = nullptr);
  ProgramSpec spec() const;

  // The last one first; each with its arguments, environment and folder.
  static QList<ProgramSpec> recent();
  static void remember(const ProgramSpec&);

 private:
  void browse(bool program);
  void fill(const ProgramSpec&);

  QComboBox* command_;
  QLineEdit* directory_;
  QPlainTextEdit* environment_;
  QSpinBox *frame_, *draw_;
};

// A command line that splits into these words again.
QString commandLine(const QStringList& words);

}  // namespace shadestep::gui
