#include "debugger-gui/start_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QSettings>
#include <QStyledItemDelegate>
#include <QToolButton>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {
constexpr int kRecent = 12;
constexpr const char* kRecentKey = "recent programs";

ProgramSpec specIn(const QVariant& stored) {
  const QVariantMap map = stored.toMap();
  ProgramSpec spec;
  // Lists of before there was more than the command line hold that alone.
  spec.command = map.isEmpty() ? QProcess::splitCommand(stored.toString()) : map["command"].toStringList();
  spec.environment = map["environment"].toStringList();
  spec.directory = map["directory"].toString();
  return spec;
}

QVariant stored(const ProgramSpec& spec) {
  return QVariantMap{
      {"command", spec.command}, {"environment", spec.environment}, {"directory", spec.directory}};
}

// What tells programs of the same command line apart stands behind it in the list, but not in the field.
class RecentDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    const ProgramSpec spec = specIn(index.data(Qt::UserRole));
    QStringList around = spec.environment;
    if (!spec.directory.isEmpty()) around.prepend(tr("in %1").arg(spec.directory));
    if (!around.isEmpty()) option->text += "    (" + around.join(", ") + ")";
  }
};
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
      directory_(new QLineEdit),
      environment_(new QPlainTextEdit),
      frame_(new QSpinBox),
      draw_(new QSpinBox) {
  setWindowTitle(tr("Run a program"));
  command_->setEditable(true);
  command_->setMinimumWidth(460);
  // However long what was run before.
  command_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  command_->setInsertPolicy(QComboBox::NoInsert);
  const QList<ProgramSpec> before = recent();
  for (const ProgramSpec& one : before) command_->addItem(commandLine(one.command), stored(one));
  command_->setItemDelegate(new RecentDelegate(command_));
  connect(command_, &QComboBox::activated, this,
          [this](int chosen) { fill(specIn(command_->itemData(chosen))); });
  fill(spec.command.isEmpty() ? before.value(0) : spec);
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
  at->setSpacing(6);
  at->addWidget(new QLabel(tr("frame")));
  at->addWidget(frame_);
  at->addSpacing(8);
  at->addWidget(new QLabel(tr("draw")));
  at->addWidget(draw_);
  at->addStretch();
  auto* form = new QFormLayout(this);
  form->setContentsMargins(16, 16, 16, 12);
  form->setVerticalSpacing(10);
  // A form gives a row of several fields no key of its own.
  const auto label = [](const QString& text, QWidget* field) {
    auto* made = new QLabel(text);
    made->setBuddy(field);
    return made;
  };
  form->addRow(label(tr("&Program"), command_), with_button(command_, true));
  form->addRow(label(tr("&Folder"), directory_), with_button(directory_, false));
  form->addRow(tr("&Environment"), environment_);
  form->addRow(label(tr("&Stop first at"), frame_), at);
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

void StartDialog::fill(const ProgramSpec& spec) {
  command_->setCurrentText(commandLine(spec.command));
  directory_->setText(spec.directory);
  environment_->setPlainText(spec.environment.join('\n'));
}

QList<ProgramSpec> StartDialog::recent() {
  QList<ProgramSpec> programs;
  for (const QVariant& one : QSettings().value(kRecentKey).toList()) programs.push_back(specIn(one));
  return programs;
}

void StartDialog::remember(const ProgramSpec& spec) {
  QVariantList list{stored(spec)};
  for (const ProgramSpec& one : recent())
    if (stored(one) != list.front() && list.size() < kRecent) list.push_back(stored(one));
  QSettings().setValue(kRecentKey, list);
}

}  // namespace shadestep::gui
