// The values of chosen variables at one place, for all threads of the draw.
#include <iostream>
#include <set>

#include "cli/commands/debug.h"
#include "profiler/pictures/files.h"
#include "profiler/pictures/scatter_plot.h"
#include "profiler/pictures/value_image.h"
#include "session/hit_values.h"
#include "session/own_way.h"
#include "session/plan.h"
#include "session/text.h"
#include "session/values.h"

namespace shadestep::cli {
namespace {

using session::ThreadValues;
using session::WatchedValues;

session::PlaceSelection placeOf(const DebugOptions& options) {
  session::PlaceSelection place;
  std::string at = options.at;
  if (const auto colon = at.find(':'); colon != std::string::npos) at[colon] = ',';
  const std::vector<int> numbers = parseIntegers(at, "--at", 1, 2);
  place.line = numbers[0];
  place.column = numbers.size() > 1 ? numbers[1] : 0;
  if (place.line < 1 || place.column < 0) {
    throw session::Error(session::Outcome::usage,
                         "--at takes LINE or LINE:COL, counted from 1, not '" + options.at + "'");
  }
  if (!options.iteration.empty()) place.iteration = parseIntegers(options.iteration, "--iteration", 1, 64);
  for (const int iteration : place.iteration) {
    if (iteration < 0)
      throw session::Error(session::Outcome::usage,
                           "--iteration counts from 0, not '" + options.iteration + "'");
  }
  if (!options.call.empty()) place.call_lines = parseIntegers(options.call, "--call", 1, 64);
  place.after = options.after;
  return place;
}

// The one thread that was named beside the place.
struct Picked {
  std::size_t number = 0;
  std::string key;                  // in JSON
  std::string name;                 // for a person
  std::set<std::string> unwritten = {};  // values that it has not written on its way
};
constexpr const char* kNotWritten = "it has not written it on its way here";

std::optional<Picked> pickedBy(session::Session& session, const ThreadValues& threads,
                               const DebugOptions& options) {
  if (!options.pixel.empty())
    return Picked{pixelIndex(session, options.pixel), "at_pixel", "pixel " + options.pixel};
  const auto wanted = chosenThread(session.stage(), options, false);
  if (!wanted) return std::nullopt;
  const std::size_t found = session::requireThread(threads, *wanted);
  return Picked{found, "at_thread", identityText(threads, found)};
}

std::optional<session::ThreadName> nameOf(session::Session& session, const DebugOptions& options) {
  if (options.pixel.empty()) return chosenThread(session.stage(), options, false);
  const std::vector<int> pixel = parseIntegers(options.pixel, "--pixel", 2, 2);
  return session::pixelName(pixel[0], pixel[1]);
}

Json asJson(const ThreadValues& threads, const std::optional<Picked>& picked) {
  Json document;
  document["threads"] = {
      {"launched", threads.launched}, {"reached", threads.reached}, {"discarded", threads.discarded}};
  document["width"] = threads.width;
  document["height"] = threads.height;
  Json values = Json::object();
  for (const WatchedValues& watched : threads.values) {
    if (!watched.no_value.empty()) {
      values[watched.name] = {{"type", glslName(watched.type)}, {"no_value", watched.no_value}};
      continue;
    }
    const auto statistics = session::statistics(threads, watched);
    Json one;
    one["type"] = glslName(watched.type);
    std::uint64_t nan = 0;
    std::uint64_t inf = 0;
    const auto list = [&](auto member) {
      Json json = Json::array();
      for (const auto& component : statistics) {
        json.push_back(component.finite == 0 ? Json(nullptr) : number(component.*member));
      }
      return json.size() == 1 ? json[0] : json;
    };
    one["min"] = list(&session::ComponentStatistics::min);
    one["max"] = list(&session::ComponentStatistics::max);
    one["mean"] = list(&session::ComponentStatistics::mean);
    for (const auto& component : statistics) {
      nan += component.nan;
      inf += component.inf;
    }
    one["nan"] = nan;
    one["inf"] = inf;
    if (picked) {
      const std::size_t thread = picked->number;
      const bool written = picked->unwritten.count(watched.name) == 0;
      one[picked->key] =
          threads.reachedAt(thread) && written ? toJson(watched.valueAt(thread)) : Json(nullptr);
      if (!written) one[picked->key + "_no_value"] = kNotWritten;
    }
    values[watched.name] = std::move(one);
  }
  document["values"] = std::move(values);
  document["check"] = toJson(threads.check);
  return document;
}

void printText(const ThreadValues& threads, const DebugOptions& options,
               const std::optional<Picked>& picked) {
  const std::string forced = describe(options.fragments);
  if (!forced.empty()) std::cout << forced << "\n";
  std::cout << (options.after ? "after" : "before") << " line " << options.at;
  if (!options.iteration.empty()) std::cout << ", iteration " << options.iteration;
  std::cout << ": " << withThousands(threads.reached) << " of " << withThousands(threads.launched)
            << " threads get there"
            << (threads.discarded == 0 ? "" : "; " + withThousands(threads.discarded) + " end in a discard")
            << "\n"
            << describe(threads.check) << "\n";
  for (const WatchedValues& watched : threads.values) {
    std::cout << "\n" << watched.name << " (" << glslName(watched.type) << ")\n";
    if (!watched.no_value.empty()) {
      std::cout << "  no value: " << watched.no_value << "\n";
      continue;
    }
    for (const auto& component : session::statistics(threads, watched)) {
      std::cout << "  " << (component.access.empty() ? "value" : component.access);
      if (component.finite > 0) {
        std::cout << "  min " << profiler::exactText(component.min) << "  max "
                  << profiler::exactText(component.max) << "  mean " << component.mean;
      } else {
        std::cout << "  no finite value";
      }
      if (component.nan > 0) std::cout << "  NaN in " << withThousands(component.nan) << " threads";
      if (component.inf > 0) std::cout << "  infinite in " << withThousands(component.inf) << " threads";
      std::cout << "\n";
    }
    if (picked) {
      std::cout << "  at " << picked->name << ": "
                << (!threads.reachedAt(picked->number) ? "does not get there"
                    : picked->unwritten.count(watched.name) > 0
                        ? std::string("no value: ") + kNotWritten
                        : session::formatValue(watched.valueAt(picked->number)))
                << "\n";
    }
  }
}

profiler::ValueImage asImage(const ThreadValues& threads, const WatchedValues& watched) {
  const auto components = frontend::components(watched.type);
  if (components.size() > 4) {
    throw session::Error(session::Outcome::usage,
                         "'" + watched.name + "' has " + std::to_string(components.size()) +
                             " components; --image shows at most 4: print a part of it");
  }
  profiler::ValueImage image;
  image.width = threads.width;
  image.height = threads.height;
  for (const std::uint8_t mark : threads.marks) {
    image.state.push_back((mark & instrumenter::kReached) != 0 ? profiler::ThreadState::reached
                          : mark != 0                          ? profiler::ThreadState::not_reached
                                                               : profiler::ThreadState::none);
  }
  std::size_t word = 0;
  for (const auto& component : components) {
    std::vector<double> plane(threads.marks.size(), 0.0);
    for (std::size_t p = 0; p < plane.size(); ++p) {
      if (threads.reachedAt(p)) plane[p] = session::componentAsDouble(component.basic, watched.at(p) + word);
    }
    image.components.push_back(std::move(plane));
    word += static_cast<std::size_t>(session::wordsPerComponent(component.basic));
  }
  return image;
}

void writeImage(const std::string& path, const ThreadValues& threads, const DebugOptions& options) {
  if (threads.values.empty()) throw session::Error(session::Outcome::usage, "--image needs --print NAME");
  const WatchedValues& watched = threads.values.front();
  if (!watched.no_value.empty())
    throw session::Error(session::Outcome::cannot_debug,
                         "'" + watched.name + "' has no value to show: " + watched.no_value);
  const profiler::ValueImage image = asImage(threads, watched);
  if (path.ends_with(".exr")) {
    profiler::writeValueExr(path, image);
  } else if (path.ends_with(".png")) {
    profiler::ValueImageText text;
    text.title = watched.name + " (" + glslName(watched.type) + ")";
    text.subtitle = std::string(options.after ? "after" : "before") + " line " + options.at +
                    (options.iteration.empty() ? "" : ", iteration " + options.iteration);
    profiler::writeFile(path, profiler::drawValueImage(image, text));
  } else {
    throw session::Error(session::Outcome::usage,
                         "--image takes a file that ends in .png or .exr, not '" + path + "'");
  }
}

// The printed values' components over the threads that got there, in order.
std::vector<profiler::ScatterAxis> axesOf(const ThreadValues& threads) {
  std::vector<profiler::ScatterAxis> axes;
  for (const WatchedValues& watched : threads.values) {
    if (!watched.no_value.empty()) continue;
    std::size_t word = 0;
    for (const auto& component : frontend::components(watched.type)) {
      profiler::ScatterAxis axis;
      axis.name = watched.name + component.access;
      for (std::size_t p = 0; p < threads.marks.size(); ++p) {
        if (threads.reachedAt(p))
          axis.values.push_back(session::componentAsDouble(component.basic, watched.at(p) + word));
      }
      axes.push_back(std::move(axis));
      word += static_cast<std::size_t>(session::wordsPerComponent(component.basic));
    }
  }
  return axes;
}

void writeScatter(const std::string& path, const ThreadValues& threads, const DebugOptions& options) {
  std::vector<profiler::ScatterAxis> axes = axesOf(threads);
  if (axes.size() < 2)
    throw session::Error(
        session::Outcome::usage,
        "--scatter shows two printed values against each other, coloured by a third: --print X,Y[,C]");
  profiler::ScatterPlot plot;
  plot.title = axes[1].name + " over " + axes[0].name;
  plot.subtitle = std::string(options.after ? "after" : "before") + " line " + options.at + ", " +
                  withThousands(threads.reached) + " threads";
  plot.x = std::move(axes[0]);
  plot.y = std::move(axes[1]);
  if (axes.size() > 2) plot.shade = std::move(axes[2]);
  profiler::writeFile(path, profiler::drawScatterPlot(plot));
}

session::Position positionOf(const instrumenter::Probe& probe) {
  session::Position position;
  position.call_path = probe.call_path;
  position.statement = probe.statement;
  position.iterations = probe.iterations;
  position.condition = probe.when == instrumenter::Probe::When::after;  // the statement itself has run
  return position;
}

// What the picked thread has not written, though it is there.
void findUnwritten(session::Session& session, const session::Position& position, const ThreadValues& threads,
                   const session::ThreadName& name, Picked& picked) {
  if (!threads.reachedAt(picked.number)) return;
  session::OwnWay way(session, name);
  for (const WatchedValues& watched : threads.values)
    if (watched.no_value.empty() && !way.hasWritten(position, watched.name))
      picked.unwritten.insert(watched.name);
}

// For one place a single probe is the cheapest.
ThreadValues look(session::Session& session, const session::PlaceSelection& place,
                  const DebugOptions& options) {
  session::Plan plan = session::planByName(options.plan).value_or(session::Plan::automatic);
  if (plan == session::Plan::automatic) plan = session::Plan::single;
  const frontend::Shader& shader = session.shader();
  instrumenter::Probe probe = session::probeAt(shader, place);
  probe.watches = session::watchesAt(shader, probe, splitList(options.print));
  return session::makePlan(session, plan)->valuesAt(probe);
}

}  // namespace

int debugValues(session::Session& session, const Common& common, const DebugOptions& options) {
  const session::PlaceSelection place = placeOf(options);
  if (session.stage() != session::Stage::fragment && !options.image.empty())
    throw session::Error(session::Outcome::usage,
                         "--image shows fragments, which have a place; take --csv F");
  if (!options.pixel.empty()) pixelIndex(session, options.pixel);  // throws before the work begins
  ThreadValues threads = look(session, place, options);
  const session::Position position = positionOf(session::probeAt(session.shader(), place));
  session::leaveOutUnwritten(session.shader(), position, threads);
  if (threads.reached == 0) {
    throw session::Error(session::Outcome::nothing_matches,
                         "none of the " + withThousands(threads.launched) + " threads gets to line " +
                             options.at +
                             (options.iteration.empty() ? "" : " in iteration " + options.iteration) +
                             "; 'shadestep loops' says how many iterations there are");
  }
  std::optional<Picked> picked = pickedBy(session, threads, options);
  if (picked) findUnwritten(session, position, threads, *nameOf(session, options), *picked);
  if (!options.image.empty()) {
    for (const std::string& file : splitList(options.image)) writeImage(common.inOut(file), threads, options);
  }
  if (!options.csv.empty()) profiler::writeFile(common.inOut(options.csv), session::asCsv(threads));
  if (!options.scatter.empty()) writeScatter(common.inOut(options.scatter), threads, options);
  if (common.json) {
    Json document = asJson(threads, picked);
    document["fragments"] = toJson(options.fragments);
    print(document);
  } else {
    printText(threads, options, picked);
  }
  return threads.check.compared_at_all && !threads.check.identical()
             ? static_cast<int>(session::Outcome::failed)
             : 0;
}

int debugHit(session::Session& session, const Common& common, const DebugOptions& options) {
  const session::PlaceSelection place = placeOf(options);
  const std::vector<int> pixel = parseIntegers(options.pixel, "--pixel", 2, 2);
  const session::HitValues found =
      session::valuesOfHit(session, pixel[0], pixel[1], options.hit, place, splitList(options.print));
  if (!found.reached) {
    throw session::Error(session::Outcome::nothing_matches,
                         "fragment " + std::to_string(found.hit) + " of " + std::to_string(found.hits.count) +
                             " on pixel " + options.pixel + " does not get to line " + options.at +
                             (options.iteration.empty() ? "" : " in iteration " + options.iteration));
  }
  const bool visible = found.hit == found.hits.visible;
  const bool discarded = found.hits.discarded[static_cast<std::size_t>(found.hit)];
  if (common.json) {
    Json document;
    document["thread"] = {
        {"stage", "fragment"},      {"x", pixel[0]},      {"y", pixel[1]},         {"hit", found.hit},
        {"hits", found.hits.count}, {"visible", visible}, {"discarded", discarded}};
    Json values = Json::object();
    for (const session::NamedValue& one : found.values)
      values[one.name] = {{"type", glslName(one.value.type)}, {"value", toJson(one.value)}};
    document["values"] = std::move(values);
    document["check"] = toJson(found.check);
    document["fragments"] = toJson(options.fragments);
    print(document);
  } else {
    const std::string forced = describe(options.fragments);
    if (!forced.empty()) std::cout << forced << "\n";
    std::cout << (options.after ? "after" : "before") << " line " << options.at << ", pixel " << options.pixel
              << ": fragment " << found.hit << " of " << found.hits.count << ", "
              << (visible     ? "the visible one"
                  : discarded ? "discarded later"
                              : "hidden")
              << "\n"
              << describe(found.check) << "\n\n";
    for (const session::NamedValue& one : found.values)
      std::cout << one.name << " = " << session::formatValue(one.value) << "\n";
  }
  return found.check.compared_at_all && !found.check.identical() ? static_cast<int>(session::Outcome::failed)
                                                                 : 0;
}

}  // namespace shadestep::cli
