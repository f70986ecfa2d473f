#include "debugger-gui/panels/state_panel.h"

#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMap>
#include <QVBoxLayout>
#include <algorithm>

#include "debugger-gui/panels/page.h"
#include "debugger-gui/style/theme.h"

namespace shadestep::gui {
namespace {

constexpr int kWhyNot = 6;  // a column

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
      tabs_(new QTabWidget),
      textures_(new QTreeWidget),
      level_(new QSpinBox),
      slice_(new QSpinBox),
      buffers_(new BuffersPage(debugger)),
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
  auto* state = new QWidget;
  layOutPage(*state, {search_}, tree_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(6, 0, 6, 4);
  tabs_->setDocumentMode(true);
  tabs_->addTab(state, tr("State"));
  tabs_->addTab(makeTextures(), tr("Textures"));
  tabs_->addTab(buffers_, tr("Buffers"));
  tabs_->addTab(makeTests(), tr("Fragment tests"));
  column->addWidget(tabs_);

  connect(search_, &QLineEdit::textChanged, this, &StatePanel::filter);
  for (QComboBox* box : {alpha_, depth_, stencil_, blend_})
    connect(box, &QComboBox::activated, this, &StatePanel::chooseFragments);
  for (QSpinBox* box : {layer_, sample_})
    connect(box, &QSpinBox::valueChanged, this, &StatePanel::chooseFragments);
  connect(clear_, &QCheckBox::clicked, this, &StatePanel::chooseFragments);
  connect(&debugger_, &Debugger::glStateChanged, this, &StatePanel::refresh);
  connect(&debugger_, &Debugger::stopChanged, this, &StatePanel::ask);
  connect(&debugger_, &Debugger::texturesChanged, this, &StatePanel::refreshTextures);
  connect(tabs_, &QTabWidget::currentChanged, this, &StatePanel::ask);
}

QWidget* StatePanel::makeTests() {
  auto* page = new QWidget;
  auto* tests = new QGridLayout(page);
  tests->setVerticalSpacing(5);
  tests->setHorizontalSpacing(10);
  auto* title =
      new QLabel(tr("How the debugger replays the draw. The program's own picture stays what it is."));
  tests->addWidget(title, 0, 0, 1, 5);
  int at = 0;
  for (const auto& [name, box] : {std::pair<QString, QWidget*>{tr("Alpha test"), alpha_},
                                  {tr("Depth test"), depth_},
                                  {tr("Stencil test"), stencil_},
                                  {tr("Blending"), blend_},
                                  {tr("Layer"), layer_},
                                  {tr("Sample"), sample_}}) {
    auto* label = new QLabel(name);
    label->setBuddy(box);
    constexpr int kRows = 4;
    const int side = at / kRows, row = 1 + at++ % kRows;
    tests->addWidget(label, row, 2 * side);
    tests->addWidget(box, row, 2 * side + 1);
  }
  constexpr int kBelowSample = 3;
  tests->addWidget(clear_, kBelowSample, 2, 1, 2);
  tests->setRowStretch(5, 1);
  tests->setColumnStretch(4, 1);
  return page;
}

QWidget* StatePanel::makeTextures() {
  textures_->setHeaderLabels(
      {tr("Sampler"), tr("Type"), tr("Unit"), tr("Texture"), tr("Size"), tr("Levels"), tr("Why not")});
  textures_->setRootIsDecorated(false);
  textures_->setUniformRowHeights(true);
  textures_->setAlternatingRowColors(true);
  textures_->setAccessibleName(tr("Textures of the fragment shader"));
  for (const auto& [column, width] : {std::pair{0, 130}, {1, 90}, {2, 44}, {3, 60}, {4, 128}, {5, 52}})
    textures_->setColumnWidth(column, width);
  level_->setPrefix(tr("level "));
  slice_->setPrefix(tr("slice "));
  auto* page = new QWidget;
  layOutPage(*page, {new QLabel(tr("A click shows the texels in the picture:")), level_, slice_}, textures_);
  connect(textures_, &QTreeWidget::itemClicked, this, &StatePanel::chooseTexture);
  connect(textures_, &QTreeWidget::itemActivated, this, &StatePanel::chooseTexture);
  for (QSpinBox* box : {level_, slice_})
    connect(box, &QSpinBox::valueChanged, this, &StatePanel::readTexture);
  return page;
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
  if (!isVisible()) return;
  if (tabs_->currentIndex() == kState && debugger_.glState().empty()) debugger_.askGlState();
  if (tabs_->currentIndex() == kBuffers) return buffers_->ask();
  if (tabs_->currentIndex() != kTextures || debugger_.textures()) return;
  textures_->clear();
  if (const StageSource* fragments = debugger_.source(session::Stage::fragment);
      fragments != nullptr && fragments->reason.empty())
    debugger_.askTextures();
}

void StatePanel::refreshTextures() {
  textures_->clear();
  for (const session::ShaderTexture& one : *debugger_.textures()) {
    const session::SampledTexture& facts = one.facts;
    QString size;
    if (!facts.levels.empty()) {
      const auto& base = facts.levels.front();
      size = QString("%1 × %2").arg(base.width).arg(base.height);
      if (base.depth > 1) size += QString(" × %1").arg(base.depth);
      if (facts.samples > 0) size += tr(", %n samples", "", facts.samples);
    }
    textures_->addTopLevelItem(
        new QTreeWidgetItem({QString::fromStdString(facts.uniform), QString::fromStdString(one.type),
                             QString::number(facts.unit), QString::number(facts.texture), size,
                             QString::number(facts.levels.size()), QString::fromStdString(facts.reason)}));
  }
  textures_->setColumnHidden(kWhyNot,
                             std::none_of(debugger_.textures()->begin(), debugger_.textures()->end(),
                                          [](const auto& one) { return !one.facts.reason.empty(); }));
}

// Its base level, and its first slice: of a volume the middle one, where most is to be seen.
void StatePanel::chooseTexture() {
  const int row = textures_->indexOfTopLevelItem(textures_->currentItem());
  if (row < 0 || !debugger_.textures()) return;
  const session::ShaderTexture& chosen = (*debugger_.textures())[static_cast<std::size_t>(row)];
  if (chosen.facts.levels.empty()) return;
  const QSignalBlocker quiet_level(level_);
  const QSignalBlocker quiet_slice(slice_);
  level_->setRange(chosen.facts.base_level,
                   chosen.facts.base_level + static_cast<int>(chosen.facts.levels.size()) - 1);
  level_->setValue(chosen.facts.base_level);
  const bool cube = chosen.type.find("Cube") != std::string::npos;
  const bool several = chosen.facts.samples > 0;
  slice_->setPrefix(cube ? tr("face ") : several ? tr("sample ") : tr("slice "));
  slice_->setToolTip(cube      ? tr("+x, -x, +y, -y, +z, -z; of an array of cube maps six of each")
                     : several ? tr("of an array the samples of one layer after those of another")
                               : QString());
  const int slices = session::slicesOf(chosen.facts, 0);
  slice_->setRange(0, slices - 1);
  slice_->setValue(chosen.type.find("3D") != std::string::npos ? slices / 2 : 0);
  readTexture();
}

// A volume's levels have fewer and fewer slices.
void StatePanel::readTexture() {
  const int row = textures_->indexOfTopLevelItem(textures_->currentItem());
  if (row < 0 || !debugger_.textures()) return;
  const session::SampledTexture& facts = (*debugger_.textures())[static_cast<std::size_t>(row)].facts;
  const auto above = static_cast<std::size_t>(std::max(level_->value() - facts.base_level, 0));
  if (above >= facts.levels.size()) return;
  const QSignalBlocker quiet(slice_);
  slice_->setMaximum(session::slicesOf(facts, above) - 1);
  const QTreeWidgetItem* item = textures_->currentItem();
  debugger_.askTexture(item->text(0), level_->value(), slice_->value());
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
