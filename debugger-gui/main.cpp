// shadestep-gui [--session FILE] [--frame N] [--draw N] [-- PROGRAM ARGS...]: the window; `shadestep gui`
// starts it.
#include <QApplication>
#include <QSettings>
#include <QTextStream>
#include <QTimer>
#include <csignal>

#include "debugger-gui/main_window.h"

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  // Everything after the first "--" belongs to the program under debug: Qt must not read it.
  QStringList words;
  int own = argc;
  for (int i = 1; i < argc; ++i) {
    if (own == argc && std::string_view(argv[i]) == "--") own = i;
    if (own < i) words.push_back(QString::fromLocal8Bit(argv[i]));
  }
  int own_count = own;
  QApplication application(own_count, argv);
  QApplication::setOrganizationName("shadestep");
  QApplication::setApplicationName("shadestep");

  using namespace shadestep::gui;
  ProgramSpec spec;
  spec.command = words;
  QString session_file;
  const QStringList arguments = QApplication::arguments();
  for (qsizetype i = 1; i < arguments.size(); ++i) {
    const bool has_value = i + 1 < arguments.size();
    bool is_number = true;
    if (arguments[i] == "--session" && has_value) {
      session_file = arguments[++i];
    } else if (arguments[i] == "--frame" && has_value) {
      spec.frame = arguments[++i].toULongLong(&is_number);
    } else if (arguments[i] == "--draw" && has_value) {
      spec.draw = arguments[++i].toULongLong(&is_number);
    } else {
      is_number = false;
    }
    if (!is_number) {
      QTextStream(stderr) << "shadestep-gui: '" << arguments[i]
                          << "' is not understood; shadestep-gui [--session FILE] [--frame N] [--draw N] "
                             "[-- PROGRAM ARGS...]\n";
      return static_cast<int>(shadestep::session::Outcome::usage);
    }
  }

  applyTheme(application, static_cast<ThemeChoice>(QSettings().value("theme").toInt()));
  MainWindow window;
  window.show();
  QTimer::singleShot(0, &window, [&] {
    if (!session_file.isEmpty()) {
      window.openSession(session_file);
    } else if (!spec.command.isEmpty()) {
      window.start(spec);
    } else {
      window.askForProgram();
    }
  });
  return QApplication::exec();
}
