#include "debugger-gui/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QFile>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QSettings>
#include <QStatusBar>
#include <QVBoxLayout>

#include "debugger-gui/start_dialog.h"
#include "debugger-gui/style/icons.h"
#include "session/text.h"
#include "session/values.h"

namespace shadestep::gui {

MainWindow::MainWindow()
    : sources_(new QTabWidget),
      picture_(new PicturePanel(debugger_)),
      variables_(new VariablesPanel(debugger_)),
      stack_(new StackPanel(debugger_)),
      notice_(new QFrame),
      notice_text_(new QLabel),
      state_(new QLabel),
      driver_(new QLabel),
      busy_(new QLabel),
      progress_(new QProgressBar),
      cancel_(new QToolButton),
      check_(new CheckBadge) {
  setWindowTitle("shadestep");
  setWindowIcon(icon("app"));
  setDockNestingEnabled(true);
  resize(1280, 800);

  auto* middle = new QWidget;
  auto* column = new QVBoxLayout(middle);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  auto* row = new QHBoxLayout(notice_);
  row->setContentsMargins(10, 5, 6, 5);
  notice_text_->setWordWrap(true);
  notice_text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* close_notice = new QToolButton;
  close_notice->setIcon(icon("remove"));
  close_notice->setAutoRaise(true);
  close_notice->setAccessibleName(tr("Close this message"));
  connect(close_notice, &QToolButton::clicked, notice_, &QWidget::hide);
  row->addWidget(notice_text_, 1);
  row->addWidget(close_notice, 0, Qt::AlignTop);
  notice_->hide();
  notice_timer_.setSingleShot(true);
  connect(&notice_timer_, &QTimer::timeout, notice_, &QWidget::hide);
  sources_->setDocumentMode(true);
  column->addWidget(notice_);
  column->addWidget(sources_, 1);
  setCentralWidget(middle);

  makeActions();
  makeDocks();
  makeMenus();
  makeToolBar();
  makeStatus();
  connectDebugger();
  first_layout_ = saveState();
  QSettings settings;
  restoreGeometry(settings.value("geometry").toByteArray());
  restoreState(settings.value("layout").toByteArray());
  refreshActions();
  refreshSources();
}

// The panels know the debugger, and go first.
MainWindow::~MainWindow() {
  debugger_.disconnect();
  debugger_.backend().disconnect(this);
  qDeleteAll(docks_);
  delete takeCentralWidget();
}

void MainWindow::connectDebugger() {
  connect(&debugger_, &Debugger::stopChanged, this, &MainWindow::refreshSources);
  connect(&debugger_, &Debugger::placeChanged, this, &MainWindow::refreshPlace);
  connect(&debugger_, &Debugger::profileChanged, this, &MainWindow::refreshCosts);
  connect(&debugger_, &Debugger::valuesChanged, this, [this] { check_->setCheck(debugger_.check()); });
  connect(&debugger_, &Debugger::breakpointsChanged, this, [this] {
    if (SourceView* view = source()) view->setBreakpoints(debugger_.breakpoints());
  });
  for (const auto signal : {&Debugger::programChanged, &Debugger::placeChanged, &Debugger::runChanged})
    connect(&debugger_, signal, this, &MainWindow::refreshActions);
  connect(&debugger_, &Debugger::message, this, &MainWindow::showMessage);
  connect(stack_, &StackPanel::lineChosen, this, [this](int line) {
    if (SourceView* view = source()) view->ensureLineVisible(line - 1);
  });
  Backend& backend = debugger_.backend();
  connect(&backend, &Backend::started, this, [this](const QString& what) {
    busy_->setText(what + "...");
    progress_->setRange(0, 0);
    progress_->setVisible(true);
    cancel_->setVisible(true);
  });
  connect(&backend, &Backend::progress, this, [this](double share) {
    progress_->setRange(0, 1000);
    progress_->setValue(static_cast<int>(1000 * share));
  });
  connect(&backend, &Backend::becameIdle, this, [this] {
    busy_->clear();
    progress_->hide();
    cancel_->hide();
  });
}

void MainWindow::start(const ProgramSpec& spec) {
  StartDialog::remember(spec);
  notice_->hide();
  debugger_.start(spec);
}

void MainWindow::askForProgram() {
  auto* dialog = new StartDialog(debugger_.spec(), this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QDialog::accepted, this, [this, dialog] { start(dialog->spec()); });
  dialog->open();
}

void MainWindow::openSession(const QString& file) {
  QFile stored(file);
  if (!stored.open(QIODevice::ReadOnly)) return showMessage(tr("Cannot read %1").arg(file), true);
  try {
    debugger_.restore(stored.readAll());
  } catch (const session::Error& error) {
    showMessage(tr("%1: %2").arg(file, QString::fromUtf8(error.what())), true);
  }
}

void MainWindow::saveSession() {
  auto* dialog =
      new QFileDialog(this, tr("Save the session"), "session.shadestep", tr("Session (*.shadestep)"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
    QFile stored(file);
    const QByteArray bytes = debugger_.saved();
    const bool written = stored.open(QIODevice::WriteOnly) && stored.write(bytes) == bytes.size();
    showMessage(written ? tr("Wrote %1").arg(file) : tr("Cannot write %1").arg(file), !written);
  });
  dialog->open();
}

// ---- the source

SourceView* MainWindow::source() const {
  return views_.value(session::Stage::fragment);
}

void MainWindow::refreshSources() {
  const auto& stop = debugger_.stop();
  if (!stop) {
    if (SourceView* view = source()) view->setCurrent(0, false);
    return;
  }
  // A tab per stage that the draw has; those that were there stay as they are.
  for (const session::Stage stage : views_.keys()) {
    const bool there = std::any_of(stop->stages.begin(), stop->stages.end(),
                                   [stage](const StageSource& one) { return one.stage == stage; });
    if (there) continue;
    delete views_.take(stage);
  }
  for (const StageSource& one : stop->stages) {
    SourceView*& view = views_[one.stage];
    if (view == nullptr) {
      view = new SourceView;
      view->setDescriber([this](const QString& expression) { return describeExpression(expression); });
      connect(view, &SourceView::breakpointToggled, &debugger_, &Debugger::toggleBreakpoint);
      connect(view, &SourceView::breakpointEdited, this, &MainWindow::editBreakpoint);
      connect(view, &SourceView::runToLineAsked, &debugger_, &Debugger::toLine);
      connect(view, &SourceView::watchAsked, &debugger_, &Debugger::addWatch);
      connect(view, &SourceView::pictureAsked, &debugger_, [this](const QString& expression) {
        debugger_.show({PictureSource::Kind::value, expression, 0});
      });
      sources_->addTab(view, QString::fromUtf8(session::stageName(one.stage)));
    }
    view->setSource(one);
    const int tab = sources_->indexOf(view);
    sources_->setTabToolTip(tab, QString::fromStdString(one.reason));
  }
  if (SourceView* view = source()) {
    sources_->setCurrentWidget(view);
    view->setBreakpoints(debugger_.breakpoints());
  }
  driver_->setText(QString::fromStdString(stop->facts.renderer + ", GLSL " + stop->facts.glsl_version));
  refreshCosts();
}

void MainWindow::refreshPlace() {
  SourceView* view = source();
  const auto& place = debugger_.place();
  if (view == nullptr) return;
  view->setCurrent(place && !place->ended ? place->line : 0, place && !place->sides.empty());
}

void MainWindow::refreshCosts() {
  SourceView* view = source();
  const ProfilePtr& profile = debugger_.profile();
  if (view == nullptr) return;
  const bool fits = debugger_.profileIsOfThisDraw() && profile->source == view->source().lines;
  view->setCosts(fits ? profile->profile.lines : std::vector<profiler::LineCost>());
}

QString MainWindow::describeExpression(const QString& expression) const {
  const LookPtr& look = debugger_.values();
  if (!look) return {};
  QString variable = expression;
  while (!variable.isEmpty()) {
    for (std::size_t i = 0; i < look->threads.values.size(); ++i) {
      const session::WatchedValues& value = look->threads.values[i];
      if (QString::fromStdString(value.name) != variable) continue;
      QStringList lines{QString("<b>%1</b>&nbsp; %2")
                            .arg(variable, QString::fromStdString(frontend::glslName(value.type)))};
      if (const auto& pixel = debugger_.pixel();
          pixel && pixel->x < look->threads.width && pixel->y < look->threads.height) {
        const std::size_t p =
            static_cast<std::size_t>(pixel->y) * static_cast<std::size_t>(look->threads.width) +
            static_cast<std::size_t>(pixel->x);
        lines.push_back(look->threads.reachedAt(p)
                            ? QString::fromStdString(session::formatValue(value.valueAt(p))).toHtmlEscaped()
                            : tr("the picked thread does not get here"));
      }
      return lines.join("<br>");
    }
    const qsizetype cut = std::max(variable.lastIndexOf('.'), variable.lastIndexOf('['));
    if (cut < 0) return {};
    variable.truncate(cut);
  }
  return {};
}

void MainWindow::editBreakpoint(int line) {
  const Breakpoint before = debugger_.breakpoints().value(line);
  auto* dialog = new QInputDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Breakpoint at line %1").arg(line));
  dialog->setLabelText(tr("Stop the picked thread here only if (such as: dst.a > 0.9; empty: always)"));
  dialog->setTextValue(before.condition);
  connect(dialog, &QInputDialog::textValueSelected, this, [this, line, before](const QString& condition) {
    Breakpoint after = before;
    after.condition = condition.trimmed();
    debugger_.setBreakpoint(line, after);
  });
  dialog->open();
}

// ---- the rest of the window

void MainWindow::showMessage(const QString& sentence, bool is_error) {
  notice_text_->setText(sentence);
  const QColor edge = is_error ? theme().bad : theme().accent;
  notice_->setStyleSheet(QString("QFrame { background: %1; border: 0; border-left: 3px solid %2; }"
                                 "QLabel { border: 0; color: %3; }")
                             .arg(theme().panel.name(), edge.name(), theme().text.name()));
  notice_->show();
  // What went well needs no answer.
  if (is_error) return notice_timer_.stop();
  constexpr int kShownMs = 6000;
  notice_timer_.start(kShownMs);
}

void MainWindow::setTheme(ThemeChoice choice) {
  applyTheme(*static_cast<QApplication*>(QApplication::instance()), choice);
  QSettings().setValue("theme", static_cast<int>(choice));
  for (SourceView* view : views_) view->applyTheme();
  notice_->hide();
  refreshSources();
  refreshPlace();
  check_->setCheck(debugger_.check());
  Q_EMIT debugger_.valuesChanged();  // pictures and marks take the new colours
}

void MainWindow::resetLayout() {
  restoreState(first_layout_);
}

void MainWindow::closeEvent(QCloseEvent* event) {
  QSettings settings;
  settings.setValue("geometry", saveGeometry());
  settings.setValue("layout", saveState());
  event->accept();
}

}  // namespace shadestep::gui
