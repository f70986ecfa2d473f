#include "walk.h"

#include <algorithm>

namespace shadestep::bench {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double wallMilliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return Milliseconds(std::chrono::steady_clock::now() - begin).count();
}

double drawMilliseconds(session::Session& session, const session::Prepared& program) {
  session::ExecuteOptions options;
  options.compare = false;
  options.read_captures = false;
  return Milliseconds(session.execute(program, options).times.front()).count();
}

namespace {

// Goes on until `there`, or to the end; the last place where something could be looked at.
session::Position walk(session::Stepper& stepper, const std::function<bool()>& there) {
  session::Position last;
  while (!stepper.ended() && !there()) {
    if (stepper.position().condition) {
      stepper.choose();
      continue;
    }
    last = stepper.position();
    stepper.moveTo(stepper.navigation().over(last));
  }
  return last;
}

}  // namespace

bool walkIntoLoop(session::Stepper& stepper) {
  const auto inLoop = [&] { return !stepper.position().iterations.empty(); };
  session::Position last = walk(stepper, inLoop);
  if (!stepper.ended()) {
    last = walk(stepper, [&] { return !inLoop() || stepper.position().iterations.back() != 0; });
  }
  if (!last.ended()) stepper.moveTo(last);
  return !last.ended();
}

std::vector<std::string> watchesAt(const session::Stepper& stepper, std::size_t most) {
  const frontend::Shader& shader = stepper.shader();
  std::vector<std::string> names;
  const auto& scope = shader.statements[static_cast<std::size_t>(stepper.position().statement)].scope;
  for (auto id = scope.rbegin(); id != scope.rend() && names.size() < most; ++id) {
    const frontend::Variable& variable = shader.variables[static_cast<std::size_t>(*id)];
    if (variable.storage == frontend::Storage::local) names.push_back(variable.name);
  }
  return names;
}

void nextIteration(session::Stepper& stepper) {
  session::Position next = stepper.position();
  if (!next.iterations.empty()) ++next.iterations.back();
  stepper.moveTo(next);
}

}  // namespace shadestep::bench
