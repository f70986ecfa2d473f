#include "session/verify.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>

#include "session/recorded_visits.h"
#include "session/thread_run.h"
#include "session/thread_values.h"
#include "session/values.h"

namespace shadestep::session {
namespace {

using Clock = std::chrono::steady_clock;
using frontend::kNone;
using frontend::Shader;
using frontend::Statement;
using frontend::StatementId;
using frontend::StatementKind;
using frontend::Storage;
using frontend::VariableId;
using instrumenter::Probe;
using instrumenter::Value;
using Kind = VerifyFailure::Kind;

constexpr std::uint32_t kRandomSeed = 7;  // for the choice of pixels: the same in every run
constexpr int kPartWords = 16;            // wider values are looked at in parts
constexpr int kWatchedWords = 96;  // at one site; with more in scope the sites take turns with the variables

struct Pixel {
  int x = 0, y = 0;
};

// A variable, or a part of one, as it is watched.
struct Part {
  VariableId variable = kNone;
  std::string expression;
  frontend::Type type;
  std::size_t first_word = 0;  // in the variable's value
};

// The value in parts of at most kPartWords, in canonical order.
void addParts(const Part& whole, std::vector<Part>& parts) {
  const int words = frontend::wordCount(whole.type);
  if (words == 0) return;
  const bool composed =
      whole.type.isArray() || whole.type.isMatrix() || whole.type.basic == frontend::Basic::struct_;
  if (words <= kPartWords || !composed) {
    parts.push_back(whole);
    return;
  }
  std::size_t first = whole.first_word;
  const auto add = [&](const std::string& access, const frontend::Type& type) {
    addParts({whole.variable, whole.expression + access, type, first}, parts);
    first += static_cast<std::size_t>(frontend::wordCount(type));
  };
  if (whole.type.isArray()) {
    for (int i = 0; i < whole.type.array.front(); ++i)
      add("[" + std::to_string(i) + "]", whole.type.element());
  } else if (whole.type.isMatrix()) {
    frontend::Type column = whole.type;
    column.columns = 1;
    for (int i = 0; i < whole.type.columns; ++i) add("[" + std::to_string(i) + "]", column);
  } else {
    for (const frontend::Member& member : whole.type.members->members) add("." + member.name, member.type);
  }
}

// Spread over what the draw covers: its first and last pixel, the one nearest to its centre, random ones.
std::vector<Pixel> choosePixels(const ThreadValues& cover, int most) {
  std::vector<std::size_t> covered;
  double x = 0;
  double y = 0;
  const auto width = static_cast<std::size_t>(cover.width);
  for (std::size_t p = 0; p < cover.marks.size(); ++p) {
    if (cover.marks[p] == 0) continue;
    covered.push_back(p);
    x += static_cast<double>(p % width);
    y += static_cast<double>(p / width);
  }
  if (covered.empty()) return {};
  x /= static_cast<double>(covered.size());
  y /= static_cast<double>(covered.size());
  const auto distance = [&](std::size_t p) {
    const double dx = static_cast<double>(p % width) - x;
    const double dy = static_cast<double>(p / width) - y;
    return dx * dx + dy * dy;
  };
  std::set<std::size_t> chosen = {covered.front(), covered.back()};
  chosen.insert(*std::min_element(covered.begin(), covered.end(),
                                  [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); }));
  std::mt19937 random(kRandomSeed);
  const std::size_t wanted = std::min(covered.size(), static_cast<std::size_t>(std::max(most, 1)));
  while (chosen.size() < wanted) chosen.insert(covered[random() % covered.size()]);

