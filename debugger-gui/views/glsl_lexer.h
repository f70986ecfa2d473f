// GLSL's words for the source view.
#pragma once

#include "debugger-gui/views/qsci.h"

namespace shadestep::gui {

class GlslLexer : public QsciLexerCPP {
  Q_OBJECT
 public:
  explicit GlslLexer(QObject* parent);
  const char* language() const override { return "GLSL"; }
  const char* keywords(int set) const override;
  void applyTheme();
};

}  // namespace shadestep::gui
