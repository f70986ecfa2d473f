#include "debugger-gui/panels/cost_panel.h"

#include <QDir>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QToolButton>
#include <algorithm>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "profiler/pictures/ticks.h"
#include "profiler/profile_files.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

QString text(const std::string& string) {
  return QString::fromStdString(string);
}

constexpr QChar kNoBreak(0xa0);

QString percent(double share, int digits = 3) {
  return text(profiler::readable(100 * share, digits)) + kNoBreak + "%";
}

}  // namespace

CostPanel::CostPanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      method_(new QComboBox),
      budget_(new QDoubleSpinBox),
      earlier_(new QLineEdit),
      save_(new QPushButton(tr("Save..."))),
      height_(new QPushButton(tr("Landscape"))),
      summary_(new QLabel(
          tr("Measure what each thread costs: the heat map appears in the picture, hits and shares beside "
             "the source"))),
      check_(new CheckBadge),
      lines_(new QTreeWidget) {
  for (const auto& [name, shown] : {std::pair{"auto", tr("best that works")},
                                    {"clock", tr("shader clock")},
                                    {"isolate", tr("isolated pixels")},
                                    {"count", tr("statements")},
                                    {"tiles", tr("tiles of the target")}})
    method_->addItem(shown, QString(name));
  method_->setToolTip(tr("Method"));
  budget_->setRange(0.5, 3600);
  budget_->setValue(6);
  budget_->setSuffix(tr(" s"));
  budget_->setToolTip(tr("Time to measure for"));
  earlier_->setPlaceholderText(tr("compare with an earlier profile.json"));
  earlier_->setClearButtonEnabled(true);
  auto* browse = new QToolButton;
  browse->setIcon(icon("open"));
  auto* measure = new QPushButton(tr("Measure"));
  save_->setToolTip(tr("Heat map, landscape, table and report into a folder"));
  height_->setToolTip(tr("The costs as a landscape"));
  summary_->setWordWrap(true);
  summary_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  lines_->setHeaderLabels({tr("Line"), tr("Hits"), tr("Share"), tr("Source")});
  lines_->setRootIsDecorated(false);
  lines_->setUniformRowHeights(true);
  lines_->setAlternatingRowColors(true);
  for (const auto& [column, width] : {std::pair{0, 54}, {1, 100}, {2, 70}})
    lines_->setColumnWidth(column, width);

  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(6, 4, 6, 4);
  column->setSpacing(4);
  auto* head = new QHBoxLayout;
  head->addWidget(measure);
  head->addWidget(method_);
  head->addWidget(budget_);
  head->addWidget(earlier_, 1);
  head->addWidget(browse);
  head->addWidget(height_);
  head->addWidget(save_);
  head->addWidget(check_);
  column->addLayout(head);
  column->addWidget(summary_);
  column->addWidget(lines_, 1);

  connect(measure, &QPushButton::clicked, this, [this] {
    debugger_.askProfile({method_->currentData().toString().toStdString(), budget_->value(),
                          earlier_->text().trimmed().toStdString()});
  });
  connect(browse, &QToolButton::clicked, this, &CostPanel::chooseEarlier);
  connect(save_, &QPushButton::clicked, this, &CostPanel::saveAll);
  connect(height_, &QPushButton::clicked, this, [this] {
    debugger_.show({PictureSource::Kind::cost, {}, 0});
    Q_EMIT landscapeAsked();
  });
  connect(lines_, &QTreeWidget::itemActivated, this,
          [this](QTreeWidgetItem* item) { Q_EMIT lineChosen(item->text(0).toInt()); });
  connect(&debugger_, &Debugger::profileChanged, this, [this] {
    refresh();
    const bool compared = debugger_.profile()->comparison.has_value();
    debugger_.show({compared ? PictureSource::Kind::difference : PictureSource::Kind::cost, {}, 0});
  });
  save_->setEnabled(false);
  height_->setEnabled(false);
}

