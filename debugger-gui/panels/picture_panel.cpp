#include "debugger-gui/panels/picture_panel.h"

#include <QFileDialog>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "debugger-gui/style/icons.h"
#include "debugger-gui/style/theme.h"
#include "profiler/pictures/ticks.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

using Kind = PictureSource::Kind;

QString number(double value) {
  const QString text = QString::number(value, 'g', 5);
  return text.contains('e') ? QString::number(value, 'g', 3) : text;
}

QPixmap swatch(QRgb color) {
  QPixmap pixmap(11, 11);
  pixmap.fill(QColor::fromRgb(color));
  return pixmap;
}

QToolButton* button(const QString& icon_name, const QString& tip) {
  auto* made = new QToolButton;
  made->setIcon(icon(icon_name));
  made->setToolTip(tip);
  made->setAutoRaise(true);
  return made;
}

}  // namespace

PicturePanel::PicturePanel(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      sources_(new QComboBox),
      check_(new CheckBadge),
      view_(new PictureView),
      landscape_(new LandscapeView),
      stack_(new QStackedWidget),
      in_space_(new QToolButton),
      channels_(new QComboBox),
      low_(new QLineEdit),
      high_(new QLineEdit),
      automatic_(new QToolButton),
      gamma_(new QDoubleSpinBox),
      sides_(new QWidget),
      hovered_(new QLabel),
      origin_(new QToolButton) {
  sources_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  sources_->setMinimumContentsLength(18);
  sources_->setToolTip(tr("Which picture is shown"));
  channels_->addItems({tr("RGB"), "R", "G", "B", "A"});
  channels_->setToolTip(tr("Channels"));
  for (QLineEdit* edit : {low_, high_}) {
    edit->setFixedWidth(77);
    edit->setAlignment(Qt::AlignRight);
  }
  low_->setToolTip(tr("Shown black"));
  high_->setToolTip(tr("Shown white"));
  automatic_->setText(tr("Auto"));
  automatic_->setCheckable(true);
  automatic_->setChecked(true);
  automatic_->setToolTip(tr("The range follows the values"));
  gamma_->setRange(0.1, 8);
  gamma_->setSingleStep(0.1);
  gamma_->setValue(1);
  gamma_->setPrefix("γ ");
  gamma_->setToolTip(tr("Gamma: above 1 brightens small values"));
  QFont small = monospaced();
  small.setPointSizeF(small.pointSizeF() - 1);
  hovered_->setFont(small);
  hovered_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  hovered_->setMinimumWidth(60);
  hovered_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  in_space_->setText(tr("3D"));
  in_space_->setCheckable(true);
  in_space_->setAutoRaise(true);
  in_space_->setToolTip(tr("The values as a landscape"));
  origin_->setText(tr("Vertices"));
  origin_->setAutoRaise(true);
  origin_->setToolTip(tr("To the runs of the vertex shader that the picked pixel's fragment comes from"));
  QToolButton* fit = button("fit", tr("Fit into the view (0)"));
  QToolButton* save = button("save", tr("Save as PNG"));

  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 2, 0, 4);
  column->setSpacing(4);
  auto* head = new QHBoxLayout;
  head->setContentsMargins(6, 2, 6, 0);
  head->addWidget(sources_, 1);
  head->addWidget(origin_);
  head->addWidget(check_);
  column->addLayout(head);
  auto* tools = new QHBoxLayout;
  tools->setContentsMargins(6, 0, 6, 0);
  tools->setSpacing(4);
  tools->addWidget(channels_);
  tools->addWidget(low_);
  tools->addWidget(high_);
  tools->addWidget(automatic_);
  tools->addWidget(gamma_);
  tools->addStretch();
  tools->addWidget(in_space_);
  tools->addWidget(fit);
  tools->addWidget(save);
  column->addLayout(tools);
  stack_->addWidget(view_);
  stack_->addWidget(landscape_);
  column->addWidget(stack_, 1);
  auto* sides_row = new QHBoxLayout(sides_);
  sides_row->setContentsMargins(6, 0, 6, 0);
  column->addWidget(sides_);
  auto* foot = new QHBoxLayout;
  foot->setContentsMargins(8, 0, 8, 0);
  foot->addWidget(hovered_);
  column->addLayout(foot);
  sides_->hide();

  connect(view_, &PictureView::picked, this, &PicturePanel::pick);
  connect(view_, &PictureView::hovered, this, &PicturePanel::showHovered);
  connect(view_, &PictureView::mappingChanged, this, [this] {
    low_->setText(number(view_->mapping().low));
    high_->setText(number(view_->mapping().high));
  });
  connect(view_, &PictureView::shown, this, &PicturePanel::refreshLandscape);
  connect(sources_, &QComboBox::activated, this, [this](int i) { debugger_.show(listed_[i]); });
  connect(channels_, &QComboBox::activated, this, &PicturePanel::takeMapping);
  connect(automatic_, &QToolButton::clicked, this, &PicturePanel::takeMapping);
  connect(gamma_, &QDoubleSpinBox::valueChanged, this, &PicturePanel::takeMapping);
  for (QLineEdit* edit : {low_, high_})
    connect(edit, &QLineEdit::editingFinished, this, [this, edit] {
      if (!edit->isModified()) return;
      edit->setModified(false);
      automatic_->setChecked(false);
      takeMapping();
    });
  connect(in_space_, &QToolButton::toggled, this, &PicturePanel::showInSpace);
  connect(origin_, &QToolButton::clicked, this, [this] {
    const bool patches = debugger_.source(session::Stage::tess_control) != nullptr;
    debugger_.askOrigin(patches ? session::Stage::tess_control : session::Stage::vertex);
  });
  connect(fit, &QToolButton::clicked, view_, &PictureView::fit);
  connect(save, &QToolButton::clicked, this, &PicturePanel::exportPicture);
  for (const auto signal :
       {&Debugger::valuesChanged, &Debugger::targetChanged, &Debugger::pictureChanged,
        &Debugger::loopsChanged, &Debugger::profileChanged, &Debugger::pickedChanged, &Debugger::stopChanged})
    connect(&debugger_, signal, this, &PicturePanel::refresh);
  connect(&debugger_, &Debugger::placeChanged, this, [this] {
    // At a branch, its outcome is what one wants to see; behind it, what was shown before.
    const bool outcome = debugger_.picture().kind == Kind::outcome;
    if (outcome && debugger_.place() && debugger_.place()->sides.empty()) debugger_.show({});
    refresh();
  });
  refresh();
}

