#include "profiler/isolation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "profiler/profile_parts.h"

namespace shadestep::profiler {
namespace {

constexpr std::size_t kRequestBytes = 65536;  // a request is one packet of a socket
constexpr std::size_t kSetOverhead = 200;     // of one set of uniforms in a request
constexpr std::uint32_t kGlInt = 0x1404;
constexpr std::uint32_t kGlFloatVec4 = 0x8B52;
constexpr std::uint32_t kGlUintVec4 = 0x8DC8;

double fastest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

std::vector<double> nanoseconds(const std::vector<std::chrono::nanoseconds>& times) {
  std::vector<double> result;
  for (const std::chrono::nanoseconds time : times) result.push_back(static_cast<double>(time.count()));
  return result;
}

}  // namespace

TimerTest testTimer(double once, double twice, double thrice) {
  TimerTest test;
  test.ratio = (thrice - once) / (twice - once);
  test.trusted = twice > once && std::abs(test.ratio - 2) < 0.4;
  return test;
}

Isolation::Isolation(session::Session& session, const ProfileOptions& options)
    : session_(session), stage_(session.stage()) {
  const frontend::Shader& shader = session.shader();
  const bool reads_neighbours = shader.traits.uses_derivatives || instrumenter::readsInputsElsewhere(shader);
  if (stage_ == session::Stage::fragment && (reads_neighbours || options.quads))
    mode_ = instrumenter::Isolation::quad;
  const auto result = instrumenter::instrumentIsolate(shader, session.target(), mode_);
  shader_ = orThrow(result);
  captureInputs(shader_.inputs, options);
  prepare();
  chooseTimer();
}

void Isolation::prepare() {
  if (stage_ == session::Stage::fragment) {
    isolated_ = session_.prepareCovering(shader_.text, shader_.vertex_text);
    baseline_ = session_.prepareCovering(shader_.baseline_text, shader_.vertex_text);
    known_ = session_.prepareCovering(shader_.work_text, shader_.vertex_text);
    work_uniform_ = shader_.work_uniform;
    return;
  }
  isolated_ = session_.prepareText(shader_.text);
  baseline_ = session_.prepareText(shader_.baseline_text);
  const auto result = instrumenter::instrumentKnownWork(session_.shader(), session_.target(), false);
  const instrumenter::KnownWork& known = orThrow(result);
  known_ = session_.prepare(known.shader);
  work_uniform_ = known.work_uniform;
}

double Isolation::threadsDrawn(int size) const {
  return stage_ == session::Stage::fragment ? static_cast<double>(size) * size
                                            : static_cast<double>(covered().costs().size());
}

// Where the "GPU" is the CPU, the CPU time of the program's threads is the cost itself, and other programs'
// load does not disturb it. On a device of its own it is nearly nothing, and does not grow with the work.
void Isolation::chooseTimer() {
  constexpr int kSize = 32;
  constexpr int kRounds = 5;
  constexpr int kRepeats = 4;
  // Of few threads each has more to do.
  const int steps = static_cast<int>(std::clamp(300.0 * kSize * kSize / threadsDrawn(kSize), 300.0, 15000.0));
  timeKnown(kSize, steps, 2);  // the driver compiles
  for (const Timer::Kind kind : {Timer::Kind::cpu, Timer::Kind::wall}) {
    timer_.kind = kind;
    // In turns, so that a slow moment meets all three; the fastest counts.
    std::array<double, 3> times;
    times.fill(std::numeric_limits<double>::infinity());
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < times.size(); ++i)
        times[i] = std::min(times[i], fastest(timeKnown(kSize, steps * static_cast<int>(i + 1), kRepeats)));
      if (round >= 1 && testTimer(times[0], times[1], times[2]).trusted) return;
    }
    char numbers[160];
    std::snprintf(numbers, sizeof numbers,
                  "%.0f, %.0f and %.0f ns for one, two and three times the same work", times[0], times[1],
                  times[2]);
    timer_note_ += std::string(timer_note_.empty() ? "The " : " The ") + timer_.name() +
                   " does not run in proportion to the work (" + numbers + ").";
  }
  throw session::Error(session::Outcome::cannot_debug, "no timer can be trusted here. " + timer_note_ +
                                                           " Use --method clock or --method count");
}