  std::vector<Pixel> pixels;
  for (const std::size_t p : chosen) {
    if (pixels.size() < wanted) pixels.push_back({static_cast<int>(p % width), static_cast<int>(p / width)});
  }
  return pixels;
}

bool hasCondition(StatementKind kind) {
  return kind == StatementKind::if_ || kind == StatementKind::switch_ || kind == StatementKind::for_ ||
         kind == StatementKind::while_ || kind == StatementKind::do_while;
}

bool isJump(StatementKind kind) {
  return kind == StatementKind::return_ || kind == StatementKind::break_ ||
         kind == StatementKind::continue_ || kind == StatementKind::discard;
}

std::string hexWords(const std::vector<std::uint32_t>& words) {
  std::string text;
  for (const std::uint32_t word : words) {
    char hex[12];
    std::snprintf(hex, sizeof hex, "%s%08x", text.empty() ? "" : " ", word);
    text += hex;
    if (text.size() > 80) return text + " ...";
  }
  return text;
}

// One draw's checks.
class DrawCheck {
 public:
  DrawCheck(Session& session, const VerifyOptions& options, VerifyReport& report)
      : session_(session), options_(options), report_(report), shader_(session.shader(Stage::fragment)) {}

  void run() {
    const auto before = session_.glState();
    look();
    compareState(before, session_.glState());
  }

 private:
  void look() {
    if (!copyIsFaithful()) return;
    if (!findPixels()) return;
    record();
    for (StatementId id = 0; id < static_cast<StatementId>(shader_.statements.size()); ++id) {
      if (Clock::now() > deadline_)
        return skip("the time for one draw ran out before all its sites were seen");
      checkSite(id);
    }
  }

  struct RecordedPixel {
    Pixel pixel;
    Session::Recorded recorded;
    int thread = -1;  // that the pixel shows
  };

  // ---- what is found -------------------------------------------------------------------------------------

  void skip(const std::string& reason) { ++report_.skipped[reason]; }

  void fail(Kind kind, const Statement* at, const std::string& plan, const std::string& variable,
            const std::string& detail) {
    std::uint64_t* counter[] = {&report_.compile_failed, &report_.output_mismatch, &report_.value_mismatch,
                                &report_.state_leaks, &report_.crashes};
    ++*counter[static_cast<int>(kind)];
    if (report_.failures.size() >= VerifyReport::kMostFailures) return;
    VerifyFailure failure{kind, session_.stop().frame, session_.stop().draw, 0, 0, plan, variable, detail};
    if (at != nullptr) {
      failure.line = at->place.line;
      failure.column = at->place.column;
    }
    report_.failures.push_back(std::move(failure));
  }

  // Runs one plan's pass; false if there is no result.
  template <class Pass>
  bool attempt(const Statement* at, const std::string& plan, Pass pass) {
    try {
      ++report_.passes;
      pass();
      return true;
    } catch (const DriverRefusal& refusal) {
      fail(Kind::compile, at, plan, "", refusal.log());
    } catch (const Error& error) {
      if (error.outcome() != Outcome::cannot_debug) throw;
      skip(plan + ": " + error.what());
    }
    return false;
  }

  void checkOutputs(const Statement* at, const std::string& plan, const Check& check) {
    if (check.compared_at_all && check.differing > 0) {
      fail(Kind::output, at, plan, "",
           std::to_string(check.differing) + " of " + std::to_string(check.compared) +
               " components differ from the uninstrumented draw");
    }
  }

  // ---- the program's state
  // ---------------------------------------------------------------------------------

  using GlState = std::vector<std::pair<std::string, std::string>>;
  void compareState(const GlState& before, const GlState& after) {
    for (std::size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
      if (i >= before.size() || i >= after.size() || before[i].first != after[i].first) {
        return fail(Kind::state, nullptr, "state", "", "the driver answers other questions than before");
      }
      if (before[i].second != after[i].second) {
        fail(Kind::state, nullptr, "state", before[i].first,
             "was " + before[i].second + ", is " + after[i].second);
      }
    }
  }

  // ---- the draw without instrumentation
  // --------------------------------------------------------------------

