#include "profiler/counts.h"

#include <algorithm>
#include <numeric>

#include "profiler/profile_parts.h"

namespace shadestep::profiler {
namespace {

using frontend::StatementKind;
using instrumenter::Counted;

std::vector<Counted> everything(const frontend::Shader& shader) {
  std::vector<Counted> all;
  for (std::size_t i = 0; i < shader.statements.size(); ++i) {
    const StatementKind kind = shader.statements[i].kind;
    const int id = static_cast<int>(i);
    if (kind == StatementKind::block || kind == StatementKind::case_label ||
        shader.statements[i].function == frontend::kNone)
      continue;  // they only hold others
    all.push_back({Counted::Kind::runs, id});
    if (kind == StatementKind::if_ || kind == StatementKind::for_ || kind == StatementKind::while_ ||
        kind == StatementKind::do_while)
      all.push_back({Counted::Kind::taken, id});
  }
  for (std::size_t i = 0; i < shader.functions.size(); ++i)
    if (shader.functions[i].body != frontend::kNone && !shader.functions[i].is_main)
      all.push_back({Counted::Kind::entered, static_cast<int>(i)});
  const std::size_t fetches = instrumenter::textureFetches(shader).size();
  for (std::size_t i = 0; i < fetches; ++i) all.push_back({Counted::Kind::fetched, static_cast<int>(i)});
  return all;
}

class Counter {
 public:
  Counter(session::Session& session, const CostMap& covered, session::Check& check)
      : session_(session), covered_(covered), check_(check) {}

  // False, with nothing done, if the draw buffers do not hold so many.
  bool count(const std::vector<Counted>& batch) {
    const auto result = instrumenter::instrumentCount(session_.shader(), batch, session_.target());
    if (std::holds_alternative<instrumenter::Failure>(result) && batch.size() > 1) return false;
    const session::Captured captured = session_.capture(orThrow(result));
    check_.merge(captured.execution.check);
    for (std::size_t i = 0; i < batch.size(); ++i)
      counts_.sites.push_back({batch[i], keep(planeOf(captured, captured.layout.fields.at(i)))});
    return true;
  }
  Counts take() { return std::move(counts_); }

 private:
  std::vector<std::uint32_t> planeOf(const session::Captured& captured,
                                     const instrumenter::Field& field) const {
    const instrumenter::FieldDecoder decoder(captured.layout, field);
    std::vector<std::uint32_t> plane(covered_.state.size());
    std::vector<std::uint32_t> words(static_cast<std::size_t>(captured.threads.words()));
    for (std::size_t i = 0; i < plane.size(); ++i) {
      if (covered_.state[i] == PixelState::none) continue;
      captured.threads.read(i, words.data());
      decoder.decode(words.data(), &plane[i]);
    }
    return plane;
  }

  std::size_t keep(std::vector<std::uint32_t> plane) {
    const auto same = std::find(counts_.planes.begin(), counts_.planes.end(), plane);
    if (same != counts_.planes.end()) return static_cast<std::size_t>(same - counts_.planes.begin());
    counts_.planes.push_back(std::move(plane));
    return counts_.planes.size() - 1;
  }

  session::Session& session_;
  const CostMap& covered_;
  session::Check& check_;
  Counts counts_;
};

}  // namespace

const Counts::Site* Counts::find(const Counted& what) const {
  const auto found =
      std::find_if(sites.begin(), sites.end(), [&what](const Site& site) { return site.what == what; });
  return found == sites.end() ? nullptr : &*found;
}

std::uint64_t Counts::total(const Site& site) const {
  return std::accumulate(planes[site.plane].begin(), planes[site.plane].end(), std::uint64_t{0});
}

Counts countAll(session::Session& session, const CostMap& covered, session::Check& check) {
  const std::vector<Counted> all = everything(session.shader());
  // A word per count and one for the mark; carriers that take more per number are found out by asking.
  const instrumenter::Target target = session.target();
  std::size_t fit =
      static_cast<std::size_t>(std::max(1, 4 * (target.max_draw_buffers - target.used_draw_buffers) - 1));
  Counter counter(session, covered, check);
  for (std::size_t first = 0; first < all.size();) {
    const std::size_t end = std::min(first + fit, all.size());
    const std::vector<Counted> batch(all.begin() + static_cast<std::ptrdiff_t>(first),
                                     all.begin() + static_cast<std::ptrdiff_t>(end));
    if (counter.count(batch))
      first = end;
    else
      fit = batch.size() / 2;
  }
  return counter.take();
}

std::vector<std::vector<std::size_t>> groupsOf(const CostMap& map, Grain grain) {
  std::vector<std::vector<std::size_t>> groups;
  for (int y0 = 0; y0 < map.height; y0 += grain.height)
    for (int x0 = 0; x0 < map.width; x0 += grain.width) {
      std::vector<std::size_t> pixels;
      for (int y = y0; y < std::min(y0 + grain.height, map.height); ++y)
        for (int x = x0; x < std::min(x0 + grain.width, map.width); ++x)
          if (map.state[map.index(x, y)] != PixelState::none) pixels.push_back(map.index(x, y));
      if (!pixels.empty()) groups.push_back(std::move(pixels));
    }
  return groups;
}

double activeShare(const std::vector<std::uint32_t>& plane, const CostMap& covered, Grain grain) {
  double done = 0;
  double room = 0;
  for (int y0 = 0; y0 < covered.height; y0 += grain.height)
    for (int x0 = 0; x0 < covered.width; x0 += grain.width) {
      std::uint32_t most = 0;
      for (int y = y0; y < std::min(y0 + grain.height, covered.height); ++y)
        for (int x = x0; x < std::min(x0 + grain.width, covered.width); ++x) {
          most = std::max(most, plane[covered.index(x, y)]);
          done += plane[covered.index(x, y)];
        }
      room += static_cast<double>(most) * grain.width * grain.height;
    }
  return room > 0 ? done / room : 0;
}

}  // namespace shadestep::profiler
