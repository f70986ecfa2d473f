#include "session/run_positions.h"

namespace shadestep::session {
namespace {

using frontend::CallId;
using frontend::kNone;

// The calls on the way to the present step, kept from step to step.
class Walk {
 public:
  explicit Walk(const frontend::Shader& shader) : navigation_(shader) {}

  std::optional<Position> at(const Step& step) {
    levels_.resize(static_cast<std::size_t>(step.depth) + 1);
    Level& here = levels_.back();
    switch (step.kind) {
      case Step::Kind::enter:
        here = {step.call, kNone, kNone};
        if (levels_.size() > 1) levels_[levels_.size() - 2].returned = step.call;
        return std::nullopt;
      case Step::Kind::leave:
      case Step::Kind::cut:
        return std::nullopt;
      case Step::Kind::call:
        here.calling = step.statement;
        here.returned = kNone;
        break;
      default:
        break;
    }
    Position position;
    position.statement = step.statement;
    position.iterations = step.iteration;
    position.condition = step.kind == Step::Kind::condition;
    for (std::size_t i = 1; i < levels_.size(); ++i) {
      if (levels_[i].entered_by == kNone) return std::nullopt;
      position.call_path.push_back(levels_[i].entered_by);
    }
    const bool after_calls =
        step.kind != Step::Kind::call && here.calling == step.statement && here.returned != kNone;
    if (after_calls && !position.condition) position = navigation_.afterCall(position, here.returned);
    if (after_calls) here.calling = kNone;
    return position;
  }

 private:
  struct Level {
    CallId entered_by = kNone;
    frontend::StatementId calling = kNone;  // its calls are running
    CallId returned = kNone;                // the last of them
  };

  Navigation navigation_;
  std::vector<Level> levels_;
};

}  // namespace

std::vector<std::optional<Position>> positionsOf(const frontend::Shader& shader,
                                                 const std::vector<Step>& steps) {
  Walk walk(shader);
  std::vector<std::optional<Position>> positions;
  for (const Step& step : steps) positions.push_back(walk.at(step));
  return positions;
}

}  // namespace shadestep::session