void PicturePanel::listSources() {
  listed_.clear();
  QStringList names;
  const auto add = [&](const PictureSource& source, const QString& name) {
    listed_.push_back(source);
    names.push_back(name);
  };
  const int outputs = debugger_.target() ? static_cast<int>(debugger_.target()->outputs.size()) : 1;
  for (int i = 0; i < outputs; ++i)
    add({Kind::target, {}, i},
        outputs == 1 ? tr("What the draw leaves") : tr("What the draw leaves, output %1").arg(i));
  if (debugger_.place() && !debugger_.place()->sides.empty())
    add({Kind::outcome, {}, 0}, tr("Outcome of the branch"));
  if (debugger_.values()) {
    for (const Look::Value& value : debugger_.values()->values) {
      const QString name = QString::fromStdString(value.watched.name);
      add({Kind::value, name, 0}, name);
    }
  }
  if (debugger_.loops())
    for (int i = 0; i < static_cast<int>(debugger_.loops()->loops.size()); ++i)
      add({Kind::iterations, {}, i}, tr("Iterations of the loop at line %1")
                                         .arg(debugger_.loops()->loops[static_cast<std::size_t>(i)].line));
  if (debugger_.profile())
    add({Kind::cost, {}, 0},
        debugger_.profileIsOfThisDraw() ? tr("Cost") : tr("Cost of the draw measured before"));
  if (debugger_.profile() && debugger_.profile()->comparison)
    add({Kind::difference, {}, 0}, tr("Cost against the earlier run"));
  if (debugger_.texture()) {
    const QString name = QString::fromStdString(debugger_.texture()->uniform);
    add({Kind::texture, name, 0}, tr("Texture %1").arg(name));
  }
  const PictureSource& shown = debugger_.picture();
  if (!listed_.contains(shown)) add(shown, shown.name.isEmpty() ? tr("(not here)") : shown.name);
  const QSignalBlocker quiet(sources_);
  sources_->clear();
  sources_->addItems(names);
  sources_->setCurrentIndex(static_cast<int>(listed_.indexOf(shown)));
}

