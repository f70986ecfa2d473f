// Whether a process of ours has ended.
#pragma once

namespace shadestep::gui {

// False for 0, which is none. What tells of its end stays there for who waits for it.
bool hasEnded(int process);

}  // namespace shadestep::gui