  // The program's own text in a program of ours must draw what the program's own program draws. If it draws
  // different things twice, the driver (or a race in the shader) makes comparisons meaningless.
  bool copyIsFaithful() {
    Check check;
    const bool ran = attempt(nullptr, "copy", [&] {
      const Prepared copy = session_.prepareOriginal();
      check = session_.execute(copy).check;
    });
    if (!ran) return false;
    if (!check.compared_at_all) {
      skip(check.reason);
      return false;
    }
    checkOutputs(nullptr, "copy", check);
    return check.differing == 0;
  }

  // ---- which pixels
  // ----------------------------------------------------------------------------------------

  bool findPixels() {
    Probe start;
    start.statement = shader_.functions[static_cast<std::size_t>(shader_.main)].body;
    const Statement& at = shader_.statements[static_cast<std::size_t>(start.statement)];
    ThreadValues cover;
    if (!attempt(&at, "single before", [&] { cover = valuesAt(session_, start); })) return false;
    checkOutputs(&at, "single before", cover.check);
    pixels_ = choosePixels(cover, options_.pixels);
    if (pixels_.empty()) skip("no fragment of the draw is visible: values are not compared");
    return true;
  }

  // ---- recording
  // -------------------------------------------------------------------------------------------

  void record() {
    if (pixels_.empty()) return;
    std::vector<RecordedPixel> recorded;
    const bool ran = attempt(nullptr, "recording", [&] {
      const Session::PreparedRecording prepared = session_.prepareRecording();
      for (const Pixel& pixel : pixels_) {
        RecordedPixel one{pixel, session_.record(prepared, pixel.x, pixel.y, 1, 1), -1};
        checkOutputs(nullptr, "recording", one.recorded.execution.check);
        one.recorded.execution = {};
        one.thread = visibleThread(one.recorded, pixel.x, pixel.y);
        if (one.thread < 0) {
          fail(Kind::value, nullptr, "recording", "",
               where(pixel) + ": a probe sees a fragment here that the recording does not show");
        } else {
          recorded.push_back(std::move(one));
        }
      }
    });
    if (ran) recorded_ = std::move(recorded);
  }

  // ---- single probes
  // ---------------------------------------------------------------------------------------

