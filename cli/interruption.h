// Ctrl-C while a program is under debug.
#pragma once

#include "session/session.h"

namespace shadestep::cli {

// A session that SIGINT does not simply end. Its program ignores the signal: an interruption from the
// terminal reaches both, and must not end what is looked at. One at a time.
class InterruptibleSession {
 public:
  enum class Action {
    note,   // noted() says so
    pause,  // Session::interrupt(): the program stops at its next call
    end,    // kills the program and ends us with status 130
  };

  // Until on() it is `end`. Throws as Session does.
  explicit InterruptibleSession(const session::LaunchOptions&);
  ~InterruptibleSession();
  InterruptibleSession(const InterruptibleSession&) = delete;
  InterruptibleSession& operator=(const InterruptibleSession&) = delete;

  session::Session& session() { return session_; }

  // What the next SIGINT does. The one after it ends us: who asks twice does not want to wait.
  void on(Action);

  static bool noted();

 private:
  // Restores what the signal did.
  class Restored {
   public:
    Restored();
    ~Restored();

   private:
    void (*before_)(int);
  };

  Restored restored_;  // before the session: its program inherits what is set here
  session::Session session_;
};

}  // namespace shadestep::cli
