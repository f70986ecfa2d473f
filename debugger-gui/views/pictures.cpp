#include <QObject>
#include <algorithm>
#include <bit>
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
  // The first `count` of them.
  void numbers(const std::uint32_t* at, std::size_t count, float* into) const {
    for (std::size_t c = 0; c < count; ++c) {
      const std::uint32_t* word = at + words[c];
      into[c] = list[c].basic == frontend::Basic::float_
                    ? std::bit_cast<float>(*word)
                    : static_cast<float>(session::componentAsDouble(list[c].basic, word));
    }
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

// Where the threads lie.
struct Grid {
  static constexpr std::size_t kNobody = ~std::size_t{0};

  int width = 0, height = 0;
  std::vector<std::size_t> thread;  // on each pixel; empty: the pixel's index is its thread's
};

Grid gridOf(const session::ThreadValues& threads) {
  if (threads.identity.empty()) return {threads.width, threads.height, {}};
  const std::size_t count = threads.marks.size();
  Grid grid;
  std::vector<std::size_t> pixels(count);
  if (threads.identity.size() >= 3 && threads.identity[0].name == "x") {
    const auto number = [&](std::size_t axis, std::size_t i) {
      return static_cast<std::size_t>(*threads.identity[axis].at(i));
    };
    std::size_t most[3] = {0, 0, 0};
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) most[axis] = std::max(most[axis], number(axis, i));
    grid.width = static_cast<int>(most[0] + 1);
    grid.height = static_cast<int>((most[1] + 1) * (most[2] + 1));
    for (std::size_t i = 0; i < count; ++i)
      pixels[i] = number(0, i) + (most[0] + 1) * (number(1, i) + (most[1] + 1) * number(2, i));
  } else {
    grid.width = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    const std::size_t width = static_cast<std::size_t>(std::max(grid.width, 1));
    grid.height = static_cast<int>((count + width - 1) / width);
    // The first one at the upper left; rows count from below.
    for (std::size_t i = 0; i < count; ++i)
      pixels[i] = (static_cast<std::size_t>(grid.height) - 1 - i / width) * width + i % width;
  }
  grid.thread.assign(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height),
                     Grid::kNobody);
  for (std::size_t i = 0; i < count; ++i) grid.thread[pixels[i]] = i;
  return grid;
}

// A picture over the threads, so far empty: who is where, and who is at the place looked at.
std::shared_ptr<Picture> overThreads(const LookPtr& look, int components) {
  const session::ThreadValues& threads = look->threads;
  Grid grid = gridOf(threads);
  const auto picture = sized(grid.width, grid.height, components);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    const std::size_t thread = grid.thread.empty() ? p : grid.thread[p];
    if (thread != Grid::kNobody) picture->cells[p] = cellOf(threads.marks[thread]);
  }
  picture->threads = std::move(grid.thread);
  if (picture->threads.empty()) return picture;
  picture->name = [look](std::size_t thread) { return nameOf(look->threads, thread); };
  picture->who = [look](std::size_t thread) { return textOf(nameOf(look->threads, thread)); };
  picture->find = [look](const Picked& picked) { return picked.in(look->threads); };
  return picture;
}

QRgb rgb(const profiler::Color& color) {
  return qRgb(static_cast<int>(std::lround(255 * color.r)), static_cast<int>(std::lround(255 * color.g)),
              static_cast<int>(std::lround(255 * color.b)));
}

// How many channels texels have: what a format lacks is read as 0, 0, 1.
int channelsOf(const std::vector<float>& texels) {
  int channels = 1;
  for (std::size_t i = 0; i < texels.size() && channels < 4; i += 4) {
    if (texels[i + 3] != 1)
      channels = 4;
    else if (texels[i + 2] != 0)
      channels = 3;
    else if (texels[i + 1] != 0)
      channels = std::max(channels, 2);
  }
  return channels;
}

}  // namespace

