// The session file: what is debugged and what was marked in it, to come back to.
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {
namespace {
constexpr const char* kFormat = "shadestep session 1";
}

QByteArray Debugger::saved() const {
  QJsonArray breakpoints;
  for (auto at = breakpoints_.constBegin(); at != breakpoints_.constEnd(); ++at)
    breakpoints.append(QJsonObject{
        {"line", at.key()}, {"enabled", at->enabled}, {"condition", at->condition}, {"ignore", at->ignore}});
  const auto draw =
      stop_ ? std::pair(stop_->draw.stop.frame, stop_->draw.stop.draw) : std::pair(spec_.frame, spec_.draw);
  QJsonObject document{{"format", kFormat},
                       {"command", QJsonArray::fromStringList(spec_.command)},
                       {"environment", QJsonArray::fromStringList(spec_.environment)},
                       {"directory", spec_.directory},
                       {"frame", static_cast<qint64>(draw.first)},
                       {"draw", static_cast<qint64>(draw.second)},
                       {"breakpoints", breakpoints},
                       {"watches", QJsonArray::fromStringList(watches_)}};
  if (pixel_) document["pixel"] = QJsonArray{pixel_->x, pixel_->y};
  return QJsonDocument(document).toJson();
}

void Debugger::restore(const QByteArray& bytes) {
  const QJsonObject document = QJsonDocument::fromJson(bytes).object();
  if (document["format"] != kFormat)
    throw session::Error(session::Outcome::usage, "this is no session file of shadestep's");
  const auto strings = [&](const char* name) {
    QStringList list;
    for (const QJsonValue value : document[QLatin1String(name)].toArray()) list.push_back(value.toString());
    return list;
  };
  ProgramSpec spec;
  spec.command = strings("command");
  spec.environment = strings("environment");
  spec.directory = document["directory"].toString();
  spec.frame = static_cast<std::uint64_t>(document["frame"].toInteger());
  spec.draw = static_cast<std::uint64_t>(document["draw"].toInteger());
  if (spec.command.isEmpty())
    throw session::Error(session::Outcome::usage, "the session file names no program");
  breakpoints_.clear();
  for (const QJsonValue value : document["breakpoints"].toArray()) {
    const QJsonObject one = value.toObject();
    breakpoints_[one["line"].toInt()] = {one["enabled"].toBool(true), one["condition"].toString(),
                                         one["ignore"].toInt()};
  }
  watches_ = strings("watches");
  const QJsonArray pixel = document["pixel"].toArray();
  pixel_.reset();
  if (pixel.size() == 2) pixel_ = Pixel{pixel[0].toInt(), pixel[1].toInt()};
  Q_EMIT breakpointsChanged();
  Q_EMIT watchesChanged();
  Q_EMIT pixelChanged();
  start(spec);
}

}  // namespace shadestep::gui
