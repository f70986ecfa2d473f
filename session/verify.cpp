#include "session/verify.h"

#include <algorithm>

#include "session/verify_draw.h"
#include "session/verify_findings.h"

namespace shadestep::session {
namespace {

using Kind = VerifyFailure::Kind;

std::string textOf(const DrawFacts& facts, Stage wanted) {
  std::string text;
  for (const StageFacts& stage : facts.stages) {
    if (stage.stage != wanted) continue;
    for (const frontend::ShaderObject& object : stage.objects) {
      for (const std::string& string : object.strings) text += string;
      for (const auto& [name, string] : object.includes.named) text += name + string;
    }
  }
  return text;
}

// A draw without shaders is asked for its fragment shader, and says why there is none.
std::vector<Stage> stagesOf(const DrawFacts& facts) {
  std::vector<Stage> stages;
  for (const StageFacts& one : facts.stages) stages.push_back(one.stage);
  if (stages.empty()) stages.push_back(Stage::fragment);
  return stages;
}

bool isAboutTheDraw(const Error& error) {
  return error.outcome() == Outcome::cannot_debug || error.outcome() == Outcome::nothing_matches;
}

}  // namespace

VerifyCounts& VerifyCounts::operator+=(const VerifyCounts& other) {
  shaders += other.shaders;
  sites += other.sites;
  passes += other.passes;
  compared += other.compared;
  analysis_failed += other.analysis_failed;
  compile_failed += other.compile_failed;
  output_mismatch += other.output_mismatch;
  value_mismatch += other.value_mismatch;
  state_leaks += other.state_leaks;
  crashes += other.crashes;
  unsteady += other.unsteady;
  timeouts += other.timeouts;
  return *this;
}

VerifyCounts VerifyReport::total() const {
  VerifyCounts total = outside;
  for (const auto& [stage, counts] : stages) total += counts;
  return total;
}

void Verifier::verifyDraw() {
  ++report_.draws;
  last_ = session_.stop();
  within_draw_ = true;
  const std::vector<Stage> stages =
      options_.stage ? std::vector<Stage>{*options_.stage} : stagesOf(session_.facts());
  const bool before_fragments = std::any_of(stages.begin(), stages.end(), [](Stage stage) {
    return stage != Stage::fragment && stage != Stage::compute;
  });
  if (before_fragments) checkDraw();  // what the next one is compared with
  for (const Stage stage : stages)
    verifyStage(stage, options_.seconds_per_draw / static_cast<double>(stages.size()));
  if (before_fragments) checkDraw();
  within_draw_ = false;
}

// Replays of stages before rasterization draw nothing: that they leave what the draw makes is seen
// afterwards.
void Verifier::checkDraw() {
  session_.select(Stage::fragment);
  try {
    const Check check = session_.execute(session_.prepareOriginal()).check;
    Findings(session_, report_).checkOutputs(nullptr, "draw", check);
  } catch (const Error& error) {
    if (!isAboutTheDraw(error)) throw;  // it has no fragments that could be looked at
  }
}

void Verifier::verifyStage(Stage stage, double seconds) {
  session_.select(stage);
  const DrawFacts& facts = session_.facts();
  const std::string text = textOf(facts, stage);
  const auto skip = [&](const std::string& reason) { ++report_.skipped[{stage, reason}]; };
  // Without a text each draw says by itself why there is none.
  if (!text.empty() && ++seen_[{facts.program, stage, text}] > options_.draws_per_shader)
    return skip("the shader was checked in an earlier draw");
  const bool is_new = texts_.insert({stage, text}).second;
  bool analysed = false;
  try {
    session_.shader(stage);
    analysed = true;
    session_.requireCapturable();
  } catch (const Error& error) {
    if (!isAboutTheDraw(error)) throw;
    skip(error.what());
    if (is_new && !analysed && !text.empty()) ++report_.stages[stage].analysis_failed;
    return;
  }
  if (is_new) ++report_.stages[stage].shaders;
  VerifyOptions options = options_;
  options.seconds_per_draw = seconds;
  verifyThisDraw(session_, options, report_);
}

void Verifier::addEnd(Kind kind, const std::string& detail) {
  ++(kind == Kind::timeout ? report_.outside.timeouts : report_.outside.crashes);
  VerifyFailure failure;
  failure.kind = kind;
  failure.frame = last_.frame;
  failure.draw = last_.draw;
  if (within_draw_)
    failure.stage = session_.stage();
  else
    failure.plan = "after the draw";
  failure.detail = detail;
  report_.failures.push_back(std::move(failure));
}

std::optional<std::vector<ColorOutput>> drawnHere(Session& session) {
  session.select(Stage::fragment);
  try {
    ExecuteOptions options;
    options.compare = false;
    options.read_outputs = true;
    return session.execute(session.prepareOriginal(), options).outputs;
  } catch (const Error& error) {
    if (!isAboutTheDraw(error)) throw;
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
    case Kind::unsteady:
      return "unsteady";
    case Kind::timeout:
      return "timeout";
  }
  return "?";
}

}  // namespace shadestep::session
