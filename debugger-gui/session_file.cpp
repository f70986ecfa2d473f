// The session file: what is debugged and what was marked in it, to come back to.
#include <QCryptographicHash>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

#include <utility>

#include "debugger-gui/debugger.h"

namespace shadestep::gui {
namespace {
constexpr const char* kFormat = "shadestep session 1";

// Files of before there were other stages name none.
session::Stage stageIn(const QJsonObject& object) {
  return session::stageByName(object["stage"].toString("fragment").toStdString())
      .value_or(session::Stage::fragment);
}

QJsonArray numbersOf(const std::vector<int>& numbers) {
  QJsonArray array;
  for (const int number : numbers) array.append(number);
  return array;
}

std::vector<int> numbersIn(const QJsonValue& value) {
  std::vector<int> numbers;
  for (const QJsonValue number : value.toArray()) numbers.push_back(number.toInt());
  return numbers;
}

}  // namespace

// Of the shader that is looked at.
QByteArray Debugger::sourceMark() const {
  QCryptographicHash hash(QCryptographicHash::Sha1);
  if (const StageSource* source = this->source())
    for (const std::string& line : source->lines) hash.addData(QByteArray::fromStdString(line + "\n"));
  return hash.result().toHex();
}

void Debugger::resumePlace() {
  const auto saved = std::exchange(resume_at_, std::nullopt);
  if (!saved || saved->stage != stage()) return;
  if (saved->source != sourceMark())
    return Q_EMIT message(tr("The shader is another one than when the session was saved: it starts at main"),
                          false);
  askPlace(tr("Going to where it was left"),
           [position = saved->position](Debuggee& debuggee) { return debuggee.moveTo(position); });
}

QByteArray Debugger::saved() const {
  QJsonArray breakpoints;
  for (auto stage = breakpoints_.constBegin(); stage != breakpoints_.constEnd(); ++stage)
    for (auto at = stage->constBegin(); at != stage->constEnd(); ++at)
      breakpoints.append(QJsonObject{{"stage", session::stageName(stage.key())},
                                     {"line", at.key()},
                                     {"enabled", at->enabled},
                                     {"condition", at->condition},
                                     {"ignore", at->ignore}});
  QJsonArray thread;
  for (const auto& [name, number] : picked_.thread)
    thread.append(QJsonArray{QString::fromStdString(name), number});
  const auto draw =
      stop_ ? std::pair(stop_->draw.stop.frame, stop_->draw.stop.draw) : std::pair(spec_.frame, spec_.draw);
  QJsonObject document{{"format", kFormat},
                       {"command", QJsonArray::fromStringList(spec_.command)},
                       {"environment", QJsonArray::fromStringList(spec_.environment)},
                       {"directory", spec_.directory},
                       {"frame", static_cast<qint64>(draw.first)},
                       {"draw", static_cast<qint64>(draw.second)},
                       {"stage", session::stageName(stage())},
                       {"thread", thread},
                       {"breakpoints", breakpoints},
                       {"watches", QJsonArray::fromStringList(watches_)}};
  if (pixel()) document["pixel"] = QJsonArray{pixel()->x, pixel()->y};
  if (picture_.kind == PictureSource::Kind::value) document["picture"] = picture_.name;
  if (place_ && !place_->ended)
    document["place"] = QJsonObject{
        {"source", QString::fromLatin1(sourceMark())}, {"calls", numbersOf(place_->position.call_path)},
        {"statement", place_->position.statement},     {"iterations", numbersOf(place_->position.iterations)},
        {"condition", place_->position.condition},     {"calls done", place_->position.calls_done}};
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
    breakpoints_[stageIn(one)][one["line"].toInt()] = {one["enabled"].toBool(true),
                                                       one["condition"].toString(), one["ignore"].toInt()};
  }
  watches_ = strings("watches");
  const QJsonArray pixel = document["pixel"].toArray();
  Picked fragment;
  if (pixel.size() == 2) fragment.pixel = Pixel{pixel[0].toInt(), pixel[1].toInt()};
  picks_.clear();
  picked_ = fragment;
  if (stageIn(document) != session::Stage::fragment) {
    picks_[session::Stage::fragment] = fragment;
    picked_ = {stageIn(document), {}, {}};
    for (const QJsonValue part : document["thread"].toArray())
      picked_.thread.emplace_back(part[0].toString().toStdString(), part[1].toInt());
  }
  Q_EMIT stageChanged();
  Q_EMIT breakpointsChanged();
  Q_EMIT watchesChanged();
  Q_EMIT pickedChanged();
  picture_ = {};
  if (const QString name = document["picture"].toString(); !name.isEmpty())
    picture_ = {PictureSource::Kind::value, name, 0};
  Q_EMIT pictureChanged();
  start(spec);
  if (const QJsonObject place = document["place"].toObject(); !place.isEmpty()) {
    session::Position position;
    position.call_path = numbersIn(place["calls"]);
    position.statement = place["statement"].toInt();
    position.iterations = numbersIn(place["iterations"]);
    position.condition = place["condition"].toBool();
    position.calls_done = place["calls done"].toInt();
    resume_at_ = {stageIn(document), place["source"].toString().toLatin1(), std::move(position)};
  }
}

}  // namespace shadestep::gui
