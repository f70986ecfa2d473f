// Stepping through a shader of any stage for all threads of a draw or a dispatch at once (thesis 7.1.6): a
// position in the source, the threads that get there, and at a branch how many go which way. Threads that
// take another way are simply not at the position; after the branch they are again.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/navigation.h"
#include "session/plan.h"
#include "session/thread_values.h"

namespace shadestep::session {

// A side of a branch and the threads that take it.
struct TakenSide {
  Side side;
  std::uint64_t threads = 0;
  std::vector<std::uint8_t> mask;  // per thread, as they lie in look()'s values: 1 where it goes this way
  bool picked = false;             // the picked thread does
};

// An operator ?:, && or || in the statement at the position, and how the operand that decides came out.
struct TakenChoice {
  std::string operation;  // "?:", "&&", "||"
  frontend::Place place;
  ThreadValues outcome;  // one value, bool; of the threads that evaluate it
  std::uint64_t yes = 0, no = 0;
};

class Stepper {
 public:
  // At the start of main of the selected stage's shader, which stays the one that is stepped through.
  // `thread` is picked: its way is followed where no side is chosen; without one, the way that most threads
  // take. A thread that the draw does not run is no error. By the window plan and the automatic one, a window
  // moves along with the position, and steps inside of it cost no compilation.
  explicit Stepper(Session&, std::optional<ThreadName> thread = std::nullopt, Plan plan = Plan::automatic);

  const frontend::Shader& shader() const { return shader_; }
  const Navigation& navigation() const { return navigation_; }
  const Position& position() const { return position_; }
  bool ended() const { return position_.ended(); }

  void moveTo(const Position&);
  // Picks another thread, or none.
  void pick(std::optional<ThreadName>);
  // The picked thread's place among values of this draw; nothing if none is picked or it is not run.
  std::optional<std::size_t> pickedIn(const ThreadValues&) const;
  // Values of variables in scope, of all threads that are at the position. One redraw (more for more watches
  // than one draw holds); none for what was looked at here before, if that was one of the last few places.
  ThreadValues look(const std::vector<std::string>& watches);
  // The same and whatever else is known of the position, by their names in any order; shared, as it is much.
  std::shared_ptr<const ThreadValues> lookShared(const std::vector<std::string>& watches);
  // What will be asked for at places to come, where it is in scope: a window captures it from the start.
  void expect(const std::vector<std::string>& names) { plan_->expect(names); }
  // What can be named at the position, innermost last, and what its statement may change in some thread.
  std::vector<frontend::VariableId> scope() const;
  std::vector<frontend::VariableId> mayChange() const;
  // The operators of the statement, outer ones before those inside of them; one redraw each. A loop's are
  // those of the evaluation of its head that the position stands behind; before the loop there are none.
  std::vector<TakenChoice> choices();
  // At a branch (position().condition): its sides with the threads that take them; empty elsewhere.
  const std::vector<TakenSide>& sides();
  // Follows a side by its name, or, without one, the picked thread's or most threads'. Throws
  // nothing_matches.
  void choose(const std::string& name = {});

 private:
  struct Known {
    Position position;
    std::shared_ptr<const ThreadValues> values;
  };

  bool addFixed(const std::vector<frontend::Watch>&, ThreadValues&);
  void remember();
  const frontend::Statement& statementAt(frontend::StatementId id) const {
    return shader_.statements[static_cast<std::size_t>(id)];
  }

  Session& session_;
  Stage stage_;
  const frontend::Shader& shader_;
  Navigation navigation_;
  Position position_;
  std::optional<ThreadName> thread_;
  const bool keeps_fixed_;
  std::unique_ptr<CapturePlan> plan_;
  std::shared_ptr<const ThreadValues> here_;     // what is known of the current position
  std::deque<Known> known_;                      // and of those looked at last, the latest first
  std::optional<ThreadValues> fixed_;            // of all threads: values that nothing changes
  std::optional<std::vector<TakenSide>> sides_;  // of the current position, once asked for
};

}  // namespace shadestep::session
