#include <QObject>
#include <algorithm>
#include <cmath>

#include "debugger-gui/style/theme.h"
#include "debugger-gui/views/picture.h"
#include "profiler/pictures/colors.h"
#include "profiler/pictures/ticks.h"
#include "session/values.h"

namespace shadestep::gui {
namespace {

QString text(const std::string& string) {
  return QString::fromStdString(string);
}

Picture::Cell cellOf(std::uint8_t mark) {
  if ((mark & instrumenter::kReached) != 0) return Picture::Cell::reached;
  return mark != 0 ? Picture::Cell::not_reached : Picture::Cell::none;
}

// The components of one value type, as numbers and as exact texts.
struct Components {
  std::vector<frontend::Component> list;
  std::vector<std::size_t> words;  // where each begins

  explicit Components(const frontend::Type& type) : list(frontend::components(type)) {
    std::size_t word = 0;
    for (const frontend::Component& one : list) {
      words.push_back(word);
      word += static_cast<std::size_t>(session::wordsPerComponent(one.basic));
    }
  }
  float number(std::size_t component, const std::uint32_t* at) const {
    return static_cast<float>(session::componentAsDouble(list[component].basic, at + words[component]));
  }
  QStringList texts(const std::uint32_t* at, std::size_t most) const {
    QStringList result;
    for (std::size_t i = 0; i < std::min(most, list.size()); ++i)
      result.push_back(text(session::formatComponent(list[i].basic, at + words[i])));
    return result;
  }
};

std::shared_ptr<Picture> sized(int width, int height, int components) {
  auto picture = std::make_shared<Picture>();
  picture->width = width;
  picture->height = height;
  picture->components = components;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture->cells.assign(pixels, Picture::Cell::none);
  picture->values.assign(pixels * static_cast<std::size_t>(components), 0.0F);
  return picture;
}

QRgb rgb(const profiler::Color& color) {
  return qRgb(static_cast<int>(std::lround(255 * color.r)), static_cast<int>(std::lround(255 * color.g)),
              static_cast<int>(std::lround(255 * color.b)));
}

}  // namespace

PicturePtr pictureOfTarget(const TargetPtr& target, int output) {
  if (!target || output < 0 || output >= static_cast<int>(target->outputs.size())) return nullptr;
  const session::ColorOutput& color = target->outputs[static_cast<std::size_t>(output)];
  const auto picture = sized(target->width, target->height, 4);
  if (color.words.size() < picture->values.size()) return nullptr;
  const Components components(color.type);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    for (std::size_t c = 0; c < 4; ++c)
      picture->values[p * 4 + c] = components.number(c, &color.words[p * 4]);
    picture->cells[p] = Picture::Cell::reached;
  }
  picture->as_is = color.type.basic == frontend::Basic::float_;
  picture->title = QObject::tr("colour output %1").arg(color.draw_buffer);
  picture->texts = [target, output, components](std::size_t p) {
    return components.texts(&target->outputs[static_cast<std::size_t>(output)].words[p * 4], 4);
  };
  return picture;
}

PicturePtr pictureOfValue(const LookPtr& look, const QString& name) {
  if (!look) return nullptr;
  const session::ThreadValues& threads = look->threads;
  const auto found = std::find_if(threads.values.begin(), threads.values.end(),
                                  [&](const auto& value) { return text(value.name) == name; });
  if (found == threads.values.end()) return nullptr;
  const Components components(found->type);
  const std::size_t shown = std::min<std::size_t>(components.list.size(), 4);
  if (shown == 0) return nullptr;
  const auto picture = sized(threads.width, threads.height, static_cast<int>(shown));
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    picture->cells[p] = cellOf(threads.marks[p]);
    if (picture->cells[p] != Picture::Cell::reached) continue;
    for (std::size_t c = 0; c < shown; ++c)
      picture->values[p * shown + c] = components.number(c, found->at(p));
  }
  picture->title = name;
  const auto which = static_cast<std::size_t>(found - threads.values.begin());
  picture->texts = [look, which, components, shown](std::size_t p) {
    return components.texts(look->threads.values[which].at(p), shown);
  };
  return picture;
}

QRgb colorOfSide(const Place& place, std::size_t side) {
  const std::string& name = place.sides[side].name;
  if (name == "true") return theme().yes.rgb();
  if (name == "false") return theme().no.rgb();
  return rgb(profiler::categoricalColor(static_cast<int>(side)));
}

