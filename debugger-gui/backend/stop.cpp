// What the window shows of the draw at which the program stands.
#include <algorithm>

#include "debugger-gui/backend/debuggee.h"

namespace shadestep::gui {

using session::Error;

namespace {

std::vector<std::string> textOf(const session::StageFacts& facts) {
  std::string whole;
  for (const auto& object : facts.objects)
    for (const std::string& string : object.strings) whole += string;
  std::vector<std::string> lines(1);
  for (const char c : whole) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

StageSource sourceOf(session::Session& session, const session::StageFacts& facts, const std::string& reason) {
  StageSource source;
  source.stage = facts.stage;
  source.reason = reason;
  try {
    const frontend::Shader& shader = session.shader(facts.stage);
    source.version = shader.version;
    source.lines = shader.lines;
    source.included = shader.included;
    for (int line = 1; line <= static_cast<int>(shader.lines.size()); ++line)
      if (!frontend::statementsAt(shader, line).empty()) source.stops.push_back(line);
  } catch (const Error& error) {
    if (source.reason.empty()) source.reason = error.what();
    source.lines = textOf(facts);
  }
  return source;
}

}  // namespace

// Why a stage of the present draw cannot be debugged; empty if it can.
std::string Debuggee::whyNot(session::Stage stage) {
  const session::Stage before = session_->stage();
  session_->select(stage);
  std::string reason;
  try {
    session_->requireCapturable();
  } catch (const Error& error) {
    reason = error.what();
  }
  session_->select(before);
  return reason;
}

DrawEntry Debuggee::entry() {
  DrawEntry entry;
  entry.stop = *stop_;
  const session::DrawFacts& facts = session_->facts();
  entry.program = facts.program;
  entry.framebuffer = facts.framebuffer;
  std::copy(std::begin(facts.viewport), std::end(facts.viewport), std::begin(entry.viewport));
  entry.reason = whyNot(session::Stage::fragment);
  for (const session::StageFacts& stage : facts.stages)
    if (!entry.reason.empty() && whyNot(stage.stage).empty()) entry.reason.clear();
  return entry;
}

Stop Debuggee::stopped(bool restarted) {
  Stop stop;
  stop.draw = entry();
  stop.facts = session_->facts();
  for (const session::StageFacts& facts : stop.facts.stages)
    stop.stages.push_back(sourceOf(*session_, facts, whyNot(facts.stage)));
  stop.restarted = restarted;
  try {
    session_->choose(fragments_);
  } catch (const Error&) {
    fragments_ = {};  // this draw has no such layer, sample or test
    session_->choose(fragments_);
  }
  return stop;
}

}  // namespace shadestep::gui
