#include "debugger-gui/panels/state_panel.h"

#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMap>
#include <QVBoxLayout>

#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {

QComboBox* switchBox() {
  auto* box = new QComboBox;
  box->addItems({QObject::tr("as it is"), QObject::tr("on"), QObject::tr("off")});
  return box;
}

session::FragmentChoice::Switch switchOf(const QComboBox* box) {
  return static_cast<session::FragmentChoice::Switch>(box->currentIndex());
}

}  // namespace

StatePanel::StatePanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      search_(new QLineEdit),
      tree_(new QTreeWidget),
      alpha_(switchBox()),
      depth_(switchBox()),
      stencil_(switchBox()),
      blend_(switchBox()),
      layer_(new QSpinBox),
      sample_(new QSpinBox),
      clear_(new QCheckBox(tr("from cleared buffers"))) {
  search_->setPlaceholderText(tr("Search the state"));
  search_->setClearButtonEnabled(true);
  tree_->setHeaderLabels({tr("Name"), tr("Value")});
  tree_->setUniformRowHeights(true);
  tree_->setAlternatingRowColors(true);
  tree_->setRootIsDecorated(false);
  tree_->setColumnWidth(0, 330);
  auto* left = new QVBoxLayout;
  left->setSpacing(4);
  left->addWidget(search_);
  left->addWidget(tree_, 1);
  auto* tests = new QGridLayout;
  tests->setVerticalSpacing(5);
  auto* title = new QLabel(tr("Replays of the debugger"));
  QFont bold = title->font();
  bold.setBold(true);
  title->setFont(bold);
  tests->addWidget(title, 0, 0, 1, 2);
  int row = 1;
  for (const auto& [name, box] : {std::pair<QString, QWidget*>{tr("Alpha test"), alpha_},
                                  {tr("Depth test"), depth_},
                                  {tr("Stencil test"), stencil_},
                                  {tr("Blending"), blend_},
                                  {tr("Layer"), layer_},
                                  {tr("Sample"), sample_}}) {
    auto* label = new QLabel(name);
    label->setBuddy(box);
    tests->addWidget(label, row, 0);
    tests->addWidget(box, row++, 1);
  }
  tests->addWidget(clear_, row++, 0, 1, 2);
  tests->setRowStretch(row, 1);
  auto* columns = new QHBoxLayout(this);
  columns->setContentsMargins(6, 4, 8, 4);
  columns->setSpacing(14);
  columns->addLayout(left, 1);
  columns->addLayout(tests);

  connect(search_, &QLineEdit::textChanged, this, &StatePanel::filter);
  for (QComboBox* box : {alpha_, depth_, stencil_, blend_})
    connect(box, &QComboBox::activated, this, &StatePanel::chooseFragments);
  for (QSpinBox* box : {layer_, sample_})
    connect(box, &QSpinBox::valueChanged, this, &StatePanel::chooseFragments);
  connect(clear_, &QCheckBox::clicked, this, &StatePanel::chooseFragments);
  connect(&debugger_, &Debugger::glStateChanged, this, &StatePanel::refresh);
  connect(&debugger_, &Debugger::stopChanged, this, &StatePanel::ask);
}

void StatePanel::showEvent(QShowEvent*) {
  ask();
}

// The state costs some thousand queries: only who looks at it pays.
void StatePanel::ask() {
  const auto& stop = debugger_.stop();
  if (!stop) return;
  const QSignalBlocker quiet_layer(layer_);
  const QSignalBlocker quiet_sample(sample_);
  layer_->setMaximum(std::max(0, stop->facts.layers - 1));
  sample_->setMaximum(std::max(0, stop->facts.samples - 1));
  alpha_->setEnabled(!stop->facts.core && !stop->facts.es);
  if (isVisible() && debugger_.glState().empty()) debugger_.askGlState();
}

void StatePanel::refresh() {
  tree_->clear();
  QList<QTreeWidgetItem*> items;
  for (const auto& [name, value] : debugger_.glState()) {
    auto* item = new QTreeWidgetItem({QString::fromStdString(name), QString::fromStdString(value)});
    item->setFont(1, monospaced());
    items.push_back(item);
  }
  tree_->addTopLevelItems(items);
  filter(search_->text());
}

void StatePanel::filter(const QString& text) {
  for (int i = 0; i < tree_->topLevelItemCount(); ++i) {
    QTreeWidgetItem* item = tree_->topLevelItem(i);
    item->setHidden(!item->text(0).contains(text, Qt::CaseInsensitive) &&
                    !item->text(1).contains(text, Qt::CaseInsensitive));
  }
}

void StatePanel::chooseFragments() {
  session::FragmentChoice choice;
  choice.alpha_test = switchOf(alpha_);
  choice.depth_test = switchOf(depth_);
  choice.stencil_test = switchOf(stencil_);
  choice.blend = switchOf(blend_);
  choice.layer = layer_->value();
  choice.sample = sample_->value();
  choice.clear_buffers = clear_->isChecked();
  debugger_.setFragments(choice);
}

}  // namespace shadestep::gui
