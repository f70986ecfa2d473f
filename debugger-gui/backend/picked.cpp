#include "debugger-gui/backend/picked.h"

#include <QStringList>
#include <algorithm>

namespace shadestep::gui {

std::optional<std::size_t> Picked::in(const session::ThreadValues& threads) const {
  if (stage != session::Stage::fragment)
    return thread.empty() || threads.identity.empty() ? std::nullopt : threads.find(thread);
  if (!pixel || !threads.identity.empty() || pixel->x >= threads.width || pixel->y >= threads.height)
    return std::nullopt;
  return static_cast<std::size_t>(pixel->y) * static_cast<std::size_t>(threads.width) +
         static_cast<std::size_t>(pixel->x);
}

session::ThreadName nameOf(const session::ThreadValues& threads, std::size_t thread) {
  std::vector<const session::WatchedValues*> numbers;
  for (const session::WatchedValues& one : threads.identity)
    if (one.type.basic == frontend::Basic::int_) numbers.push_back(&one);
  session::ThreadName name;
  for (const session::WatchedValues* one : numbers)
    name.emplace_back(one->name, static_cast<std::int32_t>(*one->at(thread)));
  if (numbers.size() == threads.identity.size()) return name;
  // Coordinates are no numbers: these threads are counted.
  std::int32_t before = 0;
  for (std::size_t p = 0; p < thread; ++p) {
    const bool same = threads.marks[p] != 0 &&
                      std::all_of(numbers.begin(), numbers.end(),
                                  [&](const auto* one) { return *one->at(p) == *one->at(thread); });
    before += same ? 1 : 0;
  }
  name.emplace_back("vertex", before);
  return name;
}

QString textOf(const session::ThreadName& name) {
  QStringList parts;
  for (const auto& [part, number] : name)
    parts.push_back(QString("%1 %2").arg(QString::fromStdString(part)).arg(number));
  return parts.join(", ");
}

}  // namespace shadestep::gui