// In every round another order: what disturbs periodically (a scheduler's slices) must not meet the same
// pixel again and again.
std::vector<std::vector<double>> Isolation::time(std::span<const std::size_t> pixels, int size, int repeats) {
  std::vector<std::size_t> order(pixels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::size_t> drawn;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::shuffle(order.begin(), order.end(), random_);
    drawn.insert(drawn.end(), order.begin(), order.end());
  }
  const std::size_t bytes =
      static_cast<std::size_t>(shader_.vectors_per_thread) * (quads() ? 64 : 16) + kSetOverhead;
  const std::size_t at_once = std::max<std::size_t>(1, kRequestBytes / bytes);
  std::vector<std::vector<double>> result(pixels.size());
  for (std::size_t first = 0; first < drawn.size(); first += at_once) {
    const std::span<const std::size_t> now =
        std::span(drawn).subspan(first, std::min(at_once, drawn.size() - first));
    session::ExecuteOptions execute;
    execute.covering_size = size;
    for (const std::size_t i : now) execute.sets.push_back(inputsOf(pixels[i]));
    const std::vector<double> times = draw(isolated_, execute);
    for (std::size_t i = 0; i < now.size(); ++i) result[now[i]].push_back(times[i]);
  }
  return result;
}

std::vector<double> Isolation::timeBaseline(int size, int repeats) {
  session::ExecuteOptions execute;
  execute.covering_size = size;
  execute.repeats = repeats;
  return draw(baseline_, execute);
}

std::vector<double> Isolation::timeKnown(int size, int steps, int repeats) {
  session::ExecuteOptions execute;
  execute.covering_size = size;
  execute.repeats = repeats;
  execute.uniforms = {{work_uniform_, kGlInt, {static_cast<std::uint32_t>(steps)}}};
  return draw(known_, execute);
}

void Isolation::captureInputs(const std::vector<instrumenter::IsolatedInput>& wanted,
                              const ProfileOptions& options) {
  const frontend::Shader& shader = session_.shader();
  instrumenter::Probe probe = instrumenter::inputsProbe(shader);
  // As many passes as the carrier of the values demands; the first also says which pixels have a thread.
  do {
    const auto result = instrumenter::instrumentSingle(shader, probe, session_.target());
    const session::Captured captured = session_.capture(orThrow(result));
    check_.merge(captured.execution.check);
    if (place_.map.cost.empty()) placeThreads(stage_, captured, options, place_);
    keep(captured, wanted);
    const std::size_t before = probe.watches.size();
    std::erase_if(probe.watches, [&](const frontend::Watch& watch) {
      return std::any_of(captured.layout.fields.begin(), captured.layout.fields.end(),
                         [&](const instrumenter::Field& field) { return field.name == watch.expression; });
    });
    if (probe.watches.size() == before && before > 0)
      throw session::Error(session::Outcome::cannot_debug,
                           "there is no room to capture the shader's input '" +
                               probe.watches.front().expression + "'; use --method clock or --method count");
  } while (!probe.watches.empty());
}

void Isolation::keep(const session::Captured& captured,
                     const std::vector<instrumenter::IsolatedInput>& wanted) {
  const auto stride = static_cast<std::size_t>(4 * shader_.vectors_per_thread);
  words_.resize(covered().cost.size() * stride);
  is_float_.resize(stride);
  for (const instrumenter::Field& field : captured.layout.fields)
    for (const instrumenter::IsolatedInput& input : wanted) {
      if (input.input != field.name) continue;
      const std::vector<frontend::Component> components = frontend::components(field.type);
      const auto first = static_cast<std::size_t>(input.first_word);
      for (std::size_t c = 0; c < components.size() && field.type.basic != frontend::Basic::double_; ++c)
        if (components[c].basic == frontend::Basic::float_ &&
            components.size() == static_cast<std::size_t>(frontend::wordCount(field.type)))
          is_float_[first + c] = 1;
      const bool truth = shader_.floats && field.type.basic == frontend::Basic::bool_;
      const instrumenter::FieldDecoder decoder(captured.layout, field);
      std::vector<std::uint32_t> thread(static_cast<std::size_t>(captured.threads.words()));
      std::vector<std::uint32_t> value(decoder.words());
      for (std::size_t i = 0; i < captured.threads.count(); ++i) {
        captured.threads.read(i, thread.data());
        decoder.decode(thread.data(), value.data());
        for (std::size_t w = 0; w < value.size(); ++w)
          words_[i * stride + first + w] =
              truth && value[w] != 0 ? std::bit_cast<std::uint32_t>(1.0F) : value[w];
      }
    }
}

SameOutput Isolation::compareOutputs(const std::vector<std::size_t>& pixels) {
  return stage_ == session::Stage::fragment ? compareColors(pixels) : compareRecords(pixels);
}

// Every thread of the call leaves what this one does.
SameOutput Isolation::compareRecords(const std::vector<std::size_t>& pixels) {
  session::ExecuteOptions execute;
  execute.compare = false;
  execute.read_outputs = true;
  const session::Prepared original = session_.prepareOriginal();
  const session::Execution expected = session_.execute(original, execute);
  const auto words = static_cast<std::size_t>(expected.feedback_words);
  SameOutput result;
  if (words == 0 || expected.feedback.size() < words * covered().costs().size()) return result;
  for (const std::size_t pixel : pixels) {
    execute.uniforms = inputsOf(pixel);
    const session::Execution found = session_.execute(isolated_, execute);
    const bool same = found.feedback.size() == expected.feedback.size() &&
                      std::equal(found.feedback.begin() + static_cast<std::ptrdiff_t>(words * pixel),
                                 found.feedback.begin() + static_cast<std::ptrdiff_t>(words * (pixel + 1)),
                                 expected.feedback.begin() + static_cast<std::ptrdiff_t>(words * pixel));
    ++result.tried;
    result.same += same ? 1 : 0;
  }
  return result;
}

