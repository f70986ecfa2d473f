#include "debugger-gui/models/variable_model.h"

#include <QFont>
#include <algorithm>

#include "debugger-gui/style/theme.h"
#include "profiler/pictures/files.h"
#include "session/values.h"

namespace shadestep::gui {

struct VariableModel::Node {
  QString name;
  QString type;
  Target target;
  QString refused;  // why there is no value
  Node* parent = nullptr;
  int row = 0;
  std::vector<std::unique_ptr<Node>> children;

  Node* add(QString child_name) {
    auto child = std::make_unique<Node>();
    child->name = std::move(child_name);
    child->parent = this;
    child->row = static_cast<int>(children.size());
    children.push_back(std::move(child));
    return children.back().get();
  }
  bool sameShape(const Node& other) const {
    if (name != other.name || type != other.type || children.size() != other.children.size()) return false;
    for (std::size_t i = 0; i < children.size(); ++i)
      if (!children[i]->sameShape(*other.children[i])) return false;
    return true;
  }
  void takeOver(Node& other) {
    refused = other.refused;
    for (std::size_t i = 0; i < children.size(); ++i) children[i]->takeOver(*other.children[i]);
  }
};

namespace {

const char* groupOf(frontend::Storage storage) {
  using frontend::Storage;
  switch (storage) {
    case Storage::local:
    case Storage::parameter:
      return QT_TRANSLATE_NOOP("VariableModel", "Local");
    case Storage::global:
    case Storage::constant:
    case Storage::shared:
      return QT_TRANSLATE_NOOP("VariableModel", "Global");
    case Storage::out:
      return QT_TRANSLATE_NOOP("VariableModel", "Outputs");
    default:
      return QT_TRANSLATE_NOOP("VariableModel", "Inputs and uniforms");
  }
}

// Without the numbers that are 0 for most: instances, invocations.
QString shortNameOf(const Picked& picked) {
  if (picked.pixel) return QString("%1, %2").arg(picked.pixel->x).arg(picked.pixel->y);
  session::ThreadName name = picked.thread;
  if (name.size() > 1)
    name.erase(std::remove_if(name.begin() + 1, name.end(), [](const auto& one) { return one.second == 0; }),
               name.end());
  return textOf(name);
}

}  // namespace

VariableModel::VariableModel(const Debugger& debugger, QObject* parent)
    : QAbstractItemModel(parent), debugger_(debugger), root_(std::make_unique<Node>()) {}

VariableModel::~VariableModel() = default;

std::unique_ptr<VariableModel::Node> VariableModel::build() const {
  auto root = std::make_unique<Node>();
  const LookPtr& look = debugger_.values();
  const auto add = [&](Node* group, const QString& expression, const QString& type, bool is_watch) {
    Node* node = group->add(expression);
    node->target = {expression, expression, -1, is_watch};
    node->type = type;
    if (!look) return;
    for (const auto& [refused, reason] : look->refused)
      if (QString::fromStdString(refused) == expression) node->refused = QString::fromStdString(reason);
    const session::WatchedValues* value = valueOf(look, *node);
    if (value == nullptr) return;
    node->type = QString::fromStdString(frontend::glslName(value->type));
    const auto components = frontend::components(value->type);
    if (components.size() < 2) return;
    for (std::size_t i = 0; i < components.size(); ++i) {
      Node* part = node->add(QString::fromStdString(components[i].access));
      part->target = {expression + part->name, expression, static_cast<int>(i), is_watch};
    }
  };
  if (!debugger_.watches().isEmpty()) {
    Node* group = root->add(tr("Watches"));
    for (const QString& watch : debugger_.watches()) add(group, watch, {}, true);
  }
  if (!debugger_.place()) return root;
  for (const char* name : {"Local", "Global", "Outputs", "Inputs and uniforms"}) {
    Node* group = nullptr;
    const auto& scope = debugger_.place()->scope;
    for (auto entry = scope.rbegin(); entry != scope.rend(); ++entry) {
      if (std::string_view(groupOf(entry->storage)) != name) continue;
      if (group == nullptr) group = root->add(tr(name));
      add(group, QString::fromStdString(entry->name), QString::fromStdString(entry->type), false);
    }
  }
  return root;
}

void VariableModel::refresh() {
  auto next = build();
  if (root_->sameShape(*next)) {
    root_->takeOver(*next);
    for (int row = 0; row < rowCount(); ++row) {
      const QModelIndex group = index(row, 0);
      const int rows = rowCount(group);
      if (rows > 0) Q_EMIT dataChanged(index(0, 0, group), index(rows - 1, kColumns - 1, group));
      for (int i = 0; i < rows; ++i) {
        const QModelIndex variable = index(i, 0, group);
        if (const int parts = rowCount(variable); parts > 0)
          Q_EMIT dataChanged(index(0, 0, variable), index(parts - 1, kColumns - 1, variable));
      }
    }
    return;
  }
  beginResetModel();
  root_ = std::move(next);
  endResetModel();
}

// ---- the tree

QModelIndex VariableModel::index(int row, int column, const QModelIndex& parent) const {
  const Node* node = parent.isValid() ? static_cast<const Node*>(parent.internalPointer()) : root_.get();
  if (row < 0 || row >= static_cast<int>(node->children.size())) return {};
  return createIndex(row, column, node->children[static_cast<std::size_t>(row)].get());
}

QModelIndex VariableModel::parent(const QModelIndex& child) const {
  if (!child.isValid()) return {};
  Node* parent = static_cast<const Node*>(child.internalPointer())->parent;
  return parent == nullptr || parent == root_.get() ? QModelIndex() : createIndex(parent->row, 0, parent);
}

int VariableModel::rowCount(const QModelIndex& parent) const {
  if (parent.column() > 0) return 0;
  const Node* node = parent.isValid() ? static_cast<const Node*>(parent.internalPointer()) : root_.get();
  return static_cast<int>(node->children.size());
}

VariableModel::Target VariableModel::targetAt(const QModelIndex& index) const {
  return index.isValid() ? static_cast<const Node*>(index.internalPointer())->target : Target();
}

QString VariableModel::textOf(const QModelIndex& row) const {
  const Node& node = *static_cast<const Node*>(row.internalPointer());
  return node.target.expression.isEmpty() ? node.name : node.target.expression + " = " + valueText(node);
}

// Not looked at unless it is asked for.
bool VariableModel::isLarge(const Node& node) const {
  if (!debugger_.place() || node.target.is_watch) return false;
  const auto& scope = debugger_.place()->scope;
  return std::any_of(scope.begin(), scope.end(), [&](const ScopeEntry& entry) {
    return entry.large && QString::fromStdString(entry.name) == node.target.variable;
  });
}

// ---- what stands in it

const session::WatchedValues* VariableModel::valueOf(const LookPtr& look, const Node& node) const {
  const Look::Value* const found = look ? look->find(node.target.variable) : nullptr;
  return found == nullptr ? nullptr : &found->watched;
}

QString VariableModel::valueText(const Node& node) const {
  if (!node.refused.isEmpty()) return tr("not here");
  if (unwritten(node)) return tr("not written yet");
  const session::WatchedValues* value = valueOf(debugger_.values(), node);
  const auto thread = debugger_.pickedIndex();
  if (value == nullptr && debugger_.values() && isLarge(node)) return tr("large; Enter shows it");
  if (value == nullptr || !thread) return {};
  if (!debugger_.values()->threads.reachedAt(*thread)) return tr("does not get here");
  if (node.target.component < 0) return QString::fromStdString(session::formatValue(value->valueAt(*thread)));
  const std::uint32_t* word = value->at(*thread);
  const auto components = frontend::components(value->type);
  for (int i = 0; i < node.target.component; ++i)
    word += session::wordsPerComponent(components[static_cast<std::size_t>(i)].basic);
  return QString::fromStdString(
      session::formatComponent(components[static_cast<std::size_t>(node.target.component)].basic, word));
}

bool VariableModel::unwritten(const Node& node) const {
  return debugger_.unwritten(node.target.variable);
}

bool VariableModel::changed(const Node& node) const {
  const session::WatchedValues* now = valueOf(debugger_.values(), node);
  const session::WatchedValues* before = valueOf(debugger_.previousValues(), node);
  if (now == nullptr || before == nullptr || now->type != before->type) return false;
  const auto here = debugger_.picked().in(debugger_.values()->threads);
  const auto there = debugger_.picked().in(debugger_.previousValues()->threads);
  if (!here || !there || !debugger_.values()->threads.reachedAt(*here) ||
      !debugger_.previousValues()->threads.reachedAt(*there))
    return false;
  std::size_t first = 0;
  std::size_t count = now->stride;
  if (node.target.component >= 0) {
    const auto components = frontend::components(now->type);
    for (int i = 0; i < node.target.component; ++i)
      first +=
          static_cast<std::size_t>(session::wordsPerComponent(components[static_cast<std::size_t>(i)].basic));
    count = static_cast<std::size_t>(
        session::wordsPerComponent(components[static_cast<std::size_t>(node.target.component)].basic));
  }
  return !std::equal(now->at(*here) + first, now->at(*here) + first + count, before->at(*there) + first);
}

// Rounded to what a column shows; exactly in its tooltip.
QVariant VariableModel::range(const Node& node, bool high, bool exactly) const {
  const Look::Value* const found =
      debugger_.values() ? debugger_.values()->find(node.target.variable) : nullptr;
  if (found == nullptr) return {};
  const bool single = frontend::components(found->watched.type).size() == 1;
  if (node.target.component < 0 && !single) return {};
  const auto component = static_cast<std::size_t>(std::max(node.target.component, 0));
  const auto& statistics = found->statistics(*debugger_.values());
  if (statistics[component].finite == 0) return {};
  const double number = high ? statistics[component].max : statistics[component].min;
  const frontend::Basic basic = frontend::components(found->watched.type)[component].basic;
  const QString exact = QString::fromStdString(basic == frontend::Basic::float_
                                                   ? profiler::exactText(static_cast<float>(number))
                                                   : profiler::exactText(number));
  constexpr int kShort = 9;  // characters
  const bool whole = basic != frontend::Basic::float_ && basic != frontend::Basic::double_;
  if (exactly || whole || exact.size() <= kShort) return exact;
  const QString rounded = QString::number(number, 'g', 5);
  return rounded.contains('e') ? QString::number(number, 'g', 4) : rounded;
}

QVariant VariableModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const Node& node = *static_cast<const Node*>(index.internalPointer());
  const bool is_group = node.target.expression.isEmpty();
  if (role == Qt::DisplayRole) {
    switch (index.column()) {
      case kName:
        return node.name;
      case kValue:
        return is_group ? QString() : valueText(node);
      case kMin:
      case kMax:
        return is_group ? QVariant() : range(node, index.column() == kMax, false);
      default:
        return node.type;
    }
  }
  if (role == Qt::FontRole &&
      (index.column() == kValue || index.column() == kMin || index.column() == kMax)) {
    QFont font = monospaced();
    font.setBold(!is_group && index.column() == kValue && changed(node));
    return font;
  }
  if (role == Qt::FontRole && (is_group || changed(node))) {
    QFont font;
    font.setBold(true);
    return font;
  }
  if (role == Qt::ForegroundRole && index.column() != kName && index.column() != kValue) return theme().faint;
  if (role == Qt::ForegroundRole && (is_group || unwritten(node))) return theme().faint;
  if (role == Qt::ToolTipRole && !node.refused.isEmpty()) return node.refused;
  if (role == Qt::ToolTipRole && unwritten(node) && index.column() == kValue)
    return debugger_.values()->unwritten.count(node.target.variable.toStdString()) > 0
               ? tr("No thread has written it on the way here: what the driver holds there is no value")
               : tr("The picked thread has not written it on its way here; others may have");
  if (role == Qt::ToolTipRole && !is_group && index.column() == kValue) return valueText(node);
  if (role == Qt::ToolTipRole && !is_group && (index.column() == kMin || index.column() == kMax))
    return range(node, index.column() == kMax, true);
  if (role == Qt::ToolTipRole && index.column() == kName && !node.type.isEmpty())
    return node.type + " " + node.name;
  return {};
}

QVariant VariableModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Horizontal && role == Qt::ToolTipRole && section == kValue)
    return debugger_.pickedName();
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  switch (section) {
    case kName:
      return tr("Name");
    case kValue: {
      const QString name = shortNameOf(debugger_.picked());
      return name.isEmpty() ? tr("Value (pick a thread)") : tr("Value at %1").arg(name);
    }
    case kMin:
      return tr("Least");
    case kMax:
      return tr("Greatest");
    default:
      return tr("Type");
  }
}

}  // namespace shadestep::gui
