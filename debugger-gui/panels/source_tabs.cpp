#include "debugger-gui/panels/source_tabs.h"

#include <QTabBar>

#include "debugger-gui/panels/breakpoint_dialog.h"
#include "debugger-gui/style/theme.h"
#include "debugger-gui/views/check_badge.h"
#include "session/values.h"

namespace shadestep::gui {

SourceTabs::SourceTabs(Debugger& debugger, QWidget* parent) : QTabWidget(parent), debugger_(debugger) {
  setDocumentMode(true);
  connect(&debugger_, &Debugger::stopChanged, this, &SourceTabs::refresh);
  connect(&debugger_, &Debugger::stageChanged, this, &SourceTabs::refreshStage);
  connect(&debugger_, &Debugger::placeChanged, this, &SourceTabs::refreshPlace);
  connect(&debugger_, &Debugger::profileChanged, this, &SourceTabs::refreshCosts);
  connect(&debugger_, &Debugger::breakpointsChanged, this, &SourceTabs::refreshBreakpoints);
  connect(this, &QTabWidget::currentChanged, this, [this](int tab) {
    const auto* view = qobject_cast<SourceView*>(widget(tab));
    if (view != nullptr) debugger_.selectStage(view->source().stage);
  });
}

SourceView* SourceTabs::viewOf(int line) const {
  for (auto at = views_.constBegin(); at != views_.constEnd(); ++at)
    if (at.key().first == debugger_.stage() && at.value()->has(line)) return at.value();
  return nullptr;
}

SourceView* SourceTabs::here() const {
  const auto& place = debugger_.place();
  SourceView* view = place && !place->ended ? viewOf(place->line) : nullptr;
  return view != nullptr ? view : views_.value({debugger_.stage(), 0});
}

void SourceTabs::showLine(int line) {
  SourceView* view = viewOf(line);
  if (view == nullptr) return;
  setCurrentWidget(view);
  view->showLine(line);
}

void SourceTabs::refresh() {
  const auto& stop = debugger_.stop();
  if (!stop) return refreshPlace();
  const QSignalBlocker quiet(this);
  // Tabs that were there stay as they are.
  for (const Part& part : views_.keys()) {
    const StageSource* source = debugger_.source(part.first);
    if (source == nullptr || part.second > static_cast<int>(source->included.size()))
      delete views_.take(part);
  }
  for (const StageSource& source : stop->stages)
    for (int number = 0; number <= static_cast<int>(source.included.size()); ++number)
      refreshPart(source, number);
  refreshStage();
  refreshCosts();
}

void SourceTabs::refreshPart(const StageSource& source, int number) {
  const auto firstOf = [&](int part) {
    if (part > static_cast<int>(source.included.size())) return static_cast<int>(source.lines.size()) + 1;
    return part == 0 ? 1 : source.included[static_cast<std::size_t>(part) - 1].first_line;
  };
  const Part part{source.stage, number};
  SourceView*& view = views_[part];
  if (view == nullptr) {
    view = makeView();
    insertTab(static_cast<int>(std::distance(views_.cbegin(), views_.constFind(part))), view, {});
  }
  view->setSource(source, firstOf(number), firstOf(number + 1) - 1);
  const int tab = indexOf(view);
  const QString stage = QString::fromUtf8(session::stageName(source.stage));
  if (number == 0) {
    setTabText(tab, stage);
    setTabToolTip(tab, QString::fromStdString(source.reason));
  } else {
    const QString name = QString::fromStdString(source.included[static_cast<std::size_t>(number) - 1].name);
    setTabText(tab, name.section('/', -1));
    setTabToolTip(tab, tr("%1, included by the %2 shader").arg(name, stage));
  }
  tabBar()->setTabTextColor(tab, source.reason.empty() ? QColor() : theme().faint);
}

SourceView* SourceTabs::makeView() {
  auto* view = new SourceView;
  view->setDescriber([this](const QString& expression) { return describe(expression); });
  connect(view, &SourceView::breakpointToggled, &debugger_, &Debugger::toggleBreakpoint);
  connect(view, &SourceView::breakpointEdited, this, &SourceTabs::editBreakpoint);
  connect(view, &SourceView::runToLineAsked, &debugger_, &Debugger::toLine);
  connect(view, &SourceView::watchAsked, &debugger_, &Debugger::addWatch);
  connect(view, &SourceView::pictureAsked, &debugger_, [this](const QString& expression) {
    debugger_.show({PictureSource::Kind::value, expression, 0});
  });
  return view;
}

void SourceTabs::refreshStage() {
  refreshPlace();
  refreshBreakpoints();
  const QSignalBlocker quiet(this);
  if (SourceView* view = here()) setCurrentWidget(view);
}

void SourceTabs::refreshPlace() {
  const auto& place = debugger_.place();
  const bool somewhere = debugger_.stop() && place && !place->ended;
  for (auto at = views_.constBegin(); at != views_.constEnd(); ++at) {
    const bool own = somewhere && at.key().first == place->stage;
    at.value()->setCurrent(own ? place->line : 0, somewhere && !place->sides.empty());
  }
  const QSignalBlocker quiet(this);
  if (SourceView* view = here(); view != nullptr && somewhere) setCurrentWidget(view);
}

void SourceTabs::refreshBreakpoints() {
  for (auto at = views_.constBegin(); at != views_.constEnd(); ++at)
    if (at.key().first == debugger_.stage()) at.value()->setBreakpoints(debugger_.breakpoints());
}

void SourceTabs::refreshCosts() {
  const ProfilePtr& profile = debugger_.profile();
  for (SourceView* view : views_) {
    const bool fits = debugger_.profileIsOfThisDraw() && profile->source == view->source().lines &&
                      profile->profile.stage == view->source().stage;
    view->setCosts(fits ? profile->profile.lines : std::vector<profiler::LineCost>());
  }
}

void SourceTabs::applyTheme() {
  for (SourceView* view : views_) view->applyTheme();
  refresh();
}

QString SourceTabs::describe(const QString& expression) const {
  const LookPtr& look = debugger_.values();
  if (!look) return {};
  QString variable = expression;
  while (!variable.isEmpty()) {
    if (debugger_.unwritten(variable))
      return QString("<b>%1</b>&nbsp; %2").arg(variable, tr("not written yet"));
    if (const Look::Value* const found = look->find(variable)) {
      const session::WatchedValues& value = found->watched;
      QStringList lines{QString("<b>%1</b>&nbsp; %2")
                            .arg(variable, QString::fromStdString(frontend::glslName(value.type)))};
      if (const auto thread = debugger_.pickedIndex())
        lines.push_back(
            look->threads.reachedAt(*thread)
                ? QString::fromStdString(session::formatValue(value.valueAt(*thread))).toHtmlEscaped()
                : tr("the picked thread does not get here"));
      lines.push_back(textOf(look->threads.check).rich());
      return lines.join("<br>");
    }
    const qsizetype cut = std::max(variable.lastIndexOf('.'), variable.lastIndexOf('['));
    if (cut < 0) return {};
    variable.truncate(cut);
  }
  return {};
}

void SourceTabs::editBreakpoint(int line) {
  auto* dialog = new BreakpointDialog(line, debugger_.breakpoints().value(line), this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QDialog::accepted, this,
          [this, dialog, line] { debugger_.setBreakpoint(line, dialog->breakpoint()); });
  dialog->show();
}

}  // namespace shadestep::gui
