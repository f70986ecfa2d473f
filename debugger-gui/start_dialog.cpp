#include "debugger-gui/start_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QSettings>
#include <QToolButton>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {
constexpr int kRecent = 12;
constexpr const char* kRecentKey = "recent programs";
}  // namespace

QString commandLine(const QStringList& words) {
  QStringList quoted;
  for (QString word : words) {
    const bool plain = !word.isEmpty() && !word.contains(' ') && !word.contains('"');
    word.replace('"', R"(""")");
    quoted.push_back(plain ? word : '"' + word + '"');
  }
  return quoted.join(' ');
}

StartDialog::StartDialog(const ProgramSpec& spec, QWidget* parent)
    : QDialog(parent),
      command_(new QComboBox),
      directory_(new QLineEdit(spec.directory)),
      environment_(new QPlainTextEdit(spec.environment.join('\n'))),
      frame_(new QSpinBox),
      draw_(new QSpinBox) {
  setWindowTitle(tr("Run a program"));
  command_->setEditable(true);
  command_->setMinimumWidth(460);
  command_->setInsertPolicy(QComboBox::NoInsert);
  command_->addItems(recent());
  command_->setCurrentText(spec.command.isEmpty() ? recent().value(0) : commandLine(spec.command));
  command_->lineEdit()->setPlaceholderText(tr("program and its arguments, as in a shell"));
  command_->setFont(monospaced());
  directory_->setPlaceholderText(tr("the folder that shadestep was started in"));
  environment_->setPlaceholderText(tr("NAME=value, one a line; the rest is as it is"));
  environment_->setFont(monospaced());
  environment_->setMaximumHeight(76);
  for (QSpinBox* number : {frame_, draw_}) number->setRange(0, 100'000'000);
  frame_->setValue(static_cast<int>(spec.frame));
  draw_->setValue(static_cast<int>(spec.draw));

  const auto with_button = [this](QWidget* field, bool program) {
    auto* row = new QHBoxLayout;
    auto* browse_button = new QToolButton;
    browse_button->setIcon(icon("open"));
    browse_button->setToolTip(program ? tr("Choose a program") : tr("Choose a folder"));
    connect(browse_button, &QToolButton::clicked, this, [this, program] { browse(program); });
    row->addWidget(field, 1);
    row->addWidget(browse_button);
    return row;
  };
  auto* at = new QHBoxLayout;
  at->addWidget(new QLabel(tr("frame")));
  at->addWidget(frame_);
  at->addWidget(new QLabel(tr("draw")));
  at->addWidget(draw_);
  at->addStretch();
  auto* form = new QFormLayout(this);
  form->setContentsMargins(16, 16, 16, 12);
  form->setVerticalSpacing(10);
  form->addRow(tr("&Program"), with_button(command_, true));
  form->addRow(tr("&Folder"), with_button(directory_, false));
  form->addRow(tr("&Environment"), environment_);
  form->addRow(tr("&Stop first at"), at);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  auto* run = buttons->addButton(tr("Run"), QDialogButtonBox::AcceptRole);
  run->setDefault(true);
  form->addRow(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  const auto enable = [run, this] {
    run->setEnabled(!QProcess::splitCommand(command_->currentText()).isEmpty());
  };
  connect(command_, &QComboBox::editTextChanged, this, enable);
  enable();
}

ProgramSpec StartDialog::spec() const {
  ProgramSpec spec;
  spec.command = QProcess::splitCommand(command_->currentText());
  for (const QString& line : environment_->toPlainText().split('\n'))
    if (line.contains('=')) spec.environment.push_back(line.trimmed());
  spec.directory = directory_->text().trimmed();
  spec.frame = static_cast<std::uint64_t>(frame_->value());
  spec.draw = static_cast<std::uint64_t>(draw_->value());
  return spec;
}

void StartDialog::browse(bool program) {
  auto* dialog = new QFileDialog(this, program ? tr("Choose a program") : tr("Choose a folder"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(program ? QFileDialog::ExistingFile : QFileDialog::Directory);
  connect(dialog, &QFileDialog::fileSelected, this, [this, program](const QString& path) {
    if (program) {
      command_->setCurrentText(commandLine({path}));
    } else {
      directory_->setText(path);
    }
  });
  dialog->show();
}

QStringList StartDialog::recent() {
  return QSettings().value(kRecentKey).toStringList();
}

void StartDialog::remember(const ProgramSpec& spec) {
  QStringList list = recent();
  const QString line = commandLine(spec.command);
  list.removeAll(line);
  list.prepend(line);
  QSettings().setValue(kRecentKey, list.mid(0, kRecent));
}

}  // namespace shadestep::gui
