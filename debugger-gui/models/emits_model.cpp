#include "debugger-gui/models/emits_model.h"

#include <algorithm>

#include "debugger-gui/style/theme.h"
#include "session/values.h"

namespace shadestep::gui {

void EmitsModel::show(const EmitsPtr& emits, bool emitting_only) {
  beginResetModel();
  emits_ = emits;
  nodes_.clear();
  inputs_ = 0;
  if (emits_) build(emitting_only);
  endResetModel();
}

void EmitsModel::build(bool emitting_only) {
  for (std::size_t i = 0; i < emits_->inputs.size(); ++i) {
    const auto& runs = emits_->inputs[i].runs;
    const bool silent =
        std::all_of(runs.begin(), runs.end(), [](const auto& run) { return run.vertices == 0; });
    if (emitting_only && silent) continue;
    Node node;
    node.input = i;
    node.row = inputs_++;
    nodes_.push_back(node);
  }
  const auto childrenOf = [&](const Node& node) -> std::size_t {
    const session::InputPrimitive& input = emits_->inputs[node.input];
    if (node.level == Level::input) return input.runs.size();
    if (node.level == Level::run) return input.runs[node.run].outputs.size();
    if (node.level == Level::output) return input.runs[node.run].outputs[node.output].vertices.size();
    return 0;
  };
  for (std::size_t parent = 0; parent < nodes_.size(); ++parent) {
    const std::size_t count = childrenOf(nodes_[parent]);
    nodes_[parent].first = static_cast<int>(nodes_.size());
    nodes_[parent].children = static_cast<int>(count);
    for (std::size_t row = 0; row < count; ++row) {
      Node child = nodes_[parent];
      child.level = static_cast<Level>(static_cast<int>(child.level) + 1);
      child.parent = static_cast<int>(parent);
      child.row = static_cast<int>(row);
      child.children = 0;
      (child.level == Level::run      ? child.run
       : child.level == Level::output ? child.output
                                      : child.vertex) = row;
      nodes_.push_back(child);
    }
  }
}

session::ThreadName EmitsModel::runAt(const QModelIndex& index) const {
  if (!index.isValid()) return {};
  const Node& node = nodeAt(index);
  const session::InputPrimitive& input = emits_->inputs[node.input];
  if (input.runs.empty()) return {};
  session::ThreadName name = {{"primitive", input.primitive},
                              {"invocation", input.runs[node.run].invocation}};
  if (emits_->repeats) name.emplace_back("repeat", input.repeat);
  return name;
}

QModelIndex EmitsModel::rowOf(const session::ThreadName& run) const {
  for (int row = 0; row < inputs_; ++row) {
    const QModelIndex index = this->index(row, 0);
    session::ThreadName there = runAt(index);
    const auto same = [&](const char* part) {
      const auto value = [part](const session::ThreadName& name) {
        const auto found =
            std::find_if(name.begin(), name.end(), [part](const auto& one) { return one.first == part; });
        return found == name.end() ? 0 : found->second;
      };
      return value(run) == value(there);
    };
    if (same("primitive") && same("repeat")) return index;
  }
  return {};
}

QModelIndex EmitsModel::index(int row, int column, const QModelIndex& parent) const {
  if (row < 0 || row >= rowCount(parent)) return {};
  const int node = parent.isValid() ? nodeAt(parent).first + row : row;
  return createIndex(row, column, static_cast<quintptr>(node));
}

QModelIndex EmitsModel::parent(const QModelIndex& child) const {
  if (!child.isValid() || nodeAt(child).parent < 0) return {};
  const int parent = nodeAt(child).parent;
  return createIndex(nodes_[static_cast<std::size_t>(parent)].row, 0, static_cast<quintptr>(parent));
}

int EmitsModel::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return inputs_;
  return parent.column() > 0 ? 0 : nodeAt(parent).children;
}

int EmitsModel::columnCount(const QModelIndex&) const {
  return 1 + (emits_ ? static_cast<int>(emits_->outputs.size()) : 0);
}

QString EmitsModel::nameOf(const Node& node) const {
  const session::InputPrimitive& input = emits_->inputs[node.input];
  if (node.level == Level::input) {
    int vertices = 0;
    for (const session::GeometryRun& run : input.runs) vertices += run.vertices;
    QString name = tr("primitive %1").arg(input.primitive);
    if (emits_->repeats) name += tr(", repeat %1").arg(input.repeat);
    if (vertices == 0) return tr("%1: nothing").arg(name);
    return vertices == 1 ? tr("%1: one vertex").arg(name) : tr("%1: %2 vertices").arg(name).arg(vertices);
  }
  const session::GeometryRun& run = input.runs[node.run];
  if (node.level == Level::run) {
    QString name = run.outputs.size() == 1
                       ? tr("run %1: one output primitive").arg(run.invocation)
                       : tr("run %1: %2 output primitives").arg(run.invocation).arg(run.outputs.size());
    if (run.beyond_limit > 0) name += tr(", %1 vertices beyond the limit dropped").arg(run.beyond_limit);
    return name;
  }
  const session::OutputPrimitive& output = run.outputs[node.output];
  if (node.level == Level::vertex) return tr("vertex %1").arg(node.vertex);
  QString name =
      tr("%1 %2").arg(QString::fromStdString(emits_->primitive).replace('_', ' ')).arg(node.output);
  if (output.stream > 0) name += tr(", stream %1").arg(output.stream);
  return output.ill_formed ? tr("%1: too few vertices, dropped").arg(name) : name;
}

QVariant EmitsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const Node& node = nodeAt(index);
  const session::InputPrimitive& input = emits_->inputs[node.input];
  if (role == Qt::DisplayRole) {
    if (index.column() == 0) return nameOf(node);
    if (node.level != Level::vertex) return {};
    const session::OutputPrimitive& output = input.runs[node.run].outputs[node.output];
    const std::size_t which = static_cast<std::size_t>(index.column()) - 1;
    if (emits_->outputs[which].stream != output.stream) return {};
    return QString::fromStdString(session::formatValue(emits_->value(output.vertices[node.vertex], which)));
  }
  if (role == Qt::FontRole && index.column() > 0) return monospaced();
  if (role == Qt::ForegroundRole && node.level == Level::output &&
      input.runs[node.run].outputs[node.output].ill_formed)
    return theme().bad;
  if (role == Qt::ForegroundRole && node.level == Level::input && runAt(index).empty()) return theme().faint;
  return {};
}

QVariant EmitsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || role != Qt::DisplayRole) return {};
  if (section == 0) return tr("What is made of each primitive");
  const auto output = static_cast<std::size_t>(section) - 1;
  return emits_ && output < emits_->outputs.size() ? QString::fromStdString(emits_->outputs[output].name)
                                                   : QString();
}

}  // namespace shadestep::gui
