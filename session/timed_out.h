#pragma once

#include "session/error.h"

namespace shadestep::session {

// The session's time (--timeout) ran out; where the program stood then, the outcome says: ended (it ran) or
// failed (during a replay).
class TimedOut : public Error {
 public:
  using Error::Error;
};

}  // namespace shadestep::session