  void checkSite(StatementId id) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(id)];
    if (at.function == kNone || at.kind == StatementKind::case_label || at.kind == StatementKind::block)
      return;
    ++report_.sites;
    Probe probe;
    probe.statement = id;
    checkProbe(probe);
    if (isJump(at.kind)) return;
    probe.when = Probe::When::after;
    probe.outcome = hasCondition(at.kind);
    checkProbe(probe);
    if (const auto iterations = someIterations(probe)) {
      probe.iterations = *iterations;
      checkProbe(probe);
    }
  }

  // The iterations of a visit in the middle of those that the last recorded pixel makes; none if there is no
  // loop.
  std::optional<std::vector<int>> someIterations(const Probe& probe) const {
    std::vector<std::vector<int>> visits;
    if (recorded_.empty()) return std::nullopt;
    const RecordedPixel& one = recorded_.back();
    forEachVisit(shader_, one.recorded.layout, threadOf(one), [&](const Visit& visit) {
      if (visit.statement == probe.statement && visit.when == probe.when) visits.push_back(visit.iterations);
    });
    if (visits.empty() || visits.front().empty()) return std::nullopt;
    return visits[visits.size() / 2];
  }

  void checkProbe(Probe probe) {
    const Statement& at = shader_.statements[static_cast<std::size_t>(probe.statement)];
    const bool after = probe.when == Probe::When::after;
    std::string plan = after ? "single after" : "single before";
    for (const int i : probe.iterations)
      plan += (plan.back() == 'r' ? ", iteration " : ",") + std::to_string(i);
    const std::vector<Part> watched = watch(probe);
    ThreadValues found;
    if (!attempt(&at, plan, [&] { found = valuesAt(session_, probe); })) return;
    checkOutputs(&at, plan, found.check);
    if (after && isForInit(at)) return;  // a recording has no record between init and condition

    for (const RecordedPixel& one : recorded_) {
      const auto p = static_cast<std::size_t>(one.pixel.y) * static_cast<std::size_t>(found.width) +
                     static_cast<std::size_t>(one.pixel.x);
      const auto visit =
          isForInit(at) ? std::nullopt : lastVisit(shader_, one.recorded.layout, threadOf(one), probe);
      if (!isForInit(at) && visit.has_value() != found.reachedAt(p)) {
        fail(Kind::value, &at, plan, "",
             where(one.pixel) + ": " +
                 (visit ? "the recording gets here, the probe does not"
                        : "the probe gets here, the recording does not"));
        continue;
      }
      if (!visit) continue;
      std::size_t next = 0;
      if (probe.outcome) compareOutcome(at, plan, one.pixel, found.values.at(next++).valueAt(p), *visit);
      for (const Part& part : watched) {
        comparePart(at, plan, one.pixel, part, found.values.at(next++).valueAt(p), *visit);
      }
    }
  }

  void compareOutcome(const Statement& at, const std::string& plan, const Pixel& pixel, const Value& found,
                      const LastVisit& visit) {
    if (!visit.outcome) return;
    ++report_.compared;
    if (found.words == visit.outcome->words) return;
    fail(Kind::value, &at, plan, "",
         where(pixel) + ": outcome " + formatValue(found) + ", recorded " + formatValue(*visit.outcome));
  }

  void comparePart(const Statement& at, const std::string& plan, const Pixel& pixel, const Part& part,
                   const Value& found, const LastVisit& visit) {
    const auto known = visit.known.find(part.variable);
    if (known == visit.known.end()) return;
    ++report_.compared;
    const auto from = known->second.value.words.begin() + static_cast<std::ptrdiff_t>(part.first_word);
    const Value recorded{part.type, {from, from + static_cast<std::ptrdiff_t>(found.words.size())}};
    if (found.words == recorded.words) return;
    for (std::size_t i = 0; i < found.words.size(); ++i) {
      if (!known->second.defined[part.first_word + i] || found.words[i] == recorded.words[i]) continue;
      fail(Kind::value, &at, plan, part.expression,
           where(pixel) + ": " + formatValue(found) + " (" + hexWords(found.words) + "), recorded " +
               formatValue(recorded) + " (" + hexWords(recorded.words) + ")");
      return;
    }
    skip("a value that the shader never defined differs between two plans");
  }

  // Fills the probe's watches with what is in scope there, as much as one site may take.
  std::vector<Part> watch(Probe& probe) {
    std::vector<Part> candidates;
    for (const VariableId id : inScope(probe)) {
      const frontend::Variable& variable = shader_.variables[static_cast<std::size_t>(id)];
      addParts({id, variable.name, variable.type, 0}, candidates);
    }
    if (candidates.size() > 1) {
      std::rotate(candidates.begin(),
                  candidates.begin() + static_cast<std::ptrdiff_t>(turn_ % candidates.size()),
                  candidates.end());
    }
    int words = 0;
    std::size_t taken = 0;
    while (taken < candidates.size() && words < kWatchedWords) {
      words += frontend::wordCount(candidates[taken++].type);
    }
    if (taken < candidates.size()) turn_ += taken;
    candidates.resize(taken);
    for (const Part& part : candidates) probe.watches.push_back({part.expression, part.variable, part.type});
    return candidates;
  }

  std::vector<VariableId> inScope(const Probe& probe) const {
    const Statement& at = shader_.statements[static_cast<std::size_t>(probe.statement)];
    std::vector<VariableId> names = at.scope;
    if (probe.when == Probe::When::after) {
      const auto declared = [&](const std::vector<frontend::Declarator>& declarators) {
        for (const frontend::Declarator& one : declarators) {
          if (one.variable != kNone) names.push_back(one.variable);
        }
      };
      declared(at.declarators);
      if (at.init != kNone) declared(shader_.statements[static_cast<std::size_t>(at.init)].declarators);
    }
    // An inner variable hides an outer one of its name; memory shared between threads has no value of its
    // own.
    std::set<std::string> taken;
    std::vector<VariableId> result;
    for (auto id = names.rbegin(); id != names.rend(); ++id) {
      const frontend::Variable& variable = shader_.variables[static_cast<std::size_t>(*id)];
      const bool shared = variable.storage == Storage::buffer || variable.storage == Storage::shared;
      if (taken.insert(variable.name).second && !shared) result.push_back(*id);
    }
    return result;
  }

  bool isForInit(const Statement& at) const {
    if (at.parent == kNone) return false;
    const Statement& parent = shader_.statements[static_cast<std::size_t>(at.parent)];
    return parent.kind == StatementKind::for_ && parent.init != kNone &&
           &shader_.statements[static_cast<std::size_t>(parent.init)] == &at;
  }

  static const instrumenter::ThreadRecording& threadOf(const RecordedPixel& one) {
    return one.recorded.recording.threads[static_cast<std::size_t>(one.thread)];
  }

  static std::string where(const Pixel& pixel) {
    return "pixel " + std::to_string(pixel.x) + "," + std::to_string(pixel.y);
  }

  Session& session_;
  const VerifyOptions& options_;
  VerifyReport& report_;
  const Shader& shader_;
  Clock::time_point deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(options_.seconds_per_draw));
  std::vector<Pixel> pixels_;
  std::vector<RecordedPixel> recorded_;
  std::size_t turn_ = 0;
};

