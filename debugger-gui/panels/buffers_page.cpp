#include "debugger-gui/panels/buffers_page.h"

#include <QHeaderView>
#include <QSplitter>
#include <QVBoxLayout>
#include <algorithm>

#include "debugger-gui/panels/page.h"
#include "session/text.h"

namespace shadestep::gui {
namespace {

using Kind = session::ElementFormat::Kind;
using session::BufferUse;

constexpr std::pair<Kind, const char*> kKinds[] = {
    {Kind::float32, "float"},  {Kind::float16, "half"}, {Kind::float64, "double"}, {Kind::int32, "int"},
    {Kind::uint32, "uint"},    {Kind::int16, "int16"},  {Kind::uint16, "uint16"},  {Kind::int8, "int8"},
    {Kind::uint8, "uint8"},    {Kind::int64, "int64"},  {Kind::uint64, "uint64"},  {Kind::hex8, "hex bytes"},
    {Kind::hex32, "hex words"}};
constexpr int kWhyNot = 5;    // a column
constexpr int kMembers = -1;  // the item's number that stands for the block's members

}  // namespace

BuffersPage::BuffersPage(Debugger& debugger, QWidget* parent)
    : QWidget(parent),
      debugger_(debugger),
      list_(new QTreeWidget),
      contents_(new QTableView),
      format_(new QComboBox),
      components_(new QSpinBox),
      stride_(new QSpinBox),
      normalized_(new QCheckBox(tr("normalized"))),
      note_(new QLabel),
      check_(new CheckBadge) {
  list_->setHeaderLabels({tr("Used as"), tr("Name"), tr("At"), tr("Buffer"), tr("Bytes"), tr("Why not")});
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setAlternatingRowColors(true);
  list_->setAccessibleName(tr("Buffers of the draw"));
  for (const auto& [column, width] : {std::pair{0, 126}, {1, 96}, {2, 34}, {3, 50}, {4, 70}})
    list_->setColumnWidth(column, width);
  contents_->setModel(&model_);
  contents_->setShowGrid(false);
  contents_->setWordWrap(false);
  contents_->setTabKeyNavigation(false);  // Tab leads on
  contents_->setAccessibleName(tr("What stands in the buffer"));
  contents_->setToolTip(tr("What stands there before the draw"));
  contents_->verticalHeader()->setDefaultSectionSize(contents_->fontMetrics().height() + 6);
  contents_->horizontalHeader()->setStretchLastSection(true);
  contents_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  format_->setToolTip(tr("What the bytes are read as"));
  format_->setAccessibleName(tr("Format"));
  format_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  components_->setRange(1, 4);
  components_->setToolTip(tr("Numbers per element"));
  stride_->setRange(0, 1 << 20);
  stride_->setSpecialValueText(tr("no gaps"));
  stride_->setSuffix(tr(" bytes apart"));
  stride_->setToolTip(tr("From the begin of one element to the next"));
  normalized_->setToolTip(tr("Whole numbers stand for 0 to 1, or -1 to 1"));
  note_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  note_->setMinimumWidth(40);

  auto* right = new QWidget;
  layOutPage(*right, {format_, components_, stride_, normalized_, note_, check_}, contents_);
  auto* split = new QSplitter;
  split->addWidget(list_);
  split->addWidget(right);
  split->setStretchFactor(1, 1);
  split->setSizes({400, 420});
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 4, 0, 0);
  column->addWidget(split);

  connect(list_, &QTreeWidget::currentItemChanged, this, &BuffersPage::choose);
  connect(format_, &QComboBox::activated, this, &BuffersPage::takeFormat);
  for (QSpinBox* box : {components_, stride_})
    connect(box, &QSpinBox::valueChanged, this, &BuffersPage::takeFormat);
  connect(normalized_, &QCheckBox::toggled, this, &BuffersPage::takeFormat);
  connect(&debugger_, &Debugger::buffersChanged, this, &BuffersPage::refresh);
  connect(&debugger_, &Debugger::bufferChanged, this, &BuffersPage::arrived);
  // Of values: a change of the theme tells of them.
  connect(&debugger_, &Debugger::valuesChanged, this, &BuffersPage::refreshCheck);
  connect(&debugger_, &Debugger::stopChanged, this, [this] {
    if (debugger_.stop()) return;  // what was seen last stays until there is something else
    model_.show(nullptr);
    list_->clear();
    refreshCheck();
  });
}

void BuffersPage::ask() {
  if (!debugger_.buffers()) debugger_.askBuffers();
}