PicturePtr pictureOfTarget(const TargetPtr& target, int output) {
  if (!target || output < 0 || output >= static_cast<int>(target->outputs.size())) return nullptr;
  const session::ColorOutput& color = target->outputs[static_cast<std::size_t>(output)];
  const auto picture = sized(target->width, target->height, 4);
  if (color.words.size() < picture->values.size()) return nullptr;
  const Components components(color.type);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    components.numbers(&color.words[p * 4], 4, &picture->values[p * 4]);
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
  const Look::Value* const found = look->find(name);
  if (found == nullptr) return nullptr;
  const session::WatchedValues& watched = found->watched;
  const Components components(watched.type);
  const std::size_t shown = std::min<std::size_t>(components.list.size(), 4);
  if (shown == 0) return nullptr;
  const auto picture = overThreads(look, static_cast<int>(shown));
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    if (picture->cells[p] != Picture::Cell::reached) continue;
    components.numbers(watched.at(picture->thread(p)), shown, &picture->values[p * shown]);
  }
  picture->title = name;
  picture->texts = [look, &watched, components, shown](std::size_t thread) {
    return components.texts(watched.at(thread), shown);
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
  const std::size_t threads = look->threads.marks.size();
  if (place.ways->front().mask.size() != threads) return nullptr;
  const auto picture = overThreads(look, 1);
  picture->colors.assign(picture->cells.size(), theme().no_thread.rgb());
  std::vector<int> sides(threads, -1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    const std::size_t thread = picture->thread(p);
    if (thread == Grid::kNobody) continue;
    if (picture->cells[p] == Picture::Cell::not_reached && place.at_loop) {
      picture->cells[p] = Picture::Cell::reached;
      picture->colors[p] = theme().left.rgb();
    }
    for (std::size_t s = 0; s < place.ways->size(); ++s) {
      if ((*place.ways)[s].mask[thread] == 0) continue;
      sides[thread] = static_cast<int>(s);
      picture->colors[p] = colorOfSide(place, s);
    }
  }
  picture->title = QObject::tr("branch outcome");
  picture->texts = [names = place.sides, sides = std::move(sides)](std::size_t thread) {
    return QStringList(sides[thread] < 0 ? QObject::tr("left before")
                                         : text(names[static_cast<std::size_t>(sides[thread])].name));
  };
  return picture;
}

PicturePtr pictureOfIterations(const LoopsPtr& loops, int loop) {
  if (!loops || loop < 0 || loop >= static_cast<int>(loops->loops.size())) return nullptr;
  const session::LoopReport& report = loops->loops[static_cast<std::size_t>(loop)];
  auto who = std::make_shared<session::ThreadValues>();
  who->width = loops->width;
  who->height = loops->height;
  who->marks = loops->marks;
  who->identity = loops->identity;
  const auto picture = overThreads(std::make_shared<Look>(std::move(who)), 1);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    if (picture->cells[p] == Picture::Cell::none) continue;
    picture->cells[p] = Picture::Cell::reached;
    picture->values[p] = static_cast<float>(report.iterations[picture->thread(p)]);
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
  if (const profiler::ThreadList& threads = profile->profile.threads; !threads.names.empty()) {
    picture->name = [profile](std::size_t thread) {
      const profiler::ThreadList& all = profile->profile.threads;
      session::ThreadName name;
      for (std::size_t i = 0; i < all.names.size() && thread < all.numbers.size(); ++i)
        if (all.types[i] == frontend::Basic::int_) name.emplace_back(all.names[i], all.numbers[thread][i]);
      return name;
    };
    picture->who = [profile](std::size_t thread) {
      const profiler::ThreadList& all = profile->profile.threads;
      QStringList parts;
      for (std::size_t i = 0; i < all.names.size() && thread < all.numbers.size(); ++i)
        parts.push_back(text(all.names[i] + " " + all.text(thread, i)));
      return parts.join(", ");
    };
  }
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

PicturePtr pictureOfTexture(const TexturePtr& texture) {
  if (!texture) return nullptr;
  const auto picture = sized(texture->width, texture->height, 4);
  const Components components(texture->type);
  for (std::size_t p = 0; p < picture->cells.size(); ++p) {
    components.numbers(&texture->words[p * 4], 4, &picture->values[p * 4]);
    picture->cells[p] = Picture::Cell::reached;
  }
  picture->scale = Picture::Scale::grey;
  picture->meaningful = channelsOf(picture->values);
  picture->title = text(texture->uniform);
  picture->who = [texture](std::size_t p) {
    const auto width = static_cast<std::size_t>(texture->width);
    const auto stride = static_cast<std::size_t>(texture->stride);
    return QObject::tr("texel %1, %2").arg(stride * (p % width)).arg(stride * (p / width));
  };
  picture->texts = [texture, components](std::size_t p) {
    return components.texts(&texture->words[p * 4], 4);
  };
  return picture;
}

}  // namespace shadestep::gui
