// What the window shows of the stepper's position.
#include <algorithm>

#include "debugger-gui/backend/debuggee.h"
#include "session/window.h"

namespace shadestep::gui {
namespace {

using frontend::Shader;

const frontend::Statement& statementAt(const Shader& shader, frontend::StatementId id) {
  return shader.statements[static_cast<std::size_t>(id)];
}

std::vector<StackEntry> stackOf(const Shader& shader, const Place& place) {
  std::vector<StackEntry> stack = {{place.function, place.line}};
  const auto& path = place.position.call_path;
  for (auto id = path.rbegin(); id != path.rend(); ++id) {
    const frontend::Call& call = shader.calls[static_cast<std::size_t>(*id)];
    stack.push_back({shader.functions[static_cast<std::size_t>(call.caller)].name,
                     shader.tokens[static_cast<std::size_t>(call.name)].place.line});
  }
  return stack;
}

std::vector<LoopAround> loopsOf(const Shader& shader, const Place& place) {
  const auto numbered = instrumenter::numberedLoops(shader, session::probeAt(shader, place.position));
  std::vector<LoopAround> loops;
  for (std::size_t i = 0; i < std::min(numbered.size(), place.position.iterations.size()); ++i)
    loops.push_back({statementAt(shader, numbered[i]).place.line, place.position.iterations[i]});
  return loops;
}

}  // namespace

std::vector<ScopeEntry> Debuggee::scopeOf(const session::Stepper& stepper) {
  const Shader& shader = stepper.shader();
  const instrumenter::Probe probe = session::probeAt(shader, stepper.position());
  const auto changing = stepper.mayChange();
  std::vector<ScopeEntry> entries;
  for (const frontend::VariableId id : stepper.scope()) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(id)];
    const frontend::WatchResult found = session::watchAt(shader, probe, variable.name);
    if (!found.watch || found.watch->variable != id) continue;  // a sampler, or hidden by an inner name
    // What of the built-in variables is written is an output: gl_FragColor, gl_Position.
    const bool output = variable.storage == frontend::Storage::builtin && variable.written;
    entries.push_back({variable.name, frontend::glslName(variable.type),
                       output ? frontend::Storage::out : variable.storage,
                       std::find(changing.begin(), changing.end(), id) != changing.end(),
                       frontend::wordCount(variable.type) > kLargeWords});
  }
  return entries;
}

Place Debuggee::place() {
  session::Stepper& at = stepper();
  const Shader& shader = at.shader();
  Place place;
  place.stage = picked_.stage;
  place.position = at.position();
  place.ended = at.ended();
  if (place.ended) return place;
  const frontend::Statement& statement = statementAt(shader, place.position.statement);
  place.line = statement.place.line;
  place.column = statement.place.column;
  place.function = shader.functions[static_cast<std::size_t>(statement.function)].name;
  if (const frontend::CallId call = at.navigation().callDone(place.position); call != frontend::kNone)
    place.returned =
        shader.functions[static_cast<std::size_t>(shader.calls[static_cast<std::size_t>(call)].callee)].name;
  place.stack = stackOf(shader, place);
  place.loops = loopsOf(shader, place);
  place.scope = scopeOf(at);
  if (!place.position.condition) return place;

  place.at_loop = statement.kind == frontend::StatementKind::for_ ||
                  statement.kind == frontend::StatementKind::while_ ||
                  statement.kind == frontend::StatementKind::do_while;
  place.ways = std::make_shared<const std::vector<session::TakenSide>>(at.sides());
  for (const session::TakenSide& way : *place.ways)
    place.sides.push_back({way.side.name, way.threads, way.picked});
  return place;
}

}  // namespace shadestep::gui
