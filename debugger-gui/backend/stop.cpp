// What the window shows of the draw at which the program stands.
#include <algorithm>

#include "debugger-gui/backend/debuggee.h"

namespace shadestep::gui {

using session::Error;

namespace {

std::string whyNot(session::Session& session) {
  try {
    session.requireCapturable();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

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

StageSource sourceOf(session::Session& session, const session::StageFacts& facts) {
  StageSource source;
  source.stage = facts.stage;
  source.reason = facts.reason;
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
  if (facts.stage != session::Stage::fragment && source.reason.empty())
    source.reason = "this version of shadestep steps through fragment shaders only";
  return source;
}

}  // namespace

DrawEntry Debuggee::entry() {
  DrawEntry entry;
  entry.stop = *stop_;
  const session::DrawFacts& facts = session_->facts();
  entry.program = facts.program;
  entry.framebuffer = facts.framebuffer;
  std::copy(std::begin(facts.viewport), std::end(facts.viewport), std::begin(entry.viewport));
  entry.reason = whyNot(*session_);
  return entry;
}

Stop Debuggee::stopped(bool restarted) {
  Stop stop;
  stop.draw = entry();
  stop.facts = session_->facts();
  for (const session::StageFacts& facts : stop.facts.stages)
    stop.stages.push_back(sourceOf(*session_, facts));
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