PicturePanel::Shown PicturePanel::shown() const {
  const PictureSource& source = debugger_.picture();
  switch (source.kind) {
    case Kind::target:
      if (const TargetPtr& target = debugger_.target())
        return {target, nullptr, target->check, [=, i = source.index] { return pictureOfTarget(target, i); }};
      break;
    case Kind::value:
      if (const LookPtr& look = debugger_.values())
        return {look, nullptr, debugger_.check(),
                [=, name = source.name] { return pictureOfValue(look, name); }};
      break;
    case Kind::outcome:
      if (const auto& place = debugger_.place())
        return {debugger_.values(), place->ways, debugger_.check(),
                [&place, look = debugger_.values()] { return pictureOfOutcome(*place, look); }};
      break;
    case Kind::iterations:
      if (const LoopsPtr& loops = debugger_.loops())
        return {loops, nullptr, loops->check,
                [=, i = source.index] { return pictureOfIterations(loops, i); }};
      break;
    case Kind::cost:
    case Kind::difference:
      if (const ProfilePtr& profile = debugger_.profile())
        return {profile, nullptr, profile->profile.check, [=, cost = source.kind == Kind::cost] {
                  return cost ? pictureOfCost(profile) : pictureOfDifference(profile);
                }};
      break;
    case Kind::texture:
      if (const TexturePtr& texture = debugger_.texture())
        return {texture, nullptr, texture->check, [=] { return pictureOfTexture(texture); }};
      break;
  }
  return {};
}

// Of a picture over pixels the picked pixel, of one over other threads the place of the picked one.
std::optional<QPoint> PicturePanel::pickedIn(const PicturePtr& picture) const {
  if (!picture || !picture->who) {
    const auto& pixel = debugger_.pixel();
    return pixel ? std::optional(QPoint(pixel->x, pixel->y)) : std::nullopt;
  }
  const auto thread = picture->find ? picture->find(debugger_.picked()) : std::nullopt;
  if (!thread) return std::nullopt;
  const auto found = std::find(picture->threads.begin(), picture->threads.end(), *thread);
  if (found == picture->threads.end()) return std::nullopt;
  const int at = static_cast<int>(found - picture->threads.begin());
  return QPoint(at % picture->width, at / picture->width);
}

void PicturePanel::pick(int x, int y) {
  const PicturePtr& picture = view_->picture();
  const std::size_t pixel = picture->index(x, y);
  if (!picture->who) return debugger_.pick(Pixel{x, y});
  if (picture->name && picture->cells[pixel] != Picture::Cell::none)
    debugger_.pick(picture->name(picture->thread(pixel)));
}

void PicturePanel::refresh() {
  listSources();
  const QString& name = debugger_.picture().name;
  const bool unwritten = debugger_.values() && debugger_.values()->unwritten.count(name.toStdString()) > 0;
  const bool dispatch = debugger_.source(session::Stage::compute) != nullptr;
  view_->setNothing(name.isEmpty() && dispatch
                        ? tr("A dispatch leaves no picture: show a variable over its threads")
                    : name.isEmpty() ? tr("Nothing to show here yet")
                    : unwritten      ? tr("%1 is not written yet").arg(name)
                                     : tr("%1 has no value here").arg(name));
  // There are many pixels: the picture is made when something else is to be seen.
  const Shown now = shown();
  const auto made_of = std::tuple(debugger_.picture(), now.values, now.ways, theme().no_thread.rgb());
  if (made_of != made_of_) {
    made_of_ = made_of;
    view_->setPicture(now.make ? now.make() : nullptr);
  }
  const PicturePtr& picture = view_->picture();
  const bool numbers = picture && picture->colors.empty();
  for (QWidget* tool : std::initializer_list<QWidget*>{low_, high_, automatic_, gamma_})
    tool->setEnabled(numbers);
  channels_->setEnabled(numbers && picture->components > 1);
  view_->setPicked(pickedIn(picture));
  check_->setCheck(now.check);
  origin_->setVisible(debugger_.pixel() && debugger_.stage() == session::Stage::fragment &&
                      debugger_.source(session::Stage::vertex) != nullptr);
  showSides();
  showHovered(-1, -1);
}

