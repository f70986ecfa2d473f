// Threads that end in a discard, put beside those that attachments show.
#pragma once

#include <string>

#include "session/session.h"

namespace shadestep::session {

// A thread that ends in a discard does not say which layer or samples it would have covered: where the target
// has several, it stands nowhere.
bool severalPlanes(const DrawFacts&);
inline constexpr const char* kDiscardedPlanes =
    "threads that end in a discard are left out, because the target has several layers or samples and "
    "nothing tells "
    "which they would have covered; 'debug --pixel --hit N' follows each of them";

// Gives every pixel that shows no thread of the draw the words of the discarded one there, marked kDiscarded.
// Of several on a pixel the nearest counts; two equally near ones cannot be told apart from one pass to the
// next, so such a pixel stays empty. `from_top`: the shader's gl_FragCoord counts rows from the top. Returns
// which threads are left out all the same, as a sentence for the user; empty if none is.
std::string addDiscarded(ThreadWords&, const instrumenter::AttachmentLayout&,
                         const instrumenter::DiscardedThreads&, bool from_top);

}  // namespace shadestep::session
