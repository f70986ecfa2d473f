// One thread's run without a recording: for drivers and dialects without storage buffers (OpenGL 2, GLSL
// ES 1.00).
#pragma once

#include <functional>

#include "session/thread_run.h"

namespace shadestep::session {

// Follows the visible fragment on a pixel by one redraw per step (the thesis's way), at most `most_steps` of
// them; then `complete` is false. Throws nothing_matches if no visible fragment is there.
ThreadRun followPixelByProbes(Session&, int x, int y, std::size_t most_steps = 500);

// The same of a thread of the selected stage, which is another one, by its name.
ThreadRun followThreadByProbes(Session&, const ThreadName&, std::size_t most_steps = 500);

// The recorded run where it leaves the outputs as they were. Else the driver has compiled the recording in
// another way than the program's own text: then the run by redraws, if these do leave the outputs, with a
// note.
ThreadRun trusted(ThreadRun recorded, const std::function<ThreadRun()>& redraw);

}  // namespace shadestep::session
