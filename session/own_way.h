// What is no value at a place because it has not been written on the way there: by any thread, or by the one
// that was picked, whose way is recorded for that.
#pragma once

#include <optional>

#include "session/thread_values.h"
#include "session/written.h"

namespace shadestep::session {

// Gives those of the values that no thread can have written before the position their `no_value`. A position
// inside of a function without its call path tells nothing.
void leaveOutUnwritten(const frontend::Shader&, const Position&, ThreadValues&);

// One thread's recorded way through the selected stage's shader.
class OwnWay {
 public:
  OwnWay(Session& session, ThreadName thread) : session_(session), thread_(std::move(thread)) {}

  // Has the thread written what the name means before it gets to the position? Records its way when that is
  // needed first. True, too, where the way cannot be recorded or does not get there. Without iterations the
  // thread's last visit is meant.
  bool hasWritten(const Position&, const std::string& name);

 private:
  std::optional<std::size_t> stepOf(const Position&) const;

  Session& session_;
  ThreadName thread_;
  bool recorded_ = false;
  std::vector<Step> steps_;
  std::vector<std::optional<Position>> positions_;
};

}  // namespace shadestep::session