void CostPanel::refresh() {
  const ProfilePtr& view = debugger_.profile();
  if (!view) return;
  const profiler::Profile& profile = view->profile;
  const auto cost = [&](double value) {
    const profiler::ScaledUnit unit = profiler::scaledUnit(profile.unit, value);
    return text(profiler::readable(value * unit.factor)) + kNoBreak + text(unit.name);
  };
  const QString who = profile.stage == session::Stage::fragment ? tr("pixels") : tr("threads");
  const QString often = profile.passes == 1 ? tr("once each") : tr("%1 times each").arg(profile.passes);
  QString summary =
      tr("%1: median %2, 95 % below %3; %4 of %5 %6 measured, %7, in %8 s; ")
          .arg(text(profiler::methodName(profile.method)), cost(profile.median), cost(profile.p95),
               text(session::withThousands(profile.measured)), text(session::withThousands(profile.covered)),
               who, often, text(profiler::readable(profile.seconds, 3)));
  summary += profile.method == profiler::Method::count
                 ? tr("counted exactly")
                 : tr("reproducible to %1").arg(percent(profile.spread, 2));
  if (profile.reconstruction)
    summary +=
        tr("; the rest reconstructed with an error of %1").arg(percent(profile.reconstruction->error, 2));
  if (view->comparison)
    summary += tr("\nAgainst %1: %2%3 in all, noise %4: %5")
                   .arg(text(view->comparison->file), view->comparison->change > 0 ? "+" : "",
                        percent(view->comparison->change), percent(view->comparison->noise),
                        text(profiler::verdictName(view->comparison->verdict)));
  if (profile.interrupted) summary += tr("\nStopped before its end: this is what was measured until then.");
  summary_->setText(summary);
  QStringList notes;
  for (const std::string& note : profile.notes) notes.push_back(text(note));
  summary_->setToolTip(notes.join('\n'));
  check_->setCheck(profile.check);
  save_->setEnabled(true);
  height_->setEnabled(true);

  lines_->clear();
  std::vector<profiler::LineCost> lines = profile.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
    return std::pair(a.share.value_or(0), a.hits) > std::pair(b.share.value_or(0), b.hits);
  });
  for (const profiler::LineCost& line : lines) {
    const auto index = static_cast<std::size_t>(line.line) - 1;
    auto* item =
        new QTreeWidgetItem({QString::number(line.line), text(session::withThousands(line.hits)),
                             line.share ? percent(*line.share) : QString(),
                             index < view->source.size() ? text(view->source[index]).trimmed() : QString()});
    for (const int right : {0, 1, 2}) item->setTextAlignment(right, Qt::AlignRight);
    item->setFont(3, monospaced());
    lines_->addTopLevelItem(item);
  }
}

void CostPanel::chooseEarlier() {
  auto* dialog = new QFileDialog(this, tr("Compare with"), {}, tr("Profile (*.json)"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, earlier_, &QLineEdit::setText);
  dialog->show();
}

void CostPanel::saveAll() {
  auto* dialog = new QFileDialog(this, tr("Save into the folder"));
  dialog->setFileMode(QFileDialog::Directory);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, this,
          [this, view = debugger_.profile()](const QString& folder) {
            const auto in = [&](const char* name) { return QDir(folder).filePath(name).toStdString(); };
            profiler::ProfileFiles files;
            files.heat_png = in("heat.png");
            files.heat_exr = in("heat.exr");
            files.height_png = in("height.png");
            files.profile_json = in("profile.json");
            files.report_html = in("report.html");
            files.difference_png = in("difference.png");
            files.difference_exr = in("difference.exr");
            try {
              profiler::writeProfile(view->profile, files, {view->subject, view->source},
                                     view->comparison ? &*view->comparison : nullptr);
              Q_EMIT debugger_.message(tr("Wrote %1").arg(text(files.report_html)), false);
            } catch (const std::exception& error) {
              Q_EMIT debugger_.message(QString::fromUtf8(error.what()), true);
            }
          });
  dialog->show();
}

}  // namespace shadestep::gui
