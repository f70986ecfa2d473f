#include "debugger-gui/backend/process_end.h"

#include <sys/wait.h>

namespace shadestep::gui {

bool hasEnded(int process) {
  siginfo_t info{};
  if (process <= 0) return false;
  if (waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) != 0) return true;
  // A stop that the tracer has not answered yet is told of, too, though it was not asked for.
  return info.si_code == CLD_EXITED || info.si_code == CLD_KILLED || info.si_code == CLD_DUMPED;
}

}  // namespace shadestep::gui