SameOutput Isolation::compareColors(const std::vector<std::size_t>& pixels) {
  const session::Prepared original = session_.prepareOriginal();
  session::ExecuteOptions whole;
  whole.compare = false;
  whole.read_outputs = true;
  const std::vector<session::ColorOutput> expected = session_.execute(original, whole).outputs;
  SameOutput result;
  for (const std::size_t pixel : pixels) {
    session::ExecuteOptions one;
    one.compare = false;
    one.read_captures = false;
    one.read_outputs = true;
    one.covering_size = 2;
    one.uniforms = inputsOf(pixel);
    const std::vector<session::ColorOutput> found = session_.execute(isolated_, one).outputs;
    const std::size_t x = pixel % static_cast<std::size_t>(covered().width);
    const std::size_t y = pixel / static_cast<std::size_t>(covered().width);
    const std::size_t lane = y % 2 * 2 + x % 2;
    bool same = found.size() >= expected.size();
    for (std::size_t i = 0; same && i < expected.size(); ++i)
      same = std::equal(expected[i].words.begin() + static_cast<std::ptrdiff_t>(4 * pixel),
                        expected[i].words.begin() + static_cast<std::ptrdiff_t>(4 * pixel + 4),
                        found[i].words.begin() + static_cast<std::ptrdiff_t>(4 * lane));
    ++result.tried;
    result.same += same ? 1 : 0;
  }
  return result;
}

// The inputs of a thread that the draw may not have: where it does not, they are continued from the threads
// on the other side of the fallback, which it has. What is no float is the fallback's own.
std::vector<std::uint32_t> Isolation::wordsAt(int x, int y, int fallback_x, int fallback_y) {
  const auto stride = static_cast<std::ptrdiff_t>(4 * shader_.vectors_per_thread);
  const auto at = [&](int px, int py) {
    return words_.begin() + static_cast<std::ptrdiff_t>(covered().index(px, py)) * stride;
  };
  const auto has = [&](int px, int py) {
    return px >= 0 && py >= 0 && px < covered().width && py < covered().height &&
           covered().state[covered().index(px, py)] != PixelState::none;
  };
  if (has(x, y)) return {at(x, y), at(x, y) + stride};
  std::vector<std::uint32_t> words(at(fallback_x, fallback_y), at(fallback_x, fallback_y) + stride);
  ++continued_;
  for (const auto& [dx, dy] : {std::pair{x - fallback_x, 0}, std::pair{0, y - fallback_y}}) {
    if ((dx == 0 && dy == 0) || !has(fallback_x - dx, fallback_y - dy)) continue;
    const auto here = at(fallback_x, fallback_y);
    const auto behind = at(fallback_x - dx, fallback_y - dy);
    for (std::size_t w = 0; w < words.size(); ++w) {
      if (is_float_[w] == 0) continue;
      const auto i = static_cast<std::ptrdiff_t>(w);
      words[w] = std::bit_cast<std::uint32_t>(std::bit_cast<float>(words[w]) + std::bit_cast<float>(here[i]) -
                                              std::bit_cast<float>(behind[i]));
    }
  }
  return words;
}

std::vector<session::Uniform> Isolation::inputsOf(std::size_t pixel) {
  if (shader_.words_uniform.empty()) return {};
  const int x = static_cast<int>(pixel % static_cast<std::size_t>(covered().width));
  const int y = static_cast<int>(pixel / static_cast<std::size_t>(covered().width));
  session::Uniform uniform{shader_.words_uniform, shader_.floats ? kGlFloatVec4 : kGlUintVec4, {}};
  if (!quads()) {
    uniform.words = wordsAt(x, y, x, y);
  } else {
    for (int lane = 0; lane < 4; ++lane) {
      const std::vector<std::uint32_t> words = wordsAt(x / 2 * 2 + lane % 2, y / 2 * 2 + lane / 2, x, y);
      uniform.words.insert(uniform.words.end(), words.begin(), words.end());
    }
  }
  return {std::move(uniform)};
}

std::vector<double> Isolation::draw(const session::Prepared& prepared,
                                    const session::ExecuteOptions& options) {
  session::ExecuteOptions execute = options;
  execute.compare = false;
  execute.read_captures = false;
  const session::Execution executed = session_.execute(prepared, execute);
  return nanoseconds(timer_.kind == Timer::Kind::cpu ? executed.cpu_times : executed.times);
}

}  // namespace shadestep::profiler