// Thesis fig. 7.5: true green, false red, and orange the threads that have left the loop before.
PicturePtr pictureOfOutcome(const Place& place, const LookPtr& look) {
  if (!place.ways || place.ways->empty() || !look) return nullptr;
  const session::ThreadValues& threads = look->threads;
  const auto picture = sized(threads.width, threads.height, 1);
  if (place.ways->front().mask.size() != picture->cells.size()) return nullptr;
  picture->colors.assign(picture->cells.size(), theme().no_thread.rgb());
  std::vector<int> sides(picture->cells.size(), -1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    picture->cells[p] = cellOf(threads.marks[p]);
    if (picture->cells[p] == Picture::Cell::not_reached && place.at_loop) {
      picture->cells[p] = Picture::Cell::reached;
      picture->colors[p] = theme().left.rgb();
    }
    for (std::size_t s = 0; s < place.ways->size(); ++s) {
      if ((*place.ways)[s].mask[p] == 0) continue;
      sides[p] = static_cast<int>(s);
      picture->colors[p] = colorOfSide(place, s);
    }
  }
  picture->title = QObject::tr("branch outcome");
  picture->texts = [names = place.sides, sides = std::move(sides)](std::size_t p) {
    return QStringList(sides[p] < 0 ? QObject::tr("left before")
                                    : text(names[static_cast<std::size_t>(sides[p])].name));
  };
  return picture;
}

PicturePtr pictureOfIterations(const LoopsPtr& loops, int loop) {
  if (!loops || loop < 0 || loop >= static_cast<int>(loops->loops.size())) return nullptr;
  const session::LoopReport& report = loops->loops[static_cast<std::size_t>(loop)];
  const auto picture = sized(loops->width, loops->height, 1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    picture->cells[p] = loops->marks[p] != 0 ? Picture::Cell::reached : Picture::Cell::none;
    picture->values[p] = static_cast<float>(report.iterations[p]);
  }
  picture->scale = Picture::Scale::cost;
  picture->title = QObject::tr("iterations of the loop at line %1").arg(report.line);
  picture->texts = [loops, loop](std::size_t p) {
    return QStringList(QString::number(loops->loops[static_cast<std::size_t>(loop)].iterations[p]));
  };
  return picture;
}

PicturePtr pictureOfCost(const ProfilePtr& profile) {
  if (!profile) return nullptr;
  const profiler::CostMap& map = profile->profile.map;
  const auto picture = sized(map.width, map.height, 1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    picture->cells[p] =
        map.state[p] == profiler::PixelState::none ? Picture::Cell::none : Picture::Cell::reached;
    picture->values[p] = static_cast<float>(map.cost[p]);
  }
  picture->scale = Picture::Scale::cost;
  picture->title = QObject::tr("cost (%1)").arg(text(profile->profile.unit));
  picture->texts = [profile](std::size_t p) {
    QString line = text(profiler::readable(profile->profile.map.cost[p]) + " " + profile->profile.unit);
    if (p < profile->profile.uncertainty.size() && profile->profile.uncertainty[p] > 0)
      line += " ± " + text(profiler::readable(profile->profile.uncertainty[p], 2));
    if (profile->profile.map.state[p] == profiler::PixelState::reconstructed)
      line += QObject::tr(" (reconstructed)");
    return QStringList(line);
  };
  return picture;
}

PicturePtr pictureOfDifference(const ProfilePtr& profile) {
  if (!profile || !profile->comparison) return nullptr;
  const profiler::CostMap& map = profile->profile.map;
  const auto picture = sized(map.width, map.height, 1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    picture->cells[p] =
        map.state[p] == profiler::PixelState::none ? Picture::Cell::none : Picture::Cell::reached;
    const bool counts = profile->comparison->significant[p] != 0;
    picture->values[p] = counts ? static_cast<float>(profile->comparison->difference[p]) : 0.0F;
  }
  picture->scale = Picture::Scale::difference;
  picture->title = QObject::tr("cost now - before (%1)").arg(text(profile->profile.unit));
  picture->texts = [profile](std::size_t p) {
    return QStringList(
        text(profiler::readable(profile->comparison->difference[p])) +
        (profile->comparison->significant[p] != 0 ? QString() : QObject::tr(" (within the noise)")));
  };
  return picture;
}

}  // namespace shadestep::gui
