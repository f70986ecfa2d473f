// The GL state, the textures and the buffers at the stopped draw, and which fragment tests the debugger's
// replays use (thesis 7.1.3).
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLineEdit>
#include <QSpinBox>
#include <QTabWidget>
#include <QTreeWidget>

#include "debugger-gui/debugger.h"
#include "debugger-gui/panels/buffers_page.h"

namespace shadestep::gui {

class StatePanel : public QWidget {
  Q_OBJECT
 public:
  explicit StatePanel(Debugger&, QWidget* parent = nullptr);
  enum Tab { kState, kTextures, kBuffers, kTests };
  void showTab(Tab tab) { tabs_->setCurrentIndex(tab); }
  QTreeWidget& textures() { return *textures_; }
  BuffersPage& buffers() { return *buffers_; }

 protected:
  void showEvent(QShowEvent*) override;

 private:
  void refresh();
  void filter(const QString&);
  void chooseFragments();
  void ask();
  QWidget* makeTests();
  QWidget* makeTextures();
  void refreshTextures();
  void chooseTexture();
  void readTexture();

  Debugger& debugger_;
  QLineEdit* search_;
  QTreeWidget* tree_;
  QTabWidget* tabs_;
  QTreeWidget* textures_;
  QSpinBox *level_, *slice_;
  BuffersPage* buffers_;
  QComboBox *alpha_, *depth_, *stencil_, *blend_;
  QSpinBox *layer_, *sample_;
  QCheckBox* clear_;
};

}  // namespace shadestep::gui