std::string fragmentText(const DrawFacts& facts) {
  std::string text;
  for (const StageFacts& stage : facts.stages) {
    if (stage.stage != Stage::fragment) continue;
    for (const std::string& source : stage.sources) text += source;
  }
  return text;
}

}  // namespace

void Verifier::verifyDraw() {
  ++report_.draws;
  const DrawFacts& facts = session_.facts();
  const std::string text = fragmentText(facts);
  if (++seen_[{facts.program, text}] > options_.draws_per_shader) {
    ++report_.skipped["the shader was checked in an earlier draw"];
    return;
  }
  const bool is_new = texts_.insert(text).second;
  bool analysed = false;
  try {
    session_.shader(Stage::fragment);
    analysed = true;
    session_.requireCapturable();
  } catch (const Error& error) {
    if (error.outcome() != Outcome::cannot_debug && error.outcome() != Outcome::nothing_matches) throw;
    ++report_.skipped[error.what()];
    if (is_new && !analysed && !text.empty()) ++report_.analysis_failed;
    return;
  }
  if (is_new) ++report_.shaders;
  DrawCheck(session_, options_, report_).run();
}

void Verifier::addCrash(const std::string& detail) {
  ++report_.crashes;
  VerifyFailure failure;
  failure.kind = Kind::crash;
  failure.detail = detail;
  report_.failures.push_back(std::move(failure));
}

std::optional<std::vector<ColorOutput>> drawnHere(Session& session) {
  try {
    ExecuteOptions options;
    options.compare = false;
    options.read_outputs = true;
    return session.execute(session.prepareOriginal(), options).outputs;
  } catch (const Error& error) {
    if (error.outcome() != Outcome::cannot_debug && error.outcome() != Outcome::nothing_matches) throw;
    return std::nullopt;
  }
}

bool sameBits(const std::vector<ColorOutput>& a, const std::vector<ColorOutput>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ColorOutput& x, const ColorOutput& y) { return x.words == y.words; });
}

const char* kindName(VerifyFailure::Kind kind) {
  switch (kind) {
    case Kind::compile:
      return "compile";
    case Kind::output:
      return "output";
    case Kind::value:
      return "value";
    case Kind::state:
      return "state";
    case Kind::crash:
      return "crash";
  }
  return "?";
}

}  // namespace shadestep::session
