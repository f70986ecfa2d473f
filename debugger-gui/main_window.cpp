#include "debugger-gui/main_window.h"

#include <QApplication>
#include <QCloseEvent>
#include <QFile>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QSettings>
#include <QStatusBar>
#include <QVBoxLayout>

#include "debugger-gui/start_dialog.h"
#include "debugger-gui/style/icons.h"

namespace shadestep::gui {

namespace {

// "GLSL 4.50", "GLSL ES 3.20": OpenGL ES says "OpenGL ES GLSL ES 3.20" itself, and some more behind it.
QString languageOf(const session::DrawFacts& facts) {
  const QString version = QString::fromStdString(facts.glsl_version);
  return facts.es ? "GLSL ES " + version.section("ES ", -1).section(' ', 0, 0) : "GLSL " + version;
}

}  // namespace

MainWindow::MainWindow()
    : sources_(new SourceTabs(debugger_)),
      picture_(new PicturePanel(debugger_)),
      variables_(new VariablesPanel(debugger_)),
      stack_(new StackPanel(debugger_)),
      threads_(new ThreadsPanel(debugger_)),
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
  // What is quick does not flicker.
  constexpr int kSoonMs = 150;
  busy_later_.setSingleShot(true);
  busy_later_.setInterval(kSoonMs);
  connect(&busy_later_, &QTimer::timeout, this, [this] {
    busy_->show();
    progress_->show();
    cancel_->show();
  });
  notice_timer_.setSingleShot(true);
  connect(&notice_timer_, &QTimer::timeout, notice_, &QWidget::hide);
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
}

// The panels know the debugger, and go first.
MainWindow::~MainWindow() {
  debugger_.disconnect();
  debugger_.backend().disconnect(this);
  qDeleteAll(docks_);
  delete takeCentralWidget();
}

void MainWindow::connectDebugger() {
  connect(&debugger_, &Debugger::stopChanged, this, [this] {
    if (const auto& stop = debugger_.stop())
      driver_->setText(QString::fromStdString(stop->facts.renderer) + ", " + languageOf(stop->facts));
    check_->setCheck(debugger_.check());  // those of the stop before are gone
  });
  connect(&debugger_, &Debugger::valuesChanged, this, [this] { check_->setCheck(debugger_.check()); });
  for (const auto signal : {&Debugger::programChanged, &Debugger::placeChanged, &Debugger::runChanged})
    connect(&debugger_, signal, this, &MainWindow::refreshActions);
  connect(&debugger_, &Debugger::message, this, &MainWindow::showMessage);
  connect(stack_, &StackPanel::lineChosen, sources_, &SourceTabs::showLine);
  Backend& backend = debugger_.backend();
  connect(&backend, &Backend::started, this, [this](const QString& what) {
    busy_->setText(what + "...");
    progress_->setRange(0, 0);
    if (!cancel_->isVisible()) busy_later_.start();
  });
  connect(&backend, &Backend::progress, this, [this](double share) {
    progress_->setRange(0, 1000);
    progress_->setValue(static_cast<int>(1000 * share));
  });
  connect(&backend, &Backend::counted, this, [this, &backend](qulonglong done) {
    busy_->setText(tr("%1: %2").arg(backend.current()).arg(done));
  });
  connect(&backend, &Backend::becameIdle, this, [this] {
    busy_later_.stop();
    busy_->hide();
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
  dialog->show();
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
  dialog->show();
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
  sources_->applyTheme();
  notice_->hide();
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
