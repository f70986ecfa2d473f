// Where a group of threads can stand in a shader, and where it can go from there: stepping as on a CPU,
// worked out on the statements alone. No driver is asked here; which way threads really went is the caller's
// business.
//
// Position and moves are the interactive side of the thesis's debug state (7.1.2): a position says which
// statement is the target, which calls are on the way to it, and which iteration of every loop around it is
// meant.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "glsl-frontend/shader.h"

namespace shadestep::session {

struct Position {
  std::vector<frontend::CallId> call_path;            // from main inwards
  frontend::StatementId statement = frontend::kNone;  // kNone: the threads have ended
  // Per loop around the position, over the whole call path, outermost first. With `condition` at a loop, that
  // loop counts too: which evaluation of its condition it is.
  std::vector<int> iterations;
  // The condition of the if, loop or switch has been evaluated: a side is to be chosen.
  bool condition = false;
  // Calls of the statement's expressions that have been stepped through already. At a loop: of its head,
  // between the increment and the condition's end; that evaluation of the head counts among the iterations.
  int calls_done = 0;

  bool ended() const { return statement == frontend::kNone; }
  bool operator==(const Position&) const = default;
};

// One way on from a branch.
struct Side {
  std::string name;  // "true", "false"; at a switch "case 3", "default", "no case"
  Position next;
  std::optional<std::int64_t> label;  // of a case, where its value is known
};

// The side that a thread takes whose condition had this outcome. Throws cannot_debug where a label's value is
// not known. Assumes that there is one.
std::size_t sideOf(const std::vector<Side>&, frontend::Basic outcome, std::uint32_t word);

class Navigation {
 public:
  explicit Navigation(const frontend::Shader& shader) : shader_(shader) {}

  // Before the first statement of main.
  Position start() const;
  // After the statement: at a branch, to its condition (`condition` set: then choose among sides()); else to
  // what runs next. A called function runs as a whole.
  Position over(const Position&) const;
  // Into the first call of the statement that has not been stepped through, or of the loop's head that comes
  // next; over() if there is none.
  Position into(const Position&) const;
  // The same for the statement's own calls alone; no move if there is none.
  Position intoCall(const Position&) const;
  // To the end of the current function: back in the caller, right after the call. Ends the thread in main.
  Position out(const Position&) const;
  // To the condition that decides on the next iteration of the innermost loop; no move outside of loops.
  Position nextIteration(const Position&) const;
  // Past the innermost loop; no move outside of loops.
  Position leaveLoop(const Position&) const;
  // Before the first statement at a line of the same function, if there is one. Loops around both places keep
  // their iteration, loops that are entered start with 0. No move if the line has no statement in this
  // function.
  Position toLine(const Position&, int line) const;

  // The call that has returned last at a position with `calls_done`; kNone elsewhere.
  frontend::CallId callDone(const Position&) const;
  // The position right after that call returned, in the statement that makes it.
  Position afterCall(Position in_statement, frontend::CallId) const;

  // The ways on from a position whose `condition` is set; empty elsewhere.
  std::vector<Side> sides(const Position&) const;

  // The loops around a position in its own function, outermost first, as counted by Position::iterations.
  std::vector<frontend::StatementId> loopsAround(const Position&) const;

 private:
  const frontend::Statement& at(frontend::StatementId id) const {
    return shader_.statements[static_cast<std::size_t>(id)];
  }
  Position enter(Position, frontend::StatementId) const;
  Position enterList(Position, const std::vector<frontend::StatementId>&, std::size_t first,
                     frontend::StatementId owner) const;
  Position after(Position, frontend::StatementId) const;
  Position returned(Position) const;
  std::vector<frontend::CallId> callsInOrder(frontend::StatementId) const;
  bool inIncrement(frontend::StatementId, frontend::CallId) const;
  Position enterCall(Position, frontend::CallId) const;
  Position intoHead(const Position& from, const Position& decision) const;
  Position decide(Position, frontend::StatementId loop, bool next) const;
  Position jump(const Position&) const;
  void leaveTo(Position&, frontend::StatementId loop, bool keep_loop) const;

  const frontend::Shader& shader_;
};

}  // namespace shadestep::session