const session::BoundBuffer* BuffersPage::chosen() const {
  const int row = list_->indexOfTopLevelItem(list_->currentItem());
  if (row < 0 || !debugger_.buffers()) return nullptr;
  return &(*debugger_.buffers())[static_cast<std::size_t>(row)];
}

void BuffersPage::refresh() {
  const QSignalBlocker quiet(list_);
  list_->clear();
  for (const session::BoundBuffer& one : *debugger_.buffers()) {
    const bool numbered = one.use != BufferUse::indices && one.use != BufferUse::commands;
    auto* item = new QTreeWidgetItem(
        {tr(session::useName(one.use)), QString::fromStdString(one.name),
         numbered ? QString::number(one.index) : QString(),
         one.buffer == 0 ? QString() : QString::number(one.buffer),
         one.bytes == 0 ? QString() : QString::fromStdString(session::withThousands(one.bytes)),
         QString::fromStdString(one.reason)});
    for (const int right : {2, 3, 4}) item->setTextAlignment(right, Qt::AlignRight | Qt::AlignVCenter);
    item->setToolTip(5, item->text(5));
    list_->addTopLevelItem(item);
  }
  list_->setColumnHidden(kWhyNot, std::none_of(debugger_.buffers()->begin(), debugger_.buffers()->end(),
                                               [](const auto& one) { return !one.reason.empty(); }));
  note_->setText(list_->topLevelItemCount() > 0 ? tr("A row shows what stands in its buffer")
                                                : tr("This draw reads no buffers"));
}

void BuffersPage::choose() {
  const session::BoundBuffer* const bound = chosen();
  if (bound == nullptr) return;
  model_.show(nullptr);
  check_->setCheck(std::nullopt);
  note_->setText(QString::fromStdString(bound->reason));
  const QSignalBlocker quiet[] = {QSignalBlocker(format_), QSignalBlocker(components_),
                                  QSignalBlocker(stride_), QSignalBlocker(normalized_)};
  format_->clear();
  if (!bound->members.empty()) format_->addItem(tr("members"), kMembers);
  for (const auto& [kind, name] : kKinds) format_->addItem(name, static_cast<int>(kind));
  const session::ElementFormat format = session::formatOf(*bound);
  format_->setCurrentIndex(
      format_->findData(bound->members.empty() ? static_cast<int>(format.kind) : kMembers));
  components_->setValue(format.components);
  stride_->setValue(static_cast<int>(format.stride));
  normalized_->setChecked(format.normalized);
  takeFormat();
  if (bound->reason.empty()) debugger_.askBuffer(*bound);
}

void BuffersPage::takeFormat() {
  const int chosen_kind = format_->currentData().toInt();
  const bool members = chosen_kind == kMembers;
  for (QWidget* one : std::initializer_list<QWidget*>{components_, stride_, normalized_})
    one->setVisible(!members);
  contents_->verticalHeader()->setVisible(!members);              // an element's number; members have names
  contents_->horizontalHeader()->setStretchLastSection(members);  // numbers stay side by side
  if (members) return model_.read(std::nullopt);
  session::ElementFormat format;
  format.kind = static_cast<Kind>(chosen_kind);
  format.components = components_->value();
  format.stride = static_cast<std::uint64_t>(stride_->value());
  format.normalized = normalized_->isChecked();
  model_.read(format);
}

void BuffersPage::arrived() {
  const BufferPtr& buffer = debugger_.buffer();
  model_.show(buffer);
  QStringList notes;
  if (buffer->bound.bytes > buffer->bytes.size())
    notes.push_back(
        tr("the first %1 bytes").arg(QString::fromStdString(session::withThousands(buffer->bytes.size()))));
  if (buffer->values.left_out > 0)
    notes.push_back(
        tr("%1 members more").arg(QString::fromStdString(session::withThousands(buffer->values.left_out))));
  if (buffer->bound.divisor > 0)
    notes.push_back(tr("a new element every %n instances", "", buffer->bound.divisor));
  note_->setText(notes.join("; "));
  contents_->resizeColumnsToContents();
  refreshCheck();
}

void BuffersPage::refreshCheck() {
  const BufferPtr& buffer = debugger_.buffer();
  check_->setCheck(buffer ? std::optional(buffer->check) : std::nullopt);
  if (!buffer) return;
  check_->setToolTip(buffer->check.compared_at_all
                         ? tr("The bytes before the draw, and once more behind a replay of it")
                         : tr("Read once: %1").arg(QString::fromStdString(buffer->check.reason)));
}

}  // namespace shadestep::gui