// Fig. 7.5's legend: a side each, with how many threads take it, and the button to follow it.
void PicturePanel::showSides() {
  const auto& place = debugger_.place();
  qDeleteAll(sides_->findChildren<QPushButton*>(QString(), Qt::FindDirectChildrenOnly));
  sides_->setVisible(place && !place->sides.empty());
  if (!sides_->isVisibleTo(this)) return;
  for (std::size_t i = 0; i < place->sides.size(); ++i) {
    const SideView& side = place->sides[i];
    const QString name = QString::fromStdString(side.name);
    auto* follow =
        new QPushButton(swatch(colorOfSide(*place, i)),
                        tr("%1: %2").arg(name, QString::fromStdString(session::withThousands(side.threads))));
    follow->setToolTip(side.picked ? tr("Follow this side; the picked thread takes it")
                                   : tr("Follow this side"));
    QFont font = follow->font();
    font.setBold(side.picked);
    follow->setFont(font);
    follow->setEnabled(side.threads > 0 || place->sides.size() > 2);
    connect(follow, &QPushButton::clicked, this, [this, name] { debugger_.choose(name); });
    sides_->layout()->addWidget(follow);
  }
  if (debugger_.picture().kind == Kind::outcome) return;
  auto* show = new QPushButton(tr("Show"));
  show->setToolTip(tr("Show which thread goes which way; orange: left the loop before, or never there"));
  connect(show, &QPushButton::clicked, this, [this] { debugger_.show({Kind::outcome, {}, 0}); });
  sides_->layout()->addWidget(show);
}

void PicturePanel::showHovered(int x, int y) {
  const auto picked = pickedIn(view_->picture());
  if (x < 0 && picked) {
    x = picked->x();
    y = picked->y();
  }
  QString text = view_->describe(x, y);
  const PicturePtr& picture = view_->picture();
  const bool picks = picture && (!picture->who || picture->name);
  if (text.isEmpty()) text = picks ? tr("A click picks a thread") : QString();
  // A number that is cut off would be another number.
  hovered_->setText(hovered_->fontMetrics().elidedText(text, Qt::ElideRight, hovered_->width()));
  hovered_->setToolTip(text);
}

void PicturePanel::showInSpace(bool on) {
  in_space_->setChecked(on);
  stack_->setCurrentWidget(on ? static_cast<QWidget*>(landscape_) : view_);
  refreshLandscape();
}

void PicturePanel::refreshLandscape() {
  if (stack_->currentWidget() == landscape_)
    landscape_->show(view_->picture(), view_->mapping(), view_->image());
}

void PicturePanel::takeMapping() {
  Mapping mapping = view_->mapping();
  mapping.channels = static_cast<Mapping::Channels>(channels_->currentIndex());
  mapping.automatic = automatic_->isChecked();
  mapping.gamma = gamma_->value();
  if (!mapping.automatic) {
    bool low_is_number = false;
    bool high_is_number = false;
    // What stands there is rounded.
    const auto typed = [](const QLineEdit& edit, double now, bool* is_number) {
      const double read = edit.text().toDouble(is_number);
      return edit.text() == number(now) ? now : read;
    };
    const double low = typed(*low_, mapping.low, &low_is_number);
    const double high = typed(*high_, mapping.high, &high_is_number);
    if (low_is_number && high_is_number && low < high) {
      mapping.low = low;
      mapping.high = high;
    }
  }
  view_->setMapping(mapping);
}

void PicturePanel::exportPicture() {
  if (view_->image().isNull()) return;
  auto* dialog = new QFileDialog(this, tr("Save the picture"), "picture.png", tr("Picture (*.png)"));
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QFileDialog::fileSelected, this, [this, image = view_->image()](const QString& file) {
    const bool written = image.save(file);
    Q_EMIT debugger_.message(written ? tr("Wrote %1").arg(file) : tr("Cannot write %1").arg(file), !written);
  });
  dialog->show();
}

}  // namespace shadestep::gui
