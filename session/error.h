// How a request to the debugger can end, other than well: always with the sentence the user reads.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace shadestep::session {

// The exit codes of the command line.
enum class Outcome {
  done = 0,
  failed = 1,  // a check failed, or the program under debug did
  usage = 2,
  nothing_matches = 3,  // the selection fits nothing; the text says what there is
  cannot_debug = 4,     // found, but not to be debugged; the text says why
  ended = 5,            // the program ended or crashed before the selection; the text says where
};

class Error : public std::runtime_error {
 public:
  Error(Outcome outcome, const std::string& sentence) : std::runtime_error(sentence), outcome_(outcome) {}
  Outcome outcome() const { return outcome_; }

 private:
  Outcome outcome_;
};

// Two passes over the same draw see different threads: the driver, a race in the shader, or the debugger
// itself.
class Unsteady : public Error {
 public:
  explicit Unsteady(const std::string& sentence) : Error(Outcome::failed, sentence) {}
};

// Session::interrupt() was called: the program stands at a call, and can be run on.
class Interrupted : public Error {
 public:
  explicit Interrupted(const std::string& sentence) : Error(Outcome::failed, sentence) {}
};

// The driver does not take a text that the debugger made: a defect of the debugger's, `log` is the driver's
// own.
class DriverRefusal : public Error {
 public:
  DriverRefusal(const std::string& sentence, std::string log)
      : Error(Outcome::cannot_debug, sentence + log), log_(std::move(log)) {}
  const std::string& log() const { return log_; }

 private:
  std::string log_;
};

}  // namespace shadestep::session
