#include "session/verify.h"

#include <algorithm>

#include "session/verify_draw.h"

namespace shadestep::session {
namespace {

using Kind = VerifyFailure::Kind;

std::string fragmentText(const DrawFacts& facts) {
  std::string text;
  for (const StageFacts& stage : facts.stages) {
    if (stage.stage != Stage::fragment) continue;
    for (const frontend::ShaderObject& object : stage.objects) {
      for (const std::string& string : object.strings) text += string;
      for (const auto& [name, string] : object.includes.named) text += name + string;
    }
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
  verifyThisDraw(session_, options_, report_);
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
